// The reader of an OpenIGTLink tracker on bytes of a test, on a manual clock: poses, times, losses, hostile servers.
#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <deque>

#include "hal/tracker/igtl_reader.hpp"
#include "hal/tracker/igtl_socket.hpp"
#include "ipc/base/error.hpp"
#include "ipc/igtl/encode.hpp"

namespace tact::hal_igtl_reader_test {
namespace {

using std::chrono::milliseconds;

// Bytes to receive; after `gone`, the connection has ended.
class GivenBytes final : public IgtlSource {
public:
    void open() override {}
    bool reopen() noexcept override {
        ++reopened;
        gone = false;
        return reachable;
    }
    void close() noexcept override { bytes.clear(); }
    IgtlBatch receive(std::span<std::byte> into, Duration) noexcept override {
        const std::size_t n = std::min({into.size(), bytes.size(), portion});
        std::copy_n(bytes.begin(), n, into.begin());
        bytes.erase(bytes.begin(), bytes.begin() + static_cast<std::ptrdiff_t>(n));
        return {.bytes = n, .gone = n == 0 && gone};
    }
    void give(const IgtlBytes& more) { bytes.insert(bytes.end(), more.begin(), more.end()); }

    std::deque<std::byte> bytes;
    std::size_t portion = SIZE_MAX;
    bool gone = false, reachable = true;
    int reopened = 0;
};

const Pose kPose{Vec3(0.1, -0.2, 0.3), quat_from_rotation_vector(Vec3(0.1, 0.2, 0.3))};
constexpr std::int64_t kUtcNs = 1'700'000'000'000'000'000;

IgtlBytes transform(std::int64_t time_ns, const Pose& T = kPose, const char* name = "Head") {
    IgtlBytes bytes;
    append_transform(bytes, name, T, time_ns);
    return bytes;
}

class IgtlReaderTest : public testing::Test {
protected:
    IgtlReaderTest() : reader_({.names = {"Head", "Stylus"}, .rate_hz = 100.0}, source_, clock_) {
        clock_.advance(std::chrono::seconds(100));
        reader_.opened();
    }
    void step(Duration d = milliseconds(10)) {
        clock_.advance(d);
        time_ns_ += d.count();
        reader_.round(milliseconds(1));
    }
    TrackerSample read(unsigned sensor = 0) {
        static_cast<void>(reader_.read(sensor, newest_[sensor], clock_.now()));
        return newest_[sensor];
    }

    ManualClock clock_;
    GivenBytes source_;
    IgtlReader reader_;
    std::int64_t time_ns_ = kUtcNs;
    TrackerSample newest_[2];
};

TEST_F(IgtlReaderTest, poses_arrive_in_metres_by_name_from_transform_and_tdata) {
    source_.give(transform(time_ns_ + 10'000'000));
    const IgtlNamedPose poses[] = {{"Other", kPose}, {"Stylus", kPose}};
    IgtlBytes tdata;
    append_tdata(tdata, "Tracker", poses, time_ns_ + 10'000'000);
    source_.give(tdata);
    source_.give(transform(time_ns_ + 10'000'000, kPose, "Probe"));
    step();
    for (const unsigned sensor : {0U, 1U}) {
        const TrackerSample s = read(sensor);
        EXPECT_EQ(s.state, TrackerState::fresh);
        EXPECT_EQ(s.sequence, 1U);
        EXPECT_LT((s.T_tracker_sensor.p_m - kPose.p_m).norm(), 1e-6);
        EXPECT_LT(s.T_tracker_sensor.q.angularDistance(kPose.q), 1e-6);
    }
    EXPECT_EQ(reader_.health().frames, 3U);
    EXPECT_EQ(reader_.health().samples, 2U);
    EXPECT_EQ(reader_.health().refused, 0U);
}

TEST_F(IgtlReaderTest, messages_may_arrive_byte_by_byte) {
    source_.portion = 1;
    source_.give(transform(time_ns_));
    for (int i = 0; i < 5; ++i) step(milliseconds(1));
    EXPECT_EQ(read().sequence, 1U);
}

TEST_F(IgtlReaderTest, the_time_is_that_of_the_sender_and_a_late_message_is_refused) {
    for (int i = 1; i <= 50; ++i) {
        source_.give(transform(kUtcNs + i * 10'000'000));
        step();
    }
    const Instant measured = read().taken_at;
    EXPECT_NEAR(to_s(clock_.now() - measured), 0.0, 1e-4);
    // 20 ms in a queue: the measurement was then, not at the arrival.
    clock_.advance(milliseconds(20));
    source_.give(transform(kUtcNs + 51 * 10'000'000));
    step();
    EXPECT_NEAR(to_s(read().taken_at - measured), 0.010, 1e-4);
    // 100 ms: more than three periods.
    const std::uint64_t before = read().sequence;
    clock_.advance(milliseconds(100));
    source_.give(transform(kUtcNs + 52 * 10'000'000));
    step();
    EXPECT_EQ(read().sequence, before);
    EXPECT_EQ(reader_.refused()[Refusal::stale], 1U);
}

TEST_F(IgtlReaderTest, without_a_time_stamp_the_arrival_counts) {
    for (int i = 0; i < 3; ++i) {
        source_.give(transform(0));
        step();
        EXPECT_EQ(read().taken_at, clock_.now());
    }
    EXPECT_EQ(reader_.health().samples, 3U);
}

TEST_F(IgtlReaderTest, lost_samples_are_counted_and_a_pause_is_none) {
    const auto at = [&](std::int64_t period) {
        source_.give(transform(kUtcNs + period * 10'000'000));
        step();
    };
    at(1);
    at(2);
    EXPECT_EQ(reader_.health().missed, 0U);
    clock_.advance(milliseconds(30));
    at(6);  // 3, 4 and 5 are missing
    EXPECT_EQ(reader_.health().missed, 3U);
    clock_.advance(std::chrono::seconds(20));
    at(2006);
    EXPECT_EQ(reader_.health().missed, 3U);
}

TEST_F(IgtlReaderTest, a_repeated_measurement_is_no_new_sample) {
    source_.give(transform(kUtcNs));
    step();
    source_.give(transform(kUtcNs));
    step();
    EXPECT_EQ(read().sequence, 1U);
    EXPECT_EQ(reader_.refused()[Refusal::repeated], 1U);
}

TEST_F(IgtlReaderTest, impossible_poses_are_refused_by_cause_and_the_last_one_stays) {
    source_.give(transform(kUtcNs));
    step();
    const auto offer = [&](const Pose& T) {
        source_.give(transform(time_ns_ + 10'000'000, T));
        step();
    };
    offer({Vec3(std::nan(""), 0, 0), kPose.q});
    offer({Vec3(1.7, 0, 0), kPose.q});
    offer({});                                     // the identity: the server has no pose
    offer({kPose.p_m, Quat(1.0, 1.0, 0.0, 0.0)});  // matrix of no rotation
    IgtlBytes wrong = transform(time_ns_ + 10'000'000);
    wrong.back() ^= std::byte{1};
    source_.give(wrong);
    step();
    EXPECT_EQ(read().sequence, 1U);
    EXPECT_LT((read().T_tracker_sensor.p_m - kPose.p_m).norm(), 1e-6);
    for (const Refusal why :
         {Refusal::malformed, Refusal::out_of_range, Refusal::sensor_status, Refusal::norm, Refusal::crc})
        EXPECT_EQ(reader_.refused()[why], 1U) << refusal_name(why);
    EXPECT_EQ(reader_.health().refused, 5U);
    EXPECT_EQ(reader_.health().link, TrackerLink::up);
}

TEST_F(IgtlReaderTest, images_between_the_poses_are_skipped) {
    // The header of an image of 1 MiB, as the header of a TRANSFORM with another type and size.
    IgtlBytes image = transform(0);
    image.resize(kIgtlHeaderBytes);
    std::memcpy(image.data() + 2, "IMAGE\0\0\0\0\0\0\0", kIgtlTypeMax);
    image[47] = std::byte{0x10};  // the size is at 42, big endian
    image[49] = std::byte{0};
    image.resize(kIgtlHeaderBytes + 0x100000, std::byte{0xAB});
    source_.give(image);
    source_.give(transform(kUtcNs));
    for (int i = 0; i < 40; ++i) step(milliseconds(1));
    EXPECT_EQ(read().sequence, 1U);
    EXPECT_EQ(reader_.health().bus_errors, 0U);
    EXPECT_GT(reader_.health().floods, 0U);  // a round is bounded also by bytes that are skipped
}

TEST_F(IgtlReaderTest, a_giant_size_or_garbage_ends_the_connection_and_costs_nothing) {
    IgtlBytes giant = transform(kUtcNs);
    std::memset(giant.data() + 42, 0xFF, 8);
    const IgtlBytes garbage(5000, std::byte{0x5A});
    std::uint64_t n = 0;
    for (const IgtlBytes& hostile : {giant, garbage}) {
        source_.give(hostile);
        step();
        EXPECT_EQ(reader_.health().link, TrackerLink::gone);
        EXPECT_EQ(reader_.health().bus_errors, ++n);
        EXPECT_EQ(reader_.health().link_losses, n);
        step();
        EXPECT_EQ(source_.reopened, static_cast<int>(n) - 1);  // not at once
        step(milliseconds(500));
        EXPECT_EQ(source_.reopened, static_cast<int>(n));
        source_.give(transform(time_ns_ + 10'000'000));
        step();
        EXPECT_EQ(read().sequence, n);
        EXPECT_EQ(reader_.health().link, TrackerLink::up);
    }
}

TEST_F(IgtlReaderTest, an_unreachable_server_is_tried_twice_per_second) {
    source_.gone = true;
    source_.reachable = false;
    step();
    EXPECT_EQ(reader_.health().link, TrackerLink::gone);
    for (int i = 0; i < 300; ++i) step();
    EXPECT_GE(source_.reopened, 4);
    EXPECT_LE(source_.reopened, 12);
    EXPECT_EQ(reader_.health().reopened, 0U);
    source_.reachable = true;
    for (int i = 0; i < 60; ++i) step();
    EXPECT_EQ(reader_.health().link, TrackerLink::up);
    EXPECT_EQ(reader_.health().reopened, 1U);
}

TEST(IgtlNames, are_separated_by_commas) {
    using Names = std::vector<std::string>;
    EXPECT_EQ(igtl_names("HeadToTracker"), Names{"HeadToTracker"});
    EXPECT_EQ(igtl_names(" A ,Channel 0,, B"), (Names{"A", "Channel 0", "B"}));
    EXPECT_EQ(igtl_names(""), Names{});
    EXPECT_EQ(igtl_names(" , "), Names{});
}

std::string refusal_of(const std::function<void()>& act) {
    try {
        act();
    } catch (const StartupError& e) {
        return e.what();
    }
    return "no error";
}

TEST(IgtlSettings, impossible_ones_are_refused_with_the_key) {
    const auto refused = [](const IgtlTrackerSettings& s) { return refusal_of([&] { checked(s); }); };
    EXPECT_NE(refused({}).find("tracker.devices"), std::string::npos);
    EXPECT_NE(refused({.names = {"A", "A"}}).find("tracker.devices"), std::string::npos);
    EXPECT_NE(refused({.names = {"A"}, .rate_hz = 1.0}).find("tracker.rate_hz"), std::string::npos);
    EXPECT_EQ(refused({.names = {"A"}}), "no error");
}

TEST(IgtlSocket, a_start_without_a_server_names_the_host_and_the_fix) {
    IgtlSocket nobody("127.0.0.1", 1, milliseconds(10));
    const std::string text = refusal_of([&] { nobody.open(); });
    EXPECT_NE(text.find("127.0.0.1:1: no OpenIGTLink server listens there"), std::string::npos) << text;
    EXPECT_NE(text.find("tracker.port"), std::string::npos);
    IgtlSocket unknown("no host has this name", 1, milliseconds(10));
    EXPECT_NE(refusal_of([&] { unknown.open(); }).find("tracker.host"), std::string::npos);
}

}  // namespace
}  // namespace tact::hal_igtl_reader_test
