// OpenIGTLink messages: bytes of the specification, the library's encoder, versions, and hostile sizes.
#include <gtest/gtest.h>

#include <cstring>

#include "ipc/igtl/encode.hpp"
#include "ipc/igtl/stream.hpp"

namespace tact::ipc_igtl_test {
namespace {

const Pose kPose{Vec3(0.1, -0.2, 0.3), quat_from_rotation_vector(Vec3(0.1, 0.2, 0.3))};

struct Message {
    IgtlHeader header;
    IgtlBytes body;
};

Message message_of(const IgtlBytes& bytes) {
    Message m;
    EXPECT_EQ(decode_header(std::span(bytes).first<kIgtlHeaderBytes>(), m.header), IgtlHeaderFault::none);
    m.body.assign(bytes.begin() + kIgtlHeaderBytes, bytes.end());
    return m;
}

// CRC-64 of the specification (ECMA-182, most significant bit first, start 0), bit by bit.
std::uint64_t crc_bit_by_bit(const IgtlBytes& bytes) {
    std::uint64_t crc = 0;
    for (const std::byte b : bytes) {
        crc ^= std::to_integer<std::uint64_t>(b) << 56U;
        for (int i = 0; i < 8; ++i) crc = (crc << 1U) ^ ((crc >> 63U) != 0 ? 0x42F0E1EBA9EA3693U : 0U);
    }
    return crc;
}

void big_endian(IgtlBytes& bytes, std::uint64_t value, std::size_t size) {
    for (std::size_t i = size; i-- > 0;) bytes.push_back(static_cast<std::byte>(value >> 8U * i));
}

// A message as the specification describes it, without the library.
IgtlBytes by_specification(std::uint16_t version, const char* type, const IgtlBytes& body) {
    IgtlBytes bytes;
    big_endian(bytes, version, 2);
    char name[kIgtlTypeMax + kIgtlNameMax] = {};
    std::strncpy(name, type, kIgtlTypeMax);
    std::memcpy(name + kIgtlTypeMax, "Probe", 5);
    for (const char c : name) bytes.push_back(static_cast<std::byte>(c));
    big_endian(bytes, 7, 4);            // seconds
    big_endian(bytes, 0x80000000U, 4);  // and a half
    big_endian(bytes, body.size(), 8);
    big_endian(bytes, crc_bit_by_bit(body), 8);
    bytes.insert(bytes.end(), body.begin(), body.end());
    return bytes;
}

IgtlBytes matrix_turned_about_z() {
    IgtlBytes body;
    for (const float f : {0.F, 1.F, 0.F, -1.F, 0.F, 0.F, 0.F, 0.F, 1.F, 10.F, 20.F, -30.F}) {
        std::uint32_t bits = 0;
        std::memcpy(&bits, &f, sizeof bits);
        big_endian(body, bits, 4);
    }
    return body;
}

void expect_turned(const IgtlPoses& poses) {
    ASSERT_EQ(poses.count, 1U);
    const IgtlPose& p = poses.pose[0];
    EXPECT_EQ(p.fault, IgtlPoseFault::none);
    EXPECT_LT((p.T * Vec3(1.0, 0.0, 0.0) - Vec3(0.010, 1.020, -0.030)).norm(), 1e-6);
}

TEST(Igtl, reads_the_bytes_of_the_specification) {
    const Message m = message_of(by_specification(1, "TRANSFORM", matrix_turned_about_z()));
    EXPECT_EQ(m.header.type.view(), "TRANSFORM");
    EXPECT_EQ(m.header.device.view(), "Probe");
    EXPECT_EQ(m.header.time_ns, 7'500'000'000);
    IgtlPoses poses;
    ASSERT_EQ(decode_poses(m.header, m.body, poses), IgtlFault::none);
    expect_turned(poses);
    EXPECT_EQ(poses.pose[0].name.view(), "Probe");
}

TEST(Igtl, reads_a_header_of_version_2_without_extended_header_and_metadata) {
    IgtlBytes body;
    big_endian(body, 12, 2);  // extended header
    big_endian(body, 2, 2);   // header of the metadata
    big_endian(body, 5, 4);   // metadata
    big_endian(body, 99, 4);  // number of the message
    const IgtlBytes matrix = matrix_turned_about_z();
    body.insert(body.end(), matrix.begin(), matrix.end());
    body.resize(body.size() + 7, std::byte{0xEE});
    const Message m = message_of(by_specification(2, "TRANSFORM", body));
    IgtlPoses poses;
    ASSERT_EQ(decode_poses(m.header, m.body, poses), IgtlFault::none);
    expect_turned(poses);
    // Sizes that reach beyond the body.
    for (const auto& [at, value] : {std::pair{0, 0xFF}, {0, 0x00}, {2, 0xFF}, {4, 0xFF}, {7, 0xFF}}) {
        IgtlBytes wrong = body;
        wrong[static_cast<std::size_t>(at)] = static_cast<std::byte>(value);
        if (at == 0 && value == 0) wrong[1] = std::byte{11};
        const Message w = message_of(by_specification(2, "TRANSFORM", wrong));
        EXPECT_EQ(decode_poses(w.header, w.body, poses), IgtlFault::length) << at;
        EXPECT_EQ(poses.count, 0U);
    }
}

TEST(Igtl, a_transform_that_states_a_bad_status_is_not_valid) {
    using Pairs = std::vector<std::pair<std::string, std::string>>;
    const auto fault = [](const Pairs& pairs, std::size_t entries) {
        IgtlBytes index, metadata;
        big_endian(index, entries, 2);
        for (const auto& [key, value] : pairs) {
            big_endian(index, key.size(), 2);
            big_endian(index, 3, 2);  // encoding
            big_endian(index, value.size(), 4);
            for (const char c : key + value) metadata.push_back(static_cast<std::byte>(c));
        }
        IgtlBytes body;
        big_endian(body, 12, 2);
        big_endian(body, index.size(), 2);
        big_endian(body, metadata.size(), 4);
        big_endian(body, 0, 4);
        for (const IgtlBytes& part : {matrix_turned_about_z(), index, metadata})
            body.insert(body.end(), part.begin(), part.end());
        const Message m = message_of(by_specification(2, "TRANSFORM", body));
        IgtlPoses poses;
        EXPECT_EQ(decode_poses(m.header, m.body, poses), IgtlFault::none);
        return poses.pose[0].fault;
    };
    const std::pair<std::string, std::string> other{"Other", "x"};
    EXPECT_EQ(fault({other, {"TransformStatus", "OK"}}, 2), IgtlPoseFault::none);
    EXPECT_EQ(fault({other, {"TransformStatus", "MISSING"}}, 2), IgtlPoseFault::not_valid);
    EXPECT_EQ(fault({other, {"TransformStatus", "MISSING"}}, 1), IgtlPoseFault::none);
    EXPECT_EQ(fault({other, {"TransformStatus", "MISSING"}}, 0xFFFF), IgtlPoseFault::not_valid);
    EXPECT_EQ(fault({other}, 0xFFFF), IgtlPoseFault::none);
}

TEST(Igtl, encodes_the_bytes_of_the_specification) {
    IgtlBytes bytes;
    const Pose T{Vec3(0.010, 0.020, -0.030), Quat(Eigen::AngleAxisd(1.5707963267948966, Vec3::UnitZ()))};
    append_transform(bytes, "Probe", T, 7'500'000'000);
    const Message m = message_of(bytes);
    EXPECT_EQ(m.header.crc, crc_bit_by_bit(m.body));
    EXPECT_EQ(m.header.time_ns, 7'500'000'000);
    IgtlPoses poses;
    ASSERT_EQ(decode_poses(m.header, m.body, poses), IgtlFault::none);
    expect_turned(poses);

    bytes.clear();
    const double force_n[] = {1.0, -2.5};
    append_sensor(bytes, "ToolForce", force_n, IgtlUnit::newton, 0);
    IgtlBytes body{std::byte{2}, std::byte{0}};
    big_endian(body, 0x0040000000000000U | 0x0008000000000000U, 8);
    const IgtlBytes sensor = message_of(bytes).body;
    ASSERT_EQ(sensor.size(), 10U + 16U);
    // prefix 0, then unit 0x0B (newton) and exponent 1: 4 + 6 + 4 bits.
    EXPECT_EQ(std::to_integer<int>(sensor[2]) << 8 | std::to_integer<int>(sensor[3]), 0x0B << 6 | 1 << 2);
    std::uint64_t bits = 0;
    for (std::size_t i = 0; i < 8; ++i) bits = bits << 8U | std::to_integer<std::uint64_t>(sensor[18 + i]);
    double second = 0.0;
    std::memcpy(&second, &bits, sizeof second);
    EXPECT_EQ(second, -2.5);

    bytes.clear();
    append_status(bytes, "TactStatus", IgtlStatus::not_present, 5, "a name that is longer than a field",
                  "text", 0);
    const IgtlBytes status = message_of(bytes).body;
    ASSERT_EQ(status.size(), 2U + 8U + 20U + 5U);
    EXPECT_EQ(std::to_integer<int>(status[1]), 16);
    EXPECT_EQ(std::to_integer<int>(status[9]), 5);
    EXPECT_EQ(std::to_integer<int>(status[29]), 0);  // the name ends inside its field

    bytes.clear();
    append_string(bytes, "TactState", "hello", 0);
    const IgtlBytes string = message_of(bytes).body;
    ASSERT_EQ(string.size(), 4U + 5U);
    EXPECT_EQ(std::to_integer<int>(string[3]), 5);
}

TEST(Igtl, a_header_that_is_none_is_refused_by_cause) {
    const IgtlBytes good = by_specification(1, "TRANSFORM", matrix_turned_about_z());
    const auto fault = [&](std::size_t at, int value) {
        IgtlBytes wrong = good;
        wrong[at] = static_cast<std::byte>(value);
        IgtlHeader header;
        return decode_header(std::span(wrong).first<kIgtlHeaderBytes>(), header);
    };
    EXPECT_EQ(fault(1, 0), IgtlHeaderFault::version);
    EXPECT_EQ(fault(1, 4), IgtlHeaderFault::version);
    EXPECT_EQ(fault(0, 1), IgtlHeaderFault::version);
    EXPECT_EQ(fault(2, 0), IgtlHeaderFault::type);
    EXPECT_EQ(fault(4, 0x80), IgtlHeaderFault::type);
    EXPECT_EQ(fault(42, 1), IgtlHeaderFault::size);
    EXPECT_EQ(fault(46, 0x41), IgtlHeaderFault::size);
    EXPECT_EQ(fault(46, 0x3F), IgtlHeaderFault::none);
}

TEST(Igtl, tdata_is_bounded_and_its_names_are_printable) {
    const std::vector<IgtlNamedPose> many(kIgtlPosesMax, {"Channel \x01", kPose});
    IgtlBytes bytes;
    append_tdata(bytes, "Tracker", many, 0);
    Message m = message_of(bytes);
    IgtlPoses poses;
    ASSERT_EQ(decode_poses(m.header, m.body, poses), IgtlFault::none);
    EXPECT_EQ(poses.count, kIgtlPosesMax);
    EXPECT_EQ(poses.pose[5].name.view(), "Channel ?");
    EXPECT_LT((poses.pose[5].T.p_m - kPose.p_m).norm(), 1e-6);
    m.body.insert(m.body.end(), m.body.begin(), m.body.begin() + 70);
    m = message_of(by_specification(1, "TDATA", m.body));
    EXPECT_EQ(decode_poses(m.header, m.body, poses), IgtlFault::length);
    EXPECT_EQ(poses.count, 0U);
}

TEST(IgtlStream, a_body_is_kept_or_skipped_whole_whatever_the_portions) {
    IgtlBytes all;
    append_transform(all, "A", kPose, 0);
    const IgtlBytes large = by_specification(2, "IMAGE", IgtlBytes(kIgtlBodyKept + 1, std::byte{0x77}));
    const IgtlBytes largest = by_specification(2, "POLYDATA", IgtlBytes(kIgtlBodyKept, std::byte{0x77}));
    all.insert(all.end(), large.begin(), large.end());
    all.insert(all.end(), largest.begin(), largest.end());
    append_transform(all, "B", kPose, 0);
    for (const std::size_t portion : {1U, 57U, 1000U, 100'000U}) {
        IgtlStream stream;
        std::string seen;
        for (std::size_t at = 0; at < all.size();) {
            const auto room = stream.room();
            ASSERT_FALSE(room.empty());
            const std::size_t n = std::min({portion, room.size(), all.size() - at});
            std::copy_n(all.begin() + static_cast<std::ptrdiff_t>(at), n, room.begin());
            stream.add(n);
            at += n;
            for (auto next = stream.next(); next != IgtlStream::Next::more; next = stream.next()) {
                ASSERT_NE(next, IgtlStream::Next::lost);
                seen += std::string(stream.header.type.view()) +
                        (next == IgtlStream::Next::message ? std::to_string(stream.body.size()) : "") + " ";
            }
        }
        EXPECT_EQ(seen, "TRANSFORM48 IMAGE POLYDATA16384 TRANSFORM48 ");
    }
}

}  // namespace
}  // namespace tact::ipc_igtl_test
