// tact igtl: the messages of a region, also of a hostile one, and the server with clients that misbehave.
#include <arpa/inet.h>
#include <gtest/gtest.h>
#include <netinet/in.h>
#include <poll.h>
#include <sys/socket.h>
#include <unistd.h>

#include <cmath>
#include <cstring>
#include <map>
#include <memory>

#include "deploy/tact/igtl_messages.hpp"
#include "deploy/tact/igtl_server.hpp"
#include "ipc/base/error.hpp"

namespace tact::launch {
namespace {

using std::chrono::milliseconds;

constexpr std::int64_t kUtcNs = 1'700'000'000'000'000'000;

struct IgtlRead {
    std::string type;
    std::int64_t time_ns = 0;
    std::vector<std::byte> body;
};

double float64_at(const std::vector<std::byte>& body, std::size_t at) {
    std::uint64_t bits = 0;
    for (std::size_t i = 0; i < 8; ++i) bits = bits << 8U | std::to_integer<std::uint64_t>(body.at(at + i));
    double value = 0.0;
    std::memcpy(&value, &bits, sizeof value);
    return value;
}

// The values of a SENSOR.
std::vector<double> values_of(const IgtlRead& m) {
    std::vector<double> values;
    for (std::size_t i = 0; i < std::to_integer<std::size_t>(m.body.at(0)); ++i)
        values.push_back(float64_at(m.body, 10 + 8 * i));
    return values;
}

Pose pose_of(const std::string& name, const IgtlBytes& bytes) {
    IgtlStream stream;
    const auto room = stream.room();
    std::copy(bytes.begin(), bytes.end(), room.begin());
    stream.add(bytes.size());
    while (stream.next() == IgtlStream::Next::message) {
        IgtlPoses poses;
        if (stream.header.device.view() == name &&
            decode_poses(stream.header, stream.body, poses) == IgtlFault::none)
            return poses.pose[0].T;
    }
    ADD_FAILURE() << "no TRANSFORM of " << name;
    return {};
}

std::map<std::string, IgtlRead> read_all(const IgtlBytes& bytes) {
    std::map<std::string, IgtlRead> all;
    IgtlStream stream;
    const auto room = stream.room();
    EXPECT_LE(bytes.size(), room.size());
    std::copy(bytes.begin(), bytes.end(), room.begin());
    stream.add(bytes.size());
    for (auto next = stream.next(); next != IgtlStream::Next::more; next = stream.next()) {
        EXPECT_EQ(next, IgtlStream::Next::message);
        all[std::string(stream.header.device.view())] = {std::string(stream.header.type.view()),
                                                         stream.header.time_ns,
                                                         {stream.body.begin(), stream.body.end()}};
    }
    return all;
}

class IgtlMessagesTest : public testing::Test {
protected:
    IgtlMessagesTest() : region_(std::make_unique<RtRegion>()), now_(std::chrono::seconds(1000)) {
        HealthTopic h{};
        h.state = static_cast<std::uint8_t>(RunState::active);
        h.reason = static_cast<std::uint8_t>(RunReason::hand_present);
        h.force_rate_hz = 999.6;
        region_->health.publish(h);
    }
    ToolTopic tool() {
        ToolTopic t{};
        t.taken_at_ns = to_ns(now_) - 2'000'000;
        t.cycle = ++cycle_;
        t.pos_world_m[0] = 0.010;
        t.pos_world_m[2] = -0.020;
        const Quat q(Eigen::AngleAxisd(0.5, Vec3::UnitY()));
        for (int i = 0; i < 4; ++i) t.quat_world_tool_xyzw[i] = q.coeffs()[i];
        t.force_world_n[1] = 1.5;
        t.torque_world_n_m[2] = -0.01;
        return t;
    }
    IgtlBytes batch() { return messages_.batch(region_.get(), now_, kUtcNs); }

    std::unique_ptr<RtRegion> region_;
    IgtlMessages messages_;
    Instant now_;
    std::uint64_t cycle_ = 0;
};

TEST_F(IgtlMessagesTest, pose_force_and_torque_of_each_hand_with_the_time_of_the_measurement) {
    region_->tool[0].publish(tool());
    region_->tool[1].publish(tool());
    const IgtlBytes bytes = batch();
    auto all = read_all(bytes);
    for (const std::string name : {"Tool", "Tool2"}) {
        EXPECT_EQ(all[name + "ToWorld"].type, "TRANSFORM");
        EXPECT_NEAR(static_cast<double>(all[name + "ToWorld"].time_ns - (kUtcNs - 2'000'000)), 0.0, 2.0);
        const Pose T = pose_of(name + "ToWorld", bytes);
        EXPECT_LT((T.p_m - Vec3(0.010, 0.0, -0.020)).norm(), 1e-7);
        EXPECT_LT(T.q.angularDistance(Quat(Eigen::AngleAxisd(0.5, Vec3::UnitY()))), 1e-5);
        EXPECT_EQ(all[name + "Force"].type, "SENSOR");
        EXPECT_EQ(values_of(all[name + "Force"]), (std::vector{0.0, 1.5, 0.0}));
        EXPECT_EQ(values_of(all[name + "Torque"]), (std::vector{0.0, 0.0, -0.01}));
    }
    EXPECT_EQ(all.count("HeadToScreen") + all.count("ToolDepth") + all.count("ToolToPatient"), 0U);
}

TEST_F(IgtlMessagesTest, a_value_is_sent_once) {
    region_->tool[0].publish(tool());
    EXPECT_EQ(read_all(batch()).count("ToolToWorld"), 1U);
    EXPECT_EQ(read_all(batch()).count("ToolToWorld"), 0U);
    region_->tool[0].publish(tool());
    EXPECT_EQ(read_all(batch()).count("ToolToWorld"), 1U);
}

TEST_F(IgtlMessagesTest, the_status_comes_at_every_change_and_once_per_second_with_the_number_of_poses) {
    const auto status = [&](milliseconds later) {
        now_ += later;
        const auto all = read_all(batch());
        return all.count("TactStatus") != 0 ? all.at("TactStatus").body : std::vector<std::byte>();
    };
    const auto code = [](const std::vector<std::byte>& body) { return std::to_integer<int>(body.at(1)); };
    const auto number = [](const std::vector<std::byte>& body) { return std::to_integer<int>(body.at(9)); };
    region_->tool[0].publish(tool());
    auto body = status(milliseconds(0));
    EXPECT_EQ(code(body), 1);
    EXPECT_EQ(number(body), 0);
    EXPECT_TRUE(status(milliseconds(500)).empty());
    region_->tool[0].publish(tool());
    EXPECT_TRUE(status(milliseconds(499)).empty());
    EXPECT_EQ(number(status(milliseconds(1))), 2);
    messages_.greet();
    EXPECT_EQ(number(status(milliseconds(1))), 2);
    EXPECT_TRUE(status(milliseconds(1)).empty());
    HealthTopic h{};
    h.state = static_cast<std::uint8_t>(RunState::fault);
    h.reason = static_cast<std::uint8_t>(RunReason::emergency_stop);
    region_->health.publish(h);
    body = status(milliseconds(1));
    EXPECT_EQ(code(body), 3);
    EXPECT_STREQ(reinterpret_cast<const char*>(body.data()) + 10, "emergency_stop");
    const auto none = read_all(messages_.batch(nullptr, now_ += std::chrono::seconds(1), kUtcNs));
    EXPECT_EQ(code(none.at("TactStatus").body), 16);
    EXPECT_EQ(none.size(), 2U);  // status and text alone
}

TEST_F(IgtlMessagesTest, depths_are_in_millimetres_of_the_hands_space) {
    IgtlScene scene;
    scene.world_per_model = 1e6;
    messages_.scene(scene);
    TouchTopic touch{};
    touch.cycle = 1;
    touch.probe_model_m[0] = 3e-9;
    touch.proxy_model_m[0] = 1e-9;
    region_->touch.publish(touch);
    const auto all = read_all(batch());
    EXPECT_NEAR(values_of(all.at("ToolDepth")).at(0), 2.0, 1e-9);
}

TEST_F(IgtlMessagesTest, a_drilling_tool_is_where_the_scan_shows_it) {
    IgtlScene scene;
    scene.world_per_model = 1.0;
    // Model x to the front, y up, z to the patient's left; model (0, 0, 0) at 100, 50, -20 mm (LPS).
    scene.patient.emplace();
    scene.patient->axes.col(0) = Vec3(0, -1, 0);
    scene.patient->axes.col(1) = Vec3(0, 0, 1);
    scene.patient->axes.col(2) = Vec3(-1, 0, 0);
    ASSERT_NEAR(scene.patient->axes.determinant(), 1.0, 1e-12);
    scene.patient->origin_mm = Vec3(100, 50, -20);
    messages_.scene(scene);
    DrillTopic drill{};
    drill.cycle = 1;
    DrillHand& h = drill.hand[1];
    h.kind = DrillKind::burr;
    h.pos_model_m[0] = 0.010;
    h.quat_model_tool_xyzw[3] = 1.0;
    h.radius_m = 0.003F;
    h.depth = 0.5F;
    region_->drill.publish(drill);
    const IgtlBytes bytes = batch();
    const auto all = read_all(bytes);
    EXPECT_EQ(all.count("ToolToPatient"), 0U);
    EXPECT_NEAR(values_of(all.at("Tool2Depth")).at(0), 1.5, 1e-6);
    const Pose T = pose_of("Tool2ToPatient", bytes);
    // LPS (100, 40, -20) is RAS (-100, -40, -20).
    EXPECT_LT((T.p_m - 1e-3 * Vec3(-100, -40, -20)).norm(), 1e-6);
    EXPECT_LT((T.q * Vec3::UnitX() - Vec3(0, 1, 0)).norm(), 1e-6);  // to the front: RAS +y
    EXPECT_LT((T.q * Vec3::UnitY() - Vec3(0, 0, 1)).norm(), 1e-6);
    scene.patient.reset();
    messages_.scene(scene);
    drill.cycle = 2;
    region_->drill.publish(drill);
    EXPECT_EQ(read_all(batch()).count("Tool2ToPatient"), 0U);
}

TEST_F(IgtlMessagesTest, only_a_tracked_head_is_sent) {
    HeadTopic h{};
    h.sequence = 1;
    h.state = 1;  // frozen
    h.quat_screen_head_xyzw[3] = 1.0;
    h.pos_screen_m[2] = 0.6;
    region_->head.publish(h);
    EXPECT_EQ(read_all(batch()).count("HeadToScreen"), 0U);
    h.state = 2;
    h.sequence = 2;
    region_->head.publish(h);
    EXPECT_NEAR(pose_of("HeadToScreen", batch()).p_m.z(), 0.6, 1e-6);
}

TEST_F(IgtlMessagesTest, a_hostile_region_gives_no_number_that_is_not_finite) {
    std::uint32_t seed = 1;
    const auto garbage = [&](auto& topic, int kind) {
        auto* const bytes = reinterpret_cast<unsigned char*>(&topic);
        for (std::size_t i = 0; i < sizeof topic; ++i) {
            seed = seed * 1664525U + 1013904223U;
            bytes[i] = kind == 0 ? 0xFF : kind == 1 ? 0x7F : static_cast<unsigned char>(seed >> 24U);
        }
    };
    IgtlScene scene;
    scene.world_per_model = 1e300;
    scene.patient.emplace();
    messages_.scene(scene);
    for (int n = 0; n < 300; ++n) {
        const int kind = std::min(n, 2);
        ToolTopic t;
        TouchTopic touch;
        DrillTopic drill;
        HeadTopic h;
        HealthTopic health;
        garbage(t, kind);
        garbage(touch, kind);
        garbage(drill, kind);
        garbage(h, kind);
        garbage(health, kind);
        drill.hand[0].kind = DrillKind::burr;
        h.state = 2;
        region_->tool[n % 2].publish(t);
        region_->touch.publish(touch);
        region_->drill.publish(drill);
        region_->head.publish(h);
        region_->health.publish(health);
        for (const auto& [name, m] : read_all(batch())) {
            EXPECT_NE(m.type, "TRANSFORM") << name;  // random bytes are no unit quaternion
            if (m.type != "SENSOR") continue;
            for (const double v : values_of(m)) EXPECT_TRUE(std::isfinite(v)) << name;
        }
    }
}

class IgtlServerTest : public testing::Test {
protected:
    IgtlServerTest() : server_("127.0.0.1", 0) {}
    ~IgtlServerTest() override {
        for (const int fd : fds_) ::close(fd);
    }
    int connect_client(int receive_queue = 0) {
        const int fd = socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0);
        fds_.push_back(fd);
        if (receive_queue > 0) setsockopt(fd, SOL_SOCKET, SO_RCVBUF, &receive_queue, sizeof receive_queue);
        sockaddr_in a{};
        a.sin_family = AF_INET;
        a.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
        a.sin_port = htons(static_cast<std::uint16_t>(server_.port()));
        EXPECT_EQ(connect(fd, reinterpret_cast<const sockaddr*>(&a), sizeof a), 0);
        return fd;
    }
    void period() { server_.serve_until(Monotonic::now() + milliseconds(2)); }
    void send_number(std::int64_t number) {
        IgtlBytes bytes;
        append_status(bytes, "TactStatus", IgtlStatus::ok, number, "", std::string(400, 'x'), 0);
        server_.send(bytes);
    }
    // Whether there is something to read, or the end.
    static bool readable(int fd) {
        pollfd p{fd, POLLIN, 0};
        return poll(&p, 1, 5000) > 0;
    }
    // The numbers that the client has received; false: the connection ended.
    static bool take(int fd, IgtlStream& stream, std::vector<int>& numbers) {
        for (;;) {
            const auto room = stream.room();
            const ssize_t n = recv(fd, room.data(), room.size(), MSG_DONTWAIT);
            if (n == 0 || (n < 0 && errno != EAGAIN)) return false;
            if (n < 0) return true;
            stream.add(static_cast<std::size_t>(n));
            while (stream.next() == IgtlStream::Next::message)
                numbers.push_back(std::to_integer<int>(stream.body[8]) << 8 |
                                  std::to_integer<int>(stream.body[9]));
        }
    }

    IgtlServer server_;
    std::vector<int> fds_;
};

TEST_F(IgtlServerTest, every_client_gets_every_message_while_others_send_garbage_flood_or_do_not_read) {
    const int good = connect_client(), slow = connect_client(4096), rude = connect_client();
    period();
    ASSERT_EQ(server_.clients(), 3U);
    IgtlStream stream, slow_stream;
    std::vector<int> numbers, slow_numbers;
    const std::vector<char> garbage(100'000, 'Z');
    for (int n = 1; n <= 2000; ++n) {
        static_cast<void>(::send(rude, garbage.data(), garbage.size(), MSG_DONTWAIT | MSG_NOSIGNAL));
        const std::uint64_t before = server_.counts().bytes_ignored;
        send_number(n);
        if (n % 10 == 0) {
            server_.serve_until(Monotonic::now() + milliseconds(1));
            EXPECT_LE(server_.counts().bytes_ignored - before, IgtlServer::kReadMost);
        }
        ASSERT_TRUE(take(good, stream, numbers));
    }
    period();
    ASSERT_TRUE(take(good, stream, numbers));
    std::vector<int> wanted(2000);
    for (int n = 1; n <= 2000; ++n) wanted[static_cast<std::size_t>(n - 1)] = n;
    EXPECT_EQ(numbers, wanted);
    EXPECT_EQ(server_.counts().garbage, 1U);
    EXPECT_GT(server_.counts().bytes_ignored, 100'000U);
    // The slow one and the rude one, which does not read either, were dropped; what they got are whole messages.
    EXPECT_EQ(server_.counts().dropped, 2U);
    EXPECT_EQ(server_.clients(), 1U);
    // The last of its bytes may still be on the way.
    bool open = true;
    while (open && readable(slow)) open = take(slow, slow_stream, slow_numbers);
    EXPECT_FALSE(open) << "the connection of the slow client did not end";
    ASSERT_FALSE(slow_numbers.empty());
    for (std::size_t i = 0; i < slow_numbers.size(); ++i) EXPECT_EQ(slow_numbers[i], static_cast<int>(i + 1));
    EXPECT_LT(slow_numbers.size(), 2000U);
    const auto news = server_.take_news();
    EXPECT_LE(news.size(), 9U);
    EXPECT_TRUE(std::any_of(news.begin(), news.end(), [](const std::string& line) {
        return line.find("reads too slowly and was dropped") != std::string::npos;
    }));
}

TEST_F(IgtlServerTest, requests_are_counted_and_ignored) {
    const int fd = connect_client();
    IgtlBytes request;
    append_start_tdata(request, 20);
    append_transform(request, "ToolToWorld", {}, 0);
    ASSERT_EQ(::send(fd, request.data(), request.size(), 0), static_cast<ssize_t>(request.size()));
    period();
    period();
    EXPECT_EQ(server_.counts().messages_ignored, 2U);
    EXPECT_EQ(server_.counts().bytes_ignored, request.size());
    EXPECT_EQ(server_.counts().garbage, 0U);
    char byte = 0;
    EXPECT_EQ(recv(fd, &byte, 1, MSG_DONTWAIT), -1);  // no answer
    EXPECT_EQ(server_.clients(), 1U);
}

TEST_F(IgtlServerTest, more_clients_than_the_limit_are_turned_away_and_a_place_becomes_free) {
    for (std::size_t i = 0; i < IgtlServer::kClientsMost + 3; ++i) connect_client();
    period();
    EXPECT_EQ(server_.counts().accepted + server_.counts().turned_away, IgtlServer::kAcceptsMost);
    period();
    EXPECT_EQ(server_.clients(), IgtlServer::kClientsMost);
    EXPECT_EQ(server_.counts().turned_away, 3U);
    ::close(fds_.front());
    fds_.erase(fds_.begin());
    period();
    connect_client();
    period();
    EXPECT_EQ(server_.counts().accepted, IgtlServer::kClientsMost + 1);
    EXPECT_LE(server_.take_news().size(), 9U);
}

TEST(IgtlServer, a_taken_port_or_a_foreign_address_is_an_error_with_the_fix) {
    const auto refusal = [](const std::string& address, int port) -> std::string {
        try {
            IgtlServer server(address, port);
        } catch (const StartupError& e) {
            return e.what();
        }
        return "no error";
    };
    const IgtlServer first("127.0.0.1", 0);
    const std::string taken = refusal("127.0.0.1", first.port());
    EXPECT_NE(taken.find("another program listens there"), std::string::npos) << taken;
    EXPECT_NE(taken.find("--port"), std::string::npos);
    EXPECT_NE(refusal("192.0.2.1", 0).find("not of this machine"), std::string::npos);
    EXPECT_NE(refusal("no such host", 0).find("--listen"), std::string::npos);
}

}  // namespace
}  // namespace tact::launch
