#include "ipc/igtl/decode.hpp"

#include <igtl_header.h>
#include <igtl_tdata.h>
#include <igtl_transform.h>
#include <igtl_util.h>

#include <algorithm>
#include <cmath>
#include <cstring>

namespace tact {

namespace {

static_assert(kIgtlHeaderBytes == IGTL_HEADER_SIZE && sizeof(igtl_header) == IGTL_HEADER_SIZE);
static_assert(sizeof(igtl_tdata_element) == IGTL_TDATA_ELEMENT_SIZE && IGTL_TDATA_LEN_NAME == kIgtlNameMax);

using Matrix = std::array<float, 12>;  // columns x, y, z and the place, mm
static_assert(sizeof(Matrix) == IGTL_TRANSFORM_SIZE);

// The field ends at its first 0.
template <std::size_t size>
bool take_text(const char (&field)[size], IgtlText<size>& out) noexcept {
    bool printable = true, ended = false;
    for (std::size_t i = 0; i < size; ++i) {
        ended = ended || field[i] == '\0';
        const bool good = ended || (field[i] >= ' ' && field[i] <= '~');
        printable = printable && good;
        out.chars[i] = ended ? '\0' : good ? field[i] : '?';
    }
    return printable;
}

std::int64_t nanoseconds(std::uint64_t stamp) noexcept {  // 32 bits of seconds, 32 of their fraction
    const std::uint64_t fraction_ns = ((stamp & 0xFFFFFFFFU) * 1'000'000'000U) >> 32U;
    return static_cast<std::int64_t>((stamp >> 32U) * 1'000'000'000U + fraction_ns);
}

void take_matrix(const Matrix& m, IgtlPose& out) noexcept {
    out.T = {};
    for (const float f : m) {
        if (std::isfinite(f)) continue;
        out.fault = IgtlPoseFault::not_finite;
        return;
    }
    constexpr Matrix kIdentity{1, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0};
    if (m == kIdentity) {
        out.fault = IgtlPoseFault::identity;
        return;
    }
    const Eigen::Matrix3d R = Eigen::Map<const Eigen::Matrix3f>(m.data()).cast<double>();
    const double off = (R.transpose() * R - Eigen::Matrix3d::Identity()).cwiseAbs().maxCoeff();
    if (!(off <= kIgtlRotationError) || R.determinant() <= 0.0) {
        out.fault = IgtlPoseFault::rotation;
        return;
    }
    out.fault = IgtlPoseFault::none;
    out.T.q = Quat(R).normalized();
    out.T.p_m = 1e-3 * Eigen::Map<const Eigen::Vector3f>(m.data() + 9).cast<double>();
}

std::size_t number_at(std::span<const std::byte> bytes, std::size_t at, std::size_t size) noexcept {
    std::size_t n = 0;
    for (std::size_t i = 0; i < size; ++i) n = n << 8U | std::to_integer<std::size_t>(bytes[at + i]);
    return n;
}

std::string_view text_of(std::span<const std::byte> bytes) noexcept {
    return {reinterpret_cast<const char*>(bytes.data()), bytes.size()};
}

struct IgtlContent {
    std::span<const std::byte> content, index, metadata;
};

// From version 2 on: extended header, content, index of the metadata, metadata. Before, the whole body is the content.
IgtlFault split(const IgtlHeader& header, std::span<const std::byte> body, IgtlContent& out) noexcept {
    constexpr std::size_t kExtendedLeast = 12;
    out = {.content = body, .index = {}, .metadata = {}};
    if (header.version < 2) return IgtlFault::none;
    if (body.size() < kExtendedLeast) return IgtlFault::length;
    const std::size_t extended = number_at(body, 0, 2), index = number_at(body, 2, 2),
                      metadata = number_at(body, 4, 4);
    if (extended < kExtendedLeast || extended > body.size() || index + metadata > body.size() - extended)
        return IgtlFault::length;
    out.metadata = body.last(metadata);
    out.index = body.first(body.size() - metadata).last(index);
    out.content = body.subspan(extended, body.size() - extended - index - metadata);
    return IgtlFault::none;
}

// The index: a number of entries, and for each the sizes of key and value. Metadata that contradict it state nothing.
bool status_is_bad(const IgtlContent& c) noexcept {
    constexpr std::size_t kEntry = 8;
    if (c.index.size() < 2) return false;
    const std::size_t entries = std::min(number_at(c.index, 0, 2), (c.index.size() - 2) / kEntry);
    std::span<const std::byte> rest = c.metadata;
    for (std::size_t i = 0; i < entries; ++i) {
        const std::size_t at = 2 + kEntry * i, key = number_at(c.index, at, 2),
                          value = number_at(c.index, at + 4, 4);
        if (key > rest.size() || value > rest.size() - key) return false;
        if (text_of(rest.first(key)) == "TransformStatus") return text_of(rest.subspan(key, value)) != "OK";
        rest = rest.subspan(key + value);
    }
    return false;
}

}  // namespace

IgtlHeaderFault decode_header(std::span<const std::byte, kIgtlHeaderBytes> bytes, IgtlHeader& out) noexcept {
    igtl_header raw;
    std::memcpy(&raw, bytes.data(), sizeof raw);
    igtl_header_convert_byte_order(&raw);
    out = {};
    out.version = raw.version;
    const bool printable = take_text(raw.name, out.type);
    static_cast<void>(take_text(raw.device_name, out.device));
    out.time_ns = nanoseconds(raw.timestamp);
    out.body_bytes = raw.body_size;
    out.crc = raw.crc;
    if (out.version < 1 || out.version > 3) return IgtlHeaderFault::version;
    if (!printable || out.type.view().empty()) return IgtlHeaderFault::type;
    return out.body_bytes > kIgtlBodyMost ? IgtlHeaderFault::size : IgtlHeaderFault::none;
}

IgtlFault decode_poses(const IgtlHeader& header, std::span<const std::byte> body, IgtlPoses& out) noexcept {
    out.count = 0;
    const bool transform = header.type.view() == "TRANSFORM";
    if (!transform && header.type.view() != "TDATA") return IgtlFault::other_type;
    if (body.size() != header.body_bytes) return IgtlFault::length;
    // The library's function takes a pointer to bytes that it only reads.
    auto* const data = reinterpret_cast<unsigned char*>(const_cast<std::byte*>(body.data()));
    if (crc64(data, body.size(), 0) != header.crc) return IgtlFault::crc;
    IgtlContent parts;
    if (const IgtlFault fault = split(header, body, parts); fault != IgtlFault::none) return fault;
    body = parts.content;
    if (transform) {
        Matrix m;
        if (body.size() != sizeof m) return IgtlFault::length;
        std::memcpy(m.data(), body.data(), sizeof m);
        igtl_transform_convert_byte_order(m.data());
        out.pose[0].name = header.device;
        take_matrix(m, out.pose[0]);
        if (out.pose[0].fault == IgtlPoseFault::none && status_is_bad(parts))
            out.pose[0] = {.name = header.device, .fault = IgtlPoseFault::not_valid, .T = {}};
        out.count = 1;
        return IgtlFault::none;
    }
    const std::size_t count = body.size() / sizeof(igtl_tdata_element);
    if (body.size() % sizeof(igtl_tdata_element) != 0 || count > kIgtlPosesMax) return IgtlFault::length;
    for (std::size_t i = 0; i < count; ++i) {
        igtl_tdata_element element;
        std::memcpy(&element, body.data() + i * sizeof element, sizeof element);
        igtl_tdata_convert_byte_order(&element, 1);
        Matrix m;
        std::memcpy(m.data(), element.transform, sizeof m);
        static_cast<void>(take_text(element.name, out.pose[i].name));
        take_matrix(m, out.pose[i]);
    }
    out.count = count;
    return IgtlFault::none;
}

}  // namespace tact
