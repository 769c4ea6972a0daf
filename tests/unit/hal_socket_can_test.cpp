// The socket of the CAN driver on other sockets that keep message borders, since few test machines have a CAN bus:
// frames from the kernel's structs, end of stream and overflow; filters; texts of the errors.
#include <gtest/gtest.h>
#include <netinet/in.h>
#include <sys/socket.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <thread>

#include "hal/sim/sim_head_bus.hpp"
#include "hal/tracker/can_tracker.hpp"
#include "hal/tracker/socket_can.hpp"
#include "ipc/base/error.hpp"

namespace tact::hal_socket_can_test {
namespace {

using std::chrono::milliseconds;

class Pair {
public:
    explicit Pair(int type) {
        std::array<int, 2> fds{};
        if (socketpair(AF_UNIX, type, 0, fds.data()) != 0) throw std::runtime_error("socketpair");
        theirs_ = fds[0];
        ours_ = fds[1];
    }
    ~Pair() { close_theirs(); }
    Pair(const Pair&) = delete;
    Pair& operator=(const Pair&) = delete;
    int ours() const { return ours_; }  // the SocketCan closes it
    void close_theirs() {
        if (theirs_ >= 0) ::close(std::exchange(theirs_, -1));
    }
    bool send(const void* data, std::size_t bytes, int flags = 0) {
        return ::send(theirs_, data, bytes, flags | MSG_NOSIGNAL) == static_cast<ssize_t>(bytes);
    }
    bool send(const CanFrame& f, std::uint32_t flags = 0, int how = 0) {
        canfd_frame raw{};
        raw.can_id = f.id | flags;
        raw.len = f.length;
        std::copy_n(f.data.begin(), f.length, raw.data);
        return send(&raw, f.kind == CanKind::fd ? CANFD_MTU : CAN_MTU, how);
    }

private:
    int theirs_ = -1, ours_ = -1;
};

CanFrame pos() { return encode(PosFrame{0, 3, kSensorValid, Vec3(0.1, 0.2, 0.3)}); }
CanFrame pose() { return encode(PoseFrame{1, 3, kSensorValid, 9, {}, 1.0, 0.0}); }

std::string refusal(const std::function<void()>& act) {
    try {
        act();
    } catch (const StartupError& e) {
        return e.what();
    }
    return "no refusal";
}

TEST(SocketCan, frames_of_both_kinds_arrive_unchanged) {
    Pair pair(SOCK_DGRAM);
    SocketCan can(pair.ours());
    can.open();
    ASSERT_TRUE(pair.send(pos()));
    ASSERT_TRUE(pair.send(pose()));
    std::array<CanFrame, 8> got;
    const CanBatch batch = can.receive(got, milliseconds(100));
    ASSERT_EQ(batch.count, 2U);
    EXPECT_EQ(batch.fault, CanFault::none);
    PosFrame p;
    EXPECT_EQ(decode(got[0], p), Refusal::none);
    PoseFrame fd;
    EXPECT_EQ(decode(got[1], fd), Refusal::none);
    EXPECT_EQ(fd.sensor, 1);
}

TEST(SocketCan, error_frames_are_recognised_and_other_invalid_frames_are_malformed) {
    Pair pair(SOCK_DGRAM);
    SocketCan can(pair.ours());
    ASSERT_TRUE(pair.send(pos(), CAN_ERR_FLAG));
    ASSERT_TRUE(pair.send(pos(), CAN_EFF_FLAG));
    ASSERT_TRUE(pair.send(pos(), CAN_RTR_FLAG));
    canfd_frame raw{};
    raw.can_id = kPosId;
    raw.len = 9;  // more than a classic frame holds
    ASSERT_TRUE(pair.send(&raw, CAN_MTU));
    raw.len = 65;
    ASSERT_TRUE(pair.send(&raw, CANFD_MTU));
    raw.len = 8;
    ASSERT_TRUE(pair.send(&raw, 5));
    ASSERT_TRUE(pair.send(std::array<char, 200>{}.data(), 200));
    std::array<CanFrame, 16> got;
    ASSERT_EQ(can.receive(got, milliseconds(100)).count, 7U);
    EXPECT_EQ(got[0].kind, CanKind::error);
    for (std::size_t i = 1; i < 7; ++i) EXPECT_EQ(got[i].kind, CanKind::malformed) << i;
}

TEST(SocketCan, a_batch_is_bounded_and_order_is_kept) {
    Pair pair(SOCK_DGRAM);
    SocketCan can(pair.ours());
    std::uint16_t sent = 0;  // as many as the socket pair holds without blocking
    while (sent < 200 && pair.send(encode(SyncFrame{sent, 0, TrackerStatus::ok}), 0, MSG_DONTWAIT)) ++sent;
    ASSERT_GT(sent, 2U);
    std::array<CanFrame, 100> got;
    std::uint16_t next = 0;
    while (next < sent) {
        const CanBatch batch = can.receive(got, Duration{0});
        ASSERT_GT(batch.count, 0U);
        ASSERT_LE(batch.count, kCanBatch);
        for (std::size_t i = 0; i < batch.count; ++i) {
            SyncFrame sync;
            ASSERT_EQ(decode(got[i], sync), Refusal::none);
            ASSERT_EQ(sync.counter, next++);
        }
    }
    EXPECT_EQ(can.receive(got, Duration{0}).count, 0U);
}

TEST(SocketCan, an_empty_queue_is_no_fault_and_the_end_of_the_stream_is_gone) {
    Pair pair(SOCK_SEQPACKET);
    SocketCan can(pair.ours());
    std::array<CanFrame, 8> got;
    CanBatch batch = can.receive(got, milliseconds(1));
    EXPECT_EQ(batch.count, 0U);
    EXPECT_EQ(batch.fault, CanFault::none);
    ASSERT_TRUE(pair.send(pos()));
    pair.close_theirs();
    batch = can.receive(got, milliseconds(100));
    EXPECT_EQ(batch.count, 1U);
    if (batch.fault == CanFault::none) batch = can.receive(got, milliseconds(100));
    EXPECT_EQ(batch.fault, CanFault::gone);
    EXPECT_EQ(can.receive(got, milliseconds(1)).fault, CanFault::gone);
    EXPECT_FALSE(can.reopen());
}

// A UDP socket counts overflow like a CAN socket.
TEST(SocketCan, frames_dropped_by_the_kernel_are_counted) {
    const int in = socket(AF_INET, SOCK_DGRAM | SOCK_NONBLOCK, 0), out = socket(AF_INET, SOCK_DGRAM, 0);
    if (in < 0 || out < 0) GTEST_SKIP() << "UDP is not available";
    SocketCan can(in);
    const int on = 1, room = 2048;
    sockaddr_in address{};
    address.sin_family = AF_INET;
    address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    socklen_t size = sizeof address;
    if (setsockopt(in, SOL_SOCKET, SO_RXQ_OVFL, &on, sizeof on) != 0 ||
        setsockopt(in, SOL_SOCKET, SO_RCVBUF, &room, sizeof room) != 0 ||
        bind(in, reinterpret_cast<sockaddr*>(&address), sizeof address) != 0 ||
        getsockname(in, reinterpret_cast<sockaddr*>(&address), &size) != 0 ||
        connect(out, reinterpret_cast<sockaddr*>(&address), sizeof address) != 0) {
        ::close(out);
        GTEST_SKIP() << "the loopback interface is not available";
    }
    constexpr std::size_t kSent = 200;
    can_frame raw{};
    raw.can_id = kPosId;
    raw.len = 8;
    const auto send_all = [&](std::size_t n) {
        std::size_t sent = 0;
        for (std::size_t i = 0; i < n; ++i) sent += ::send(out, &raw, sizeof raw, 0) == sizeof raw ? 1U : 0U;
        return sent;
    };
    const std::size_t sent = send_all(kSent);
    std::array<CanFrame, kCanBatch> got;
    std::size_t taken = 0;
    std::uint64_t dropped = 0;
    // The overflow count arrives with the next received frame.
    for (int i = 0; i < 10'000 && taken + dropped < sent; ++i) {
        const CanBatch batch = can.receive(got, milliseconds(1));
        taken += batch.count;
        dropped += batch.dropped;
        if (batch.count == 0) taken -= send_all(1);
    }
    ::close(out);
    EXPECT_GT(dropped, 0U);
    EXPECT_LT(dropped, kSent);
    EXPECT_EQ(taken + dropped, sent);
}

TEST(SocketCan, filters_pass_only_the_frames_of_the_tracker) {
    const auto passes = [](const std::vector<can_filter>& filters, canid_t id) {
        return std::any_of(filters.begin(), filters.end(), [id](const can_filter& f) {
            return (id & f.can_mask) == (f.can_id & f.can_mask);  // as documented by the kernel
        });
    };
    for (unsigned sensors = 1; sensors <= 4; ++sensors) {
        const auto classic = tracker_filters(CanFormat::classic, sensors);
        const auto fd = tracker_filters(CanFormat::fd, sensors);
        for (canid_t id = 0; id < 0x800; ++id) {
            const auto among = [&](canid_t first) { return id >= first && id < first + sensors; };
            EXPECT_EQ(passes(classic, id), id == 0x0F0 || among(0x100) || among(0x110)) << id;
            EXPECT_EQ(passes(fd, id), among(0x200)) << id;
            EXPECT_FALSE(passes(classic, id | CAN_EFF_FLAG) || passes(classic, id | CAN_RTR_FLAG)) << id;
        }
    }
}

TEST(SocketCan, refusals_name_the_interface_and_the_fix) {
    const auto says = [](CanStep step, int error, const char* why, const char* fix) {
        const std::string text = refusal([&] { refuse_interface(step, "can7", error); });
        EXPECT_NE(text.find("can7"), std::string::npos) << text;
        EXPECT_NE(text.find(why), std::string::npos) << text;
        EXPECT_NE(text.find(fix), std::string::npos) << text;
    };
    says(CanStep::socket, EAFNOSUPPORT, "no CAN", "modprobe can_raw");
    says(CanStep::socket, EPERM, "refused", "AF_CAN");
    says(CanStep::interface, ENODEV, "no such interface", "tracker.interface");
    says(CanStep::type, 0, "not a CAN interface", "type can");
    says(CanStep::state, 0, "down", "ip link set can7 up type can bitrate 1000000");
    says(CanStep::mtu, 0, "CAN FD", "fd on");
    says(CanStep::option, EINVAL, "option", "kernel");
    says(CanStep::bind, ENETDOWN, "binding", "ip link set can7 up");
}

// With and without CAN in the kernel.
TEST(SocketCan, a_missing_interface_is_refused_with_a_fix) {
    SocketCan can("no_such_can0", FixSettings{});
    const std::string text = refusal([&] { can.open(); });
    EXPECT_NE(text.find("no_such_can0"), std::string::npos) << text;
    EXPECT_NE(text.find("fix: "), std::string::npos) << text;
    std::array<CanFrame, 8> got;
    EXPECT_EQ(can.receive(got, milliseconds(1)).fault, CanFault::gone);
    EXPECT_FALSE(can.reopen());
}

// The complete driver: frames through a socket, thread, mailbox.
TEST(SocketCan, poses_sent_through_a_socket_become_samples_and_its_end_is_detected) {
    SimHeadSettings settings;
    settings.can.fix.sensors = 2;
    ServoClock clock(Duration{0});
    SimHeadBus bus(settings, clock);
    bus.open();
    Pair pair(SOCK_SEQPACKET);
    CanTracker tracker(settings.can, std::make_unique<SocketCan>(pair.ours()), "a socket");
    EXPECT_EQ(tracker.open().sensors, 2U);
    std::array<CanFrame, kCanBatch> frames;
    TrackerSample sample;
    const Instant end = Monotonic::now() + std::chrono::minutes(1);
    while (sample.sequence < 30 && Monotonic::now() < end) {
        const CanBatch batch = bus.receive(frames, milliseconds(10));
        for (std::size_t i = 0; i < batch.count; ++i) ASSERT_TRUE(pair.send(frames[i]));
        static_cast<void>(tracker.read(1, sample, Monotonic::now()));
    }
    EXPECT_GE(sample.sequence, 30U);
    EXPECT_LT((sample.T_tracker_sensor.p_m - settings.rest_m).norm(), 0.3);
    pair.close_theirs();
    while (tracker.health().link != TrackerLink::gone && Monotonic::now() < end)
        std::this_thread::sleep_for(milliseconds(1));
    EXPECT_EQ(tracker.health().link, TrackerLink::gone);
    EXPECT_EQ(tracker.health().link_losses, 1U);
}

}  // namespace
}  // namespace tact::hal_socket_can_test
