// The link between processes, with both ends in one process: poll() drives each step, so no test sleeps.
#include <fcntl.h>
#include <gtest/gtest.h>
#include <sys/socket.h>
#include <sys/stat.h>
#include <sys/un.h>
#include <unistd.h>

#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "ipc/base/error.hpp"
#include "ipc/shm/hello.hpp"
#include "ipc/shm/link.hpp"
#include "ipc/topics/bone_region.hpp"
#include "ipc/topics/regions.hpp"

namespace tact::ipc_link_test {
namespace {

class Link : public ::testing::Test {
protected:
    void SetUp() override {
        char name[] = "/tmp/tact-link-XXXXXX";
        folder_ = mkdtemp(name);
        setenv("TACT_RUNTIME_DIR", folder_.c_str(), 1);
        HealthTopic health{};
        health.cycle = 77;
        rt_->health.publish(health);
        rt_.mark_ready();
        gui_.mark_ready();
    }
    void TearDown() override { std::filesystem::remove_all(folder_); }

    // A client without protocol; the test sends its messages.
    FileDescriptor raw_client() const {
        FileDescriptor s(socket(AF_UNIX, SOCK_SEQPACKET | SOCK_CLOEXEC, 0));
        sockaddr_un address{};
        address.sun_family = AF_UNIX;
        std::strcpy(address.sun_path, session_socket_path("t").c_str());
        EXPECT_EQ(connect(s.get(), reinterpret_cast<sockaddr*>(&address), sizeof address), 0);
        return s;
    }
    static HelloMessage hello(LinkRole role) {
        HelloMessage m{};
        m.magic = kHelloMagic;
        m.version = kLinkVersion;
        m.role = static_cast<std::uint32_t>(role);
        return m;
    }
    template <class M>
    static bool say(const FileDescriptor& s, const M& message, int file = -1) {
        return send_packet(s.get(), std::as_bytes(std::span(&message, 1)), file);
    }
    static std::uint32_t answer(const FileDescriptor& s) {
        Packet packet;
        AnswerMessage m{};
        if (receive_packet(s.get(), packet) != Receipt::message) return 99;
        EXPECT_EQ(parse_answer({packet.bytes, packet.size}, m), HelloCheck::good);
        return m.answer;
    }

    std::string folder_;
    OwnedRegion<RtRegion> rt_;
    OwnedRegion<GuiRegion> gui_;
};

TEST_F(Link, both_sides_read_the_region_of_the_other) {
    LinkServer server("t", rt_.fd());
    LinkClient client("t", gui_.fd());
    EXPECT_FALSE(client.poll().arrived);  // the request is sent
    LinkServer::News at_server = server.poll(0);
    ASSERT_TRUE(at_server.gui_arrived);
    EXPECT_EQ(at_server.gui_pid, static_cast<std::uint32_t>(getpid()));
    LinkClient::News at_client = client.poll();
    ASSERT_TRUE(at_client.arrived);
    EXPECT_TRUE(client.attached());

    std::string refusal;
    const auto rt = MappedRegion<RtRegion>::map(std::move(at_client.rt_fd), refusal);
    ASSERT_FALSE(rt.empty()) << refusal;
    EXPECT_EQ(rt.generation(), rt_.generation());
    HealthTopic health{};
    ASSERT_TRUE(rt->health.read(health));
    EXPECT_EQ(health.cycle, 77U);
    const auto gui = MappedRegion<GuiRegion>::map(std::move(at_server.gui_fd), refusal);
    ASSERT_FALSE(gui.empty()) << refusal;
    CommandQueue::Cursor cursor;
    CommandTopic command{};
    command.sequence = 1;
    gui_->commands.push(command);
    EXPECT_TRUE(gui->commands.next(cursor, command));
    EXPECT_EQ(server.refused(), 0U);
}

TEST_F(Link, the_bone_region_is_sent_with_the_main_region) {
    BoneRegionHead head{};
    head.bricks = 3;
    head.brick_bytes = 512;
    OwnedBoneRegion bone(head);
    bone.mark_ready();
    LinkServer server("t", rt_.fd(), bone.fd());
    for (const int own : {gui_.fd(), -1}) {  // to the visual process and to an observer
        LinkClient client("t", own);
        client.poll();
        server.poll(0);
        LinkClient::News news = client.poll();
        ASSERT_TRUE(news.arrived);
        std::string refusal;
        EXPECT_FALSE(MappedRegion<RtRegion>::map(std::move(news.rt_fd), refusal).empty()) << refusal;
        const auto mapped = MappedBoneRegion::map(std::move(news.bone_fd), refusal);
        ASSERT_FALSE(mapped.empty()) << refusal;
        EXPECT_EQ(mapped.generation(), bone.generation());
    }
    LinkServer without("plain", rt_.fd());
    LinkClient client("plain", -1);
    client.poll();
    without.poll(0);
    const LinkClient::News news = client.poll();
    EXPECT_TRUE(news.arrived && news.rt_fd.valid());
    EXPECT_FALSE(news.bone_fd.valid());
}

TEST_F(Link, the_controller_counts_recorders_while_they_are_connected) {
    LinkServer server("t", rt_.fd());
    using Recorders = LinkServer::Recorders;
    EXPECT_EQ(server.recorders(), Recorders{});
    const auto meet = [&](LinkClient& client) {
        for (int i = 0; i < 1000; ++i) {
            if (client.poll().arrived) return;
            server.poll(1);
        }
        FAIL() << client.status_text();
    };
    LinkClient observer("t", -1);
    meet(observer);
    EXPECT_EQ(server.recorders(), Recorders{});
    auto recorder = std::make_unique<LinkClient>("t", -1, LinkRole::recorder);
    meet(*recorder);
    LinkClient flight("t", -1, LinkRole::flight);
    meet(flight);
    EXPECT_EQ(server.recorders(), (Recorders{1, 1}));
    recorder.reset();
    server.poll(100);
    EXPECT_EQ(server.recorders(), (Recorders{0, 1}));
}

TEST_F(Link, an_instructor_may_stop_and_mark_and_nobody_else_may) {
    LinkServer server("t", rt_.fd());
    const auto meet = [&](LinkClient& client) {
        for (int i = 0; i < 1000; ++i) {
            if (client.poll().arrived) return;
            server.poll(1);
        }
        FAIL() << client.status_text();
    };
    LinkClient instructor("t", -1, LinkRole::instructor), observer("t", -1);
    EXPECT_FALSE(instructor.order(LinkOrder::stop));  // not attached
    meet(instructor);
    meet(observer);
    EXPECT_FALSE(observer.order(LinkOrder::stop));
    ASSERT_TRUE(instructor.order(LinkOrder::mark, {1.0, -2.0, 3.0}));
    ASSERT_TRUE(instructor.order(LinkOrder::stop));
    LinkServer::News news = server.poll(100);
    if (news.orders == 1) {  // one packet of a client a poll
        const LinkServer::News second = server.poll(100);
        ASSERT_EQ(second.orders, 1U);
        news.order[news.orders++] = second.order[0];
    }
    ASSERT_EQ(news.orders, 2U);
    EXPECT_EQ(news.order[0].what, LinkOrder::mark);
    EXPECT_EQ(news.order[0].pos_model_m[1], -2.0);
    EXPECT_EQ(news.order[0].pid, static_cast<std::uint32_t>(getpid()));
    EXPECT_EQ(news.order[1].what, LinkOrder::stop);
    EXPECT_EQ(server.refused(), 0U);
    {
        const auto s = raw_client();  // says that it observes, and orders
        say(s, hello(LinkRole::observer));
        server.poll(0);
        EXPECT_EQ(answer(s), static_cast<std::uint32_t>(LinkAnswer::attached));
        OrderMessage m{};
        m.magic = kOrderMagic;
        m.version = kLinkVersion;
        say(s, m);
        EXPECT_EQ(server.poll(100).orders, 0U);
        EXPECT_EQ(server.refused(), 1U);
    }
    // Places that are no places, and a flood, end the link.
    ASSERT_TRUE(instructor.order(LinkOrder::mark, {std::nan(""), 0.0, 0.0}));
    EXPECT_EQ(server.poll(100).orders, 0U);
    EXPECT_EQ(server.refused(), 2U);
    LinkClient flood("t", -1, LinkRole::instructor);
    meet(flood);
    std::size_t taken = 0;
    for (int i = 0; i < 200; ++i) {
        static_cast<void>(flood.order(LinkOrder::mark, {0.0, 0.0, 0.0}));
        taken += server.poll(1).orders;
    }
    EXPECT_GE(taken, 20U);
    EXPECT_LE(taken, 100U);
    EXPECT_EQ(server.refused(), 3U);
}

TEST_F(Link, second_controller_is_refused_with_the_first_ones_process_id) {
    const LinkServer first("t", rt_.fd());
    try {
        const LinkServer second("t", rt_.fd());
        FAIL() << "the second controller started";
    } catch (const StartupError& e) {
        EXPECT_NE(std::string(e.what()).find("process " + std::to_string(getpid())), std::string::npos)
            << e.what();
    }
    EXPECT_NO_THROW(LinkServer("other", rt_.fd()));
}

TEST_F(Link, client_reports_waiting_and_attaches_to_each_new_controller) {
    LinkClient client("t", -1);
    EXPECT_FALSE(client.poll().arrived);
    EXPECT_NE(client.status_text().find("it is not running"), std::string::npos) << client.status_text();
    for (int round = 0; round < 3; ++round) {
        auto server = std::make_unique<LinkServer>("t", rt_.fd());
        bool arrived = false;
        while (!arrived) {
            arrived = client.poll().arrived;
            server->poll(1);
        }
        server.reset();
        EXPECT_TRUE(client.poll().left);
        EXPECT_FALSE(client.attached());
    }
}

TEST_F(Link, second_visual_process_observes_and_takes_over_when_the_first_ends) {
    LinkServer server("t", rt_.fd());
    auto first = std::make_unique<LinkClient>("t", gui_.fd());
    LinkClient second("t", gui_.fd());
    first->poll();
    ASSERT_TRUE(server.poll(0).gui_arrived);
    second.poll();
    EXPECT_FALSE(server.poll(0).gui_arrived);
    EXPECT_TRUE(second.poll().arrived);
    EXPECT_NE(second.status_text().find("is its visual process"), std::string::npos) << second.status_text();
    first.reset();
    const LinkServer::News news = server.poll(0);
    EXPECT_TRUE(news.gui_left);
    EXPECT_TRUE(news.gui_arrived);
    EXPECT_TRUE(news.gui_fd.valid());
}

TEST_F(Link, garbage_is_dropped_and_counted_without_effect_on_others) {
    LinkServer server("t", rt_.fd());
    LinkClient watcher("t", -1);
    watcher.poll();
    server.poll(0);
    ASSERT_TRUE(watcher.poll().arrived);

    std::uint64_t refused = 0;
    const auto expect_refusal = [&](const char* what) {
        server.poll(0);
        EXPECT_EQ(server.refused(), ++refused) << what;
    };
    {
        const auto s = raw_client();
        EXPECT_EQ(send(s.get(), "hi", 2, 0), 2);
        expect_refusal("too short");
    }
    {
        const auto s = raw_client();
        const std::vector<char> big(100'000, 'x');
        EXPECT_GT(send(s.get(), big.data(), big.size(), 0), 0);
        expect_refusal("too long");
    }
    {
        const auto s = raw_client();
        auto m = hello(LinkRole::observer);
        m.magic ^= 1;
        say(s, m);
        expect_refusal("magic");
    }
    {
        const auto s = raw_client();
        auto m = hello(LinkRole::observer);
        m.role = 7;
        say(s, m);
        expect_refusal("role");
    }
    {
        const auto s = raw_client();
        auto m = hello(LinkRole::observer);
        m.reserved[5] = 1;
        say(s, m);
        expect_refusal("reserved");
    }
    {
        const auto s = raw_client();
        say(s, hello(LinkRole::gui));
        expect_refusal("a visual process without a region");
    }
    {
        const auto s = raw_client();
        say(s, hello(LinkRole::observer), gui_.fd());
        expect_refusal("an observer with a region");
    }
    {
        const auto s = raw_client();
        const HelloMessage m = hello(LinkRole::gui);
        EXPECT_TRUE(send_packet(s.get(), std::as_bytes(std::span(&m, 1)), gui_.fd(), gui_.fd()));
        expect_refusal("a visual process with two regions");
    }
    {
        const auto s = raw_client();
        auto m = hello(LinkRole::observer);
        m.version = 9;
        say(s, m);
        expect_refusal("version");
        EXPECT_EQ(answer(s), static_cast<std::uint32_t>(LinkAnswer::other_version));
    }
    {
        const auto s = raw_client();
        say(s, hello(LinkRole::observer));
        server.poll(0);
        EXPECT_EQ(answer(s), static_cast<std::uint32_t>(LinkAnswer::attached));
        say(s, hello(LinkRole::observer));
        expect_refusal("a second hello");
    }
    { raw_client(); }
    expect_refusal("closed without a hello");
    EXPECT_FALSE(watcher.poll().left);
    EXPECT_TRUE(watcher.attached());
}

TEST_F(Link, silent_clients_block_neither_the_server_nor_its_slots) {
    LinkServer server("t", rt_.fd());
    std::vector<FileDescriptor> silent;
    for (int i = 0; i < 12; ++i) {
        silent.push_back(raw_client());
        server.poll(0);
    }
    // Refused: the oldest clients beyond eight, or on a slow machine all that were silent for two seconds.
    EXPECT_GE(server.refused(), 4U);
    LinkClient client("t", -1);
    client.poll();
    server.poll(0);
    EXPECT_TRUE(client.poll().arrived);
}

TEST_F(Link, observers_are_limited) {
    LinkServer server("t", rt_.fd());
    std::vector<FileDescriptor> observers;
    std::uint32_t last = 0;
    int served = 0;
    for (int i = 0; i < 40 && last == 0; ++i) {
        observers.push_back(raw_client());
        say(observers.back(), hello(LinkRole::observer));
        server.poll(0);
        last = answer(observers.back());
        served += last == 0 ? 1 : 0;
    }
    EXPECT_EQ(last, static_cast<std::uint32_t>(LinkAnswer::full));
    EXPECT_EQ(served, 16);
    EXPECT_EQ(server.refused(), 1U);
}

TEST_F(Link, client_refuses_a_controller_that_answers_garbage) {
    FileDescriptor fake(socket(AF_UNIX, SOCK_SEQPACKET | SOCK_CLOEXEC, 0));
    sockaddr_un address{};
    address.sun_family = AF_UNIX;
    std::strcpy(address.sun_path, session_socket_path("t").c_str());
    ASSERT_EQ(bind(fake.get(), reinterpret_cast<sockaddr*>(&address), sizeof address), 0);
    ASSERT_EQ(listen(fake.get(), 4), 0);
    LinkClient client("t", gui_.fd());
    client.poll();
    FileDescriptor s(accept(fake.get(), nullptr, nullptr));
    EXPECT_EQ(send(s.get(), "welcome", 7, 0), 7);
    EXPECT_FALSE(client.poll().arrived);
    EXPECT_NE(client.status_text().find("invalid"), std::string::npos) << client.status_text();
    EXPECT_FALSE(client.attached());
}

TEST_F(Link, folder_writable_by_others_is_refused_by_both_sides) {
    ASSERT_EQ(chmod(folder_.c_str(), 0777), 0);
    EXPECT_THROW(LinkServer("t", rt_.fd()), StartupError);
    LinkClient client("t", -1);
    client.poll();
    EXPECT_NE(client.status_text().find("other users may write"), std::string::npos) << client.status_text();
    ASSERT_EQ(chmod(folder_.c_str(), 0700), 0);

    const std::string link = folder_ + "/link";
    ASSERT_EQ(symlink(folder_.c_str(), link.c_str()), 0);
    setenv("TACT_RUNTIME_DIR", link.c_str(), 1);
    EXPECT_THROW(LinkServer("t", rt_.fd()), StartupError);
}

TEST_F(Link, session_names_are_names_and_not_paths) {
    for (const char* const bad : {"", ".", "..", "a/b", "../x", "a b", "\xC3\xA4", ".hidden"}) {
        EXPECT_THROW((void)session_socket_path(bad), StartupError) << bad;
    }
    EXPECT_THROW((void)session_socket_path(std::string(200, 'a')), StartupError);
    EXPECT_EQ(session_socket_path("lab-2"), folder_ + "/tact-lab-2.sock");
    setenv("TACT_RUNTIME_DIR", ("/tmp/" + std::string(120, 'd')).c_str(), 1);
    EXPECT_THROW((void)session_socket_path("t"), StartupError);
}

}  // namespace
}  // namespace tact::ipc_link_test
