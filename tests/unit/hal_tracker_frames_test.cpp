// Frames of the tracker: checksums, values, pairs, counters, and each cause of a refusal.
#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <limits>

#include "hal/tracker/can_crc.hpp"
#include "hal/tracker/fix_assembler.hpp"
#include "ipc/base/random.hpp"

namespace tact::hal_tracker_frames_test {
namespace {

constexpr std::array<std::uint8_t, 9> kDigits{'1', '2', '3', '4', '5', '6', '7', '8', '9'};

template <class Crc>
auto plain(std::span<const std::uint8_t> bytes) {
    Crc crc;
    for (const std::uint8_t b : bytes) crc.add(b);
    return crc.value();
}

PoseFrame some_pose(std::uint8_t counter = 1) {
    return {0,
            counter,
            kSensorValid,
            1000,
            {Vec3(0.1, -0.2, 0.3), quat_from_rotation_vector(Vec3(0.1, 0.2, 0.3))},
            1,
            0};
}

class Classic : public testing::Test {
protected:
    bool feed(const CanFrame& f) { return assembler_.take(f, fix_); }
    void sync(std::uint16_t counter, TrackerStatus status = TrackerStatus::ok) {
        EXPECT_FALSE(feed(encode(SyncFrame{counter, counter * 4167U, status})));
    }
    CanFrame pos(unsigned counter, std::uint8_t sensor = 0, const Vec3& p_m = Vec3(0.1, 0.2, 0.3),
                 std::uint8_t status = kSensorValid) {
        return encode(PosFrame{sensor, static_cast<std::uint8_t>(counter & 15U), status, p_m});
    }
    CanFrame quat(unsigned counter, std::uint8_t sensor = 0) {
        return encode(QuatFrame{sensor, static_cast<std::uint8_t>(counter & 15U), Quat::Identity()});
    }
    bool period(std::uint16_t counter) {
        sync(counter);
        return !feed(pos(counter)) && feed(quat(counter));
    }
    std::uint64_t refused(Refusal r) const { return assembler_.refused()[r]; }
    std::uint64_t refused() const { return assembler_.refused().total(); }

    FixAssembler assembler_{FixSettings{CanFormat::classic, 2, 1.0}};
    TrackerFix fix_;
};

TEST(TrackerFrames, checksums_give_the_check_values_of_their_standards) {
    EXPECT_EQ(plain<Crc8>(kDigits), 0x4B);
    EXPECT_EQ(plain<Crc16>(kDigits), 0x29B1);
}

TEST(TrackerFrames, a_frame_with_another_identifier_fails_its_checksum) {
    CanFrame pos = encode(PosFrame{0, 1, kSensorValid, Vec3(0.1, 0.2, 0.3)});
    pos.id = kPosId + 1;
    PosFrame out;
    EXPECT_EQ(decode(pos, out), Refusal::crc);
    CanFrame pose = encode(some_pose());
    pose.id = kPoseId + 1;
    PoseFrame pose_out;
    EXPECT_EQ(decode(pose, pose_out), Refusal::crc);
}

// CRC-8 and CRC-16 detect all errors of one or two bits in messages of these lengths.
TEST(TrackerFrames, any_one_or_two_wrong_bits_are_detected) {
    const CanFrame good[] = {encode(SyncFrame{77, 123456, TrackerStatus::ok}), encode(some_pose())};
    for (const CanFrame& frame : good) {
        const unsigned bits = frame.length * 8U;
        for (unsigned a = 0; a < bits; ++a) {
            for (unsigned b = a; b < bits; ++b) {
                CanFrame bad = frame;
                bad.data[a / 8] ^= static_cast<std::uint8_t>(1U << (a % 8));
                if (b != a) bad.data[b / 8] ^= static_cast<std::uint8_t>(1U << (b % 8));
                SyncFrame sync;
                PoseFrame pose;
                const Refusal r = frame.kind == CanKind::fd ? decode(bad, pose) : decode(bad, sync);
                ASSERT_EQ(r, Refusal::crc) << a << " " << b;
            }
        }
    }
}

RC_GTEST_PROP(TrackerFrames, a_pose_round_trips_within_half_a_step, (std::uint64_t seed)) {
    SeededRandom random(seed);
    const auto within = [&random](double max) { return max * (2.0 * random.uniform() - 1.0); };
    const Pose T{Vec3(within(1.6), within(1.6), within(1.6)), random.rotation()};
    const auto counter = static_cast<std::uint8_t>(random.below(256));
    const auto sensor = static_cast<std::uint8_t>(random.below(4));
    const auto angle = [&T](const Quat& q) { return rotation_vector_rad(q * T.q.conjugate()).norm(); };

    PoseFrame fd;
    RC_ASSERT(decode(encode(PoseFrame{sensor, counter, kSensorValid, 5, T, 0.5, 0.25}), fd) == Refusal::none);
    RC_ASSERT((fd.T_tracker_sensor.p_m - T.p_m).cwiseAbs().maxCoeff() < 25.1e-6);
    RC_ASSERT(angle(fd.T_tracker_sensor.q) < 2.1 / 32768);  // 2 |dq|, |dq| <= sqrt(4) / 2 steps
    RC_ASSERT(fd.sensor == sensor && fd.counter == counter && fd.time_us == 5U);

    PosFrame pos;
    RC_ASSERT(decode(encode(PosFrame{sensor, 9, kSensorValid, T.p_m}), pos) == Refusal::none);
    RC_ASSERT((pos.p_m - T.p_m).cwiseAbs().maxCoeff() < 25.1e-6);
    QuatFrame quat;
    RC_ASSERT(decode(encode(QuatFrame{sensor, 9, T.q}), quat) == Refusal::none);
    RC_ASSERT(angle(quat.q) < 2.1 / 4095);
}

RC_GTEST_PROP(TrackerFrames, any_bytes_decode_to_finite_values_and_unit_quaternions,
              (std::uint64_t seed, bool fd)) {
    SeededRandom random(seed);
    CanFrame f;
    f.kind = fd ? CanKind::fd : CanKind::classic;
    f.length = fd ? kPoseBytes : kClassicBytes;
    f.id = fd ? kPoseId : kQuatId;
    for (auto& byte : f.data) byte = static_cast<std::uint8_t>(random.next());
    // With a valid checksum, so that decoding reaches the values.
    if (fd) {
        const auto crc = crc_of<Crc16>(can_data_id(f.id), f.payload().subspan(2));
        f.data[0] = static_cast<std::uint8_t>(crc & 0xFFU);
        f.data[1] = static_cast<std::uint8_t>(crc >> 8);
        PoseFrame out;
        if (decode(f, out) != Refusal::none) return;
        RC_ASSERT(out.T_tracker_sensor.finite());
        RC_ASSERT(std::abs(out.T_tracker_sensor.q.norm() - 1.0) < 1e-12);
        RC_ASSERT(out.quality >= 0.0 && out.quality <= 1.0);
    } else {
        f.data[7] = crc_of<Crc8>(can_data_id(f.id), f.payload().first(7));
        QuatFrame out;
        if (decode(f, out) != Refusal::none) return;
        RC_ASSERT(std::abs(out.q.norm() - 1.0) < 1e-12);
    }
}

TEST(TrackerFrames, a_pose_that_is_not_finite_is_sent_as_not_valid) {
    const double nan = std::numeric_limits<double>::quiet_NaN();
    PoseFrame pose = some_pose();
    pose.T_tracker_sensor.p_m.y() = nan;
    PoseFrame out;
    ASSERT_EQ(decode(encode(pose), out), Refusal::none);
    EXPECT_EQ(out.status & kSensorValid, 0);
    EXPECT_TRUE(out.T_tracker_sensor.finite());
    PosFrame pos;
    ASSERT_EQ(decode(encode(PosFrame{0, 0, kSensorValid, Vec3(nan, 0, 0)}), pos), Refusal::none);
    EXPECT_EQ(pos.status & kSensorValid, 0);
    QuatFrame quat;
    EXPECT_EQ(decode(encode(QuatFrame{0, 0, Quat(nan, 0, 0, 1)}), quat), Refusal::norm);
}

TEST(TrackerFrames, values_beyond_the_range_saturate) {
    PosFrame pos;
    ASSERT_EQ(decode(encode(PosFrame{0, 0, kSensorValid, Vec3(99.0, -99.0, 1e300)}), pos), Refusal::none);
    EXPECT_DOUBLE_EQ(pos.p_m.x(), 32767 * 0.05e-3);
    EXPECT_DOUBLE_EQ(pos.p_m.y(), -32767 * 0.05e-3);
}

TEST_F(Classic, a_pair_of_the_same_period_is_a_pose_in_either_order) {
    sync(10);
    EXPECT_FALSE(feed(pos(10)));
    EXPECT_TRUE(feed(quat(10)));
    EXPECT_EQ(fix_.time_us, 10U * 4167U);
    EXPECT_NEAR(fix_.T_tracker_sensor.p_m.z(), 0.3, 26e-6);
    EXPECT_FALSE(feed(quat(10, 1)));
    EXPECT_TRUE(feed(pos(10, 1)));
    EXPECT_EQ(fix_.sensor, 1);
    EXPECT_EQ(refused(), 0U);
}

TEST_F(Classic, halves_of_different_periods_never_make_a_pose) {
    sync(1);
    EXPECT_FALSE(feed(pos(1)));
    sync(2);
    EXPECT_EQ(refused(Refusal::half), 1U);
    EXPECT_FALSE(feed(quat(2)));
    EXPECT_FALSE(feed(pos(1)));
    EXPECT_EQ(refused(Refusal::no_sync), 1U);
    EXPECT_TRUE(feed(pos(2)));
}

TEST_F(Classic, halves_without_a_period_are_refused) {
    EXPECT_FALSE(feed(pos(3)));
    EXPECT_FALSE(feed(quat(3)));
    EXPECT_EQ(refused(Refusal::no_sync), 2U);
}

TEST_F(Classic, a_repeated_frame_gives_no_second_pose) {
    EXPECT_TRUE(period(5));
    EXPECT_FALSE(feed(pos(5)));
    EXPECT_FALSE(feed(quat(5)));
    sync(5);
    EXPECT_EQ(refused(Refusal::repeated), 3U);
}

TEST_F(Classic, lost_periods_are_counted_and_a_jump_costs_one_period) {
    EXPECT_TRUE(period(65534));
    EXPECT_TRUE(period(1));  // across the wrap: 65535 and 0 are missing
    EXPECT_EQ(assembler_.missed(), 2U);
    sync(100);
    EXPECT_EQ(refused(Refusal::jump), 1U);
    EXPECT_FALSE(feed(pos(100)));
    EXPECT_FALSE(feed(quat(100)));
    EXPECT_EQ(refused(Refusal::no_sync), 2U);
    EXPECT_TRUE(period(101));
}

TEST_F(Classic, a_tracker_that_is_not_ready_gives_no_pose) {
    sync(1, TrackerStatus::no_source);
    EXPECT_FALSE(feed(pos(1)));
    EXPECT_FALSE(feed(quat(1)));
    EXPECT_EQ(refused(Refusal::tracker_status), 1U);
    EXPECT_EQ(assembler_.status(), TrackerStatus::no_source);
    EXPECT_TRUE(period(2));
}

TEST_F(Classic, invalid_or_out_of_reach_poses_are_refused) {
    sync(1);
    feed(quat(1));
    EXPECT_FALSE(feed(pos(1, 0, Vec3::Zero(), kSensorDistorted)));
    EXPECT_EQ(refused(Refusal::sensor_status), 1U);
    sync(2);
    feed(quat(2));
    EXPECT_FALSE(feed(pos(2, 0, Vec3(0.9, 0.5, 0.0))));
    EXPECT_EQ(refused(Refusal::out_of_range), 1U);
    sync(3);
    feed(quat(3));
    EXPECT_TRUE(feed(pos(3, 0, Vec3(0.9, 0.4, 0.0), kSensorValid | kSensorDistorted)));
    EXPECT_EQ(fix_.distortion, 1.0);
}

TEST_F(Classic, foreign_and_wrong_frames_are_counted_by_cause) {
    CanFrame f = pos(1);
    f.id = 0x321;
    feed(f);
    feed(pos(1, 2));  // a third sensor; two are configured
    feed(encode(some_pose()));
    EXPECT_EQ(refused(Refusal::unknown_id), 3U);
    f = pos(1);
    f.length = 7;
    feed(f);
    f = pos(1);
    f.kind = CanKind::fd;
    feed(f);
    f.kind = CanKind::malformed;
    feed(f);
    EXPECT_EQ(refused(Refusal::wrong_length), 3U);
    f = pos(1);
    f.data[3] ^= 0x10;
    feed(f);
    EXPECT_EQ(refused(Refusal::crc), 1U);
}

TEST(TrackerFd, each_sensor_has_its_own_counter) {
    FixAssembler assembler(FixSettings{CanFormat::fd, 2, 1.0});
    TrackerFix fix;
    const auto feed = [&](std::uint8_t sensor, std::uint8_t counter) {
        PoseFrame pose = some_pose(counter);
        pose.sensor = sensor;
        return assembler.take(encode(pose), fix);
    };
    EXPECT_TRUE(feed(0, 254));
    EXPECT_TRUE(feed(1, 7));
    EXPECT_FALSE(feed(0, 254));
    EXPECT_TRUE(feed(0, 0));
    EXPECT_EQ(assembler.missed(), 1U);
    EXPECT_TRUE(feed(1, 8));
    EXPECT_FALSE(feed(1, 12));
    EXPECT_TRUE(feed(1, 13));
    EXPECT_EQ(assembler.refused()[Refusal::repeated], 1U);
    EXPECT_EQ(assembler.refused()[Refusal::jump], 1U);
    EXPECT_EQ(assembler.refused().total(), 2U);
    assembler.restart();
    EXPECT_TRUE(feed(1, 77));  // after a restart any counter is accepted
}

TEST(TrackerFd, reserved_bits_and_a_wrong_sensor_number_are_malformed_and_a_long_quaternion_has_a_bad_norm) {
    const auto with = [](unsigned byte, std::uint8_t value) {
        CanFrame f = encode(some_pose());
        f.data[byte] = value;
        const auto crc = crc_of<Crc16>(can_data_id(f.id), f.payload().subspan(2));
        f.data[0] = static_cast<std::uint8_t>(crc & 0xFFU);
        f.data[1] = static_cast<std::uint8_t>(crc >> 8);
        PoseFrame out;
        return decode(f, out);
    };
    EXPECT_EQ(with(3, 0x10), Refusal::none);
    EXPECT_EQ(with(3, 0x90), Refusal::malformed);
    EXPECT_EQ(with(3, 0x11), Refusal::malformed);
    EXPECT_EQ(with(21, 0xFF), Refusal::malformed);  // w < 0
    EXPECT_EQ(with(15, 0x7F), Refusal::norm);
}

}  // namespace
}  // namespace tact::hal_tracker_frames_test
