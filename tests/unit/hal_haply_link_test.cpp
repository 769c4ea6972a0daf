// WebSocket to the Inverse Service: frames as pure functions, and the link with a server on this machine.
#include <arpa/inet.h>
#include <gtest/gtest.h>
#include <netinet/in.h>
#include <sys/socket.h>
#include <unistd.h>

#include <functional>
#include <thread>

#include "hal/haply/inverse3.hpp"
#include "hal/haply/inverse_link.hpp"
#include "hal/haply/inverse_messages.hpp"
#include "tests/support/fake_inverse.hpp"
#include "tests/support/says.hpp"

namespace tact::haply {
namespace {

constexpr const char* kAccepted =
    "HTTP/1.1 101 Switching Protocols\r\nUpgrade: websocket\r\nSEC-WEBSOCKET-ACCEPT:  "
    "s3pPLMBiTxaQ9kYGzzhZRbK+xOo= \r\n\r\n";

TEST(HaplyFrames, the_handshake_accepts_the_right_answer_only) {
    EXPECT_TRUE(
        says(handshake_request("127.0.0.1", 10001),
             {"GET / HTTP/1.1\r\n", "Host: 127.0.0.1:10001\r\n", "Sec-WebSocket-Version: 13\r\n\r\n"}));
    std::size_t used = 0;
    const std::string answer = std::string(kAccepted) + "xyz";
    EXPECT_EQ(check_handshake(answer, used), ReadResult::message);
    EXPECT_EQ(answer.substr(used), "xyz");
    for (std::size_t n = 0; n < std::string_view(kAccepted).size(); ++n)
        EXPECT_EQ(check_handshake(std::string_view(kAccepted).substr(0, n), used), ReadResult::need_more)
            << n;
    std::string wrong = kAccepted;
    wrong[wrong.find("s3p")] = 'S';
    EXPECT_EQ(check_handshake(wrong, used), ReadResult::broken);
    EXPECT_EQ(check_handshake("HTTP/1.1 200 OK\r\n\r\n", used), ReadResult::broken);
    EXPECT_EQ(check_handshake("HTTP/1.1 101 x\r\n\r\n", used), ReadResult::broken);
    EXPECT_EQ(check_handshake(std::string(kHandshakeMax, 'a'), used), ReadResult::broken);
}

TEST(HaplyFrames, a_message_of_any_size_survives_the_client_s_mask) {
    for (const std::size_t n : {std::size_t{0}, std::size_t{1}, std::size_t{125}, std::size_t{126},
                                std::size_t{65535}, std::size_t{65536}}) {
        const std::string text(n, 'q');
        std::string frame;
        append_frame(frame, Opcode::text, text, 0x12345678U);
        EXPECT_EQ(static_cast<std::uint8_t>(frame[0]), 0x81U);
        EXPECT_NE(static_cast<std::uint8_t>(frame[1]) & 0x80U, 0U);
        const std::size_t header = n < 126 ? 6 : n <= 0xFFFF ? 8 : 14;
        ASSERT_EQ(frame.size(), header + n);
        std::string back;
        for (std::size_t i = 0; i < n; ++i)
            back.push_back(static_cast<char>(frame[header + i] ^ frame[header - 4 + i % 4]));
        EXPECT_EQ(back, text);
    }
}

TEST(HaplyFrames, fragments_are_joined_byte_by_byte_with_control_messages_between) {
    const std::string stream = server_frame(Opcode::text, "{\"a\":", false) +
                               server_frame(Opcode::ping, "p") + server_frame(Opcode::continuation, "1}") +
                               server_frame(Opcode::text, std::string(70000, 'z'));
    FrameReader reader;
    std::vector<std::string> got;
    Opcode opcode{};
    std::string payload;
    for (const char c : stream) {
        ASSERT_TRUE(reader.feed(std::string_view(&c, 1)));
        while (reader.next(opcode, payload) == ReadResult::message) got.push_back(payload);
    }
    ASSERT_EQ(got.size(), 3U);
    EXPECT_EQ(got[0], "p");
    EXPECT_EQ(got[1], "{\"a\":1}");
    EXPECT_EQ(got[2].size(), 70000U);
}

TEST(HaplyFrames, broken_frames_stay_broken) {
    std::string masked;
    append_frame(masked, Opcode::text, "x", 1);
    for (const std::string& bad :
         {masked, std::string("\xC1\x01x"), server_frame(Opcode::continuation, "x"),
          server_frame(Opcode::text, "a", false) + server_frame(Opcode::text, "b"),
          server_frame(Opcode::ping, std::string(126, 'x')), server_frame(Opcode::ping, "x", false),
          server_frame(static_cast<Opcode>(3), "x"), server_frame(static_cast<Opcode>(11), "x"),
          std::string("\x81\x7F\xFF\xFF\xFF\xFF\xFF\xFF\xFF\xFF", 10),
          server_frame(Opcode::text, std::string(kMessageMax + 1, 'x'))}) {
        FrameReader reader;
        Opcode opcode{};
        std::string payload;
        static_cast<void>(reader.feed(bad));
        ReadResult result = reader.next(opcode, payload);
        EXPECT_EQ(result, ReadResult::broken) << bad.substr(0, 12);
        static_cast<void>(reader.feed(server_frame(Opcode::text, "good")));
        EXPECT_EQ(reader.next(opcode, payload), ReadResult::broken);
    }
    FrameReader reader;
    EXPECT_FALSE(reader.feed(std::string(2 * kMessageMax + 1, 'x')));
}

TEST(HaplyMessages, only_objects_and_plain_identifiers_are_read) {
    EXPECT_FALSE(parse("", ""));
    EXPECT_FALSE(parse("[1]", ""));
    EXPECT_FALSE(parse("{\"a\":", ""));
    EXPECT_FALSE(parse(std::string(100000, '['), ""));
    EXPECT_TRUE(parse(R"({"inverse3":[{"device_id":"a\"b"},{"device_id":7},{},3]})", "")->ids.empty());
    EXPECT_FALSE(parse(R"({"inverse3":[{"device_id":"A"},{"device_id":"B"}]})", "")->found);
    EXPECT_EQ(parse(R"({"inverse3":[{"device_id":"A"},{"device_id":"B"}]})", "B")->id, "B");
    EXPECT_FALSE(parse(R"({"inverse3":[{"device_id":"A"}]})", "B")->found);
    EXPECT_FALSE(plain_id(std::string(kIdMax + 1, 'a')));
    for (const std::string& text : {configure_message("A"), full_state_message("A"), probe_message("A"),
                                    force_message("A", Vec3(1.0, -2.0, 0.5))})
        EXPECT_TRUE(nlohmann::json::parse(text, nullptr, false).is_object()) << text;
}

// A server of one connection on a free port of this machine.
class Server {
public:
    explicit Server(std::function<void(int)> serve) {
        listener_ = ::socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0);
        sockaddr_in address{};
        address.sin_family = AF_INET;
        address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
        socklen_t size = sizeof address;
        if (::bind(listener_, reinterpret_cast<sockaddr*>(&address), size) != 0 ||
            ::listen(listener_, 1) != 0 ||
            ::getsockname(listener_, reinterpret_cast<sockaddr*>(&address), &size) != 0)
            std::abort();
        port = ntohs(address.sin_port);
        thread_ = std::thread([this, serve = std::move(serve)] {
            const int connection = ::accept(listener_, nullptr, nullptr);
            serve(connection);
            ::close(connection);
        });
    }
    ~Server() {
        thread_.join();
        ::close(listener_);
    }
    static std::string read(int connection, const std::string& until) {
        std::string text;
        char c = 0;
        while (text.find(until) == std::string::npos && ::recv(connection, &c, 1, 0) == 1) text.push_back(c);
        return text;
    }
    static void write(int connection, const std::string& bytes) {
        static_cast<void>(::send(connection, bytes.data(), bytes.size(), MSG_NOSIGNAL));
    }
    std::uint16_t port = 0;

private:
    int listener_ = -1;
    std::thread thread_;
};

TEST(InverseLink, talks_to_a_server_and_notices_its_end) {
    std::string request, frame;
    Server server([&](int connection) {
        request = Server::read(connection, "\r\n\r\n");
        Server::write(connection, kAccepted + server_frame(Opcode::text, "inventory"));
        char bytes[11];  // "hello" in a masked frame
        if (::recv(connection, bytes, sizeof bytes, MSG_WAITALL) == sizeof bytes)
            frame.assign(bytes, sizeof bytes);
        Server::write(connection, server_frame(Opcode::ping, "p") + server_frame(Opcode::text, "state"));
        char pong[7];
        static_cast<void>(::recv(connection, pong, sizeof pong, MSG_WAITALL));
        Server::write(connection, server_frame(Opcode::close, ""));
    });
    InverseLink link(server.port);
    ASSERT_EQ(link.open(), "");
    std::string text;
    ASSERT_EQ(link.receive(text, std::chrono::seconds(20)), ReadResult::message);
    EXPECT_EQ(text, "inventory");
    EXPECT_EQ(link.receive(text, Duration{0}), ReadResult::need_more);
    ASSERT_TRUE(link.send("hello"));
    ASSERT_EQ(link.receive(text, std::chrono::seconds(20)), ReadResult::message);
    EXPECT_EQ(text, "state");
    EXPECT_EQ(link.receive(text, std::chrono::seconds(20)), ReadResult::broken);
    EXPECT_FALSE(link.send("more"));
    link.close();
    EXPECT_TRUE(says(request, {"Upgrade: websocket"}));
    ASSERT_EQ(frame.size(), 11U);
    EXPECT_EQ(frame[6] ^ frame[2], 'h');
}

// The text of a masked frame; "" at the end of the connection.
std::string client_text(int connection) {
    const auto exactly = [connection](std::size_t n) {
        std::string bytes(n, '\0');
        const ssize_t got = ::recv(connection, bytes.data(), n, MSG_WAITALL);
        return got == static_cast<ssize_t>(n) ? bytes : std::string();
    };
    const std::string head = exactly(2);
    if (head.empty()) return "";
    std::size_t size = static_cast<std::uint8_t>(head[1]) & 0x7FU;
    if (size == 126) {
        const std::string two = exactly(2);
        if (two.empty()) return "";
        size = static_cast<std::size_t>(static_cast<std::uint8_t>(two[0])) << 8U |
               static_cast<std::uint8_t>(two[1]);
    }
    const std::string mask = exactly(4);
    std::string text = exactly(size);
    if (mask.empty()) return "";
    for (std::size_t i = 0; i < text.size(); ++i) text[i] = static_cast<char>(text[i] ^ mask[i % 4]);
    return text;
}

// Servo, pump and service in a thread each, over a socket, as in reality.
TEST(InverseLink, samples_and_forces_pass_between_servo_pump_and_service) {
    FakeInverse service;
    bool moved = false;
    {
        Server server([&](int connection) {
            static_cast<void>(Server::read(connection, "\r\n\r\n"));
            Server::write(connection, kAccepted + server_frame(Opcode::text, service.state(true)));
            for (std::string text = client_text(connection); !text.empty(); text = client_text(connection)) {
                Server::write(connection, server_frame(Opcode::text, service.answer(text)));
                service.tick();
            }
        });
        Inverse3Settings settings;
        settings.port = server.port;
        settings.pump_priority = 0;
        Inverse3 device(settings);
        EXPECT_EQ(device.open().serial, "049D");
        DeviceSample sample;
        DeviceCommand command;
        const Instant end = Monotonic::now() + std::chrono::minutes(1);
        for (bool enable = false; !moved && Monotonic::now() < end;) {
            static_cast<void>(device.read(sample, Monotonic::now()));
            if (sample.state == DeviceState::watchdog_tripped || sample.state == DeviceState::fault)
                enable = false;
            command.enable = enable;
            command.wrench_dev.force_n = Vec3(1.0, 0.0, 0.0);
            ++command.heartbeat;
            static_cast<void>(device.write(command, Monotonic::now()));
            if (sample.state == DeviceState::ready) enable = true;
            moved = sample.state == DeviceState::powered && sample.twist_dev.linear_m_s.x() > 0.0;
            std::this_thread::sleep_for(std::chrono::milliseconds(1));
        }
    }
    EXPECT_TRUE(moved);
    EXPECT_EQ(service.force_n, (std::array<double, 3>{}));  // the last message had no force
}

TEST(InverseLink, a_closed_port_and_another_kind_of_server_are_reported) {
    std::uint16_t closed = 0;
    {
        Server other([](int connection) {
            static_cast<void>(Server::read(connection, "\r\n\r\n"));
            Server::write(connection, "HTTP/1.1 404 Not Found\r\n\r\n");
        });
        closed = other.port;
        InverseLink link(other.port);
        EXPECT_TRUE(says(link.open(), {"does not speak WebSocket"}));
    }
    InverseLink link(closed);
    EXPECT_TRUE(says(link.open(), {"no connection", "refused"}));
    std::string text;
    EXPECT_FALSE(link.send("x"));
    EXPECT_EQ(link.receive(text, Duration{0}), ReadResult::broken);
}

}  // namespace
}  // namespace tact::haply
