// Processes killed at any instruction: the other side keeps complete values, continues, and attaches again.
#include <fcntl.h>
#include <gtest/gtest.h>
#include <poll.h>
#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <cstdlib>
#include <filesystem>
#include <functional>
#include <memory>
#include <random>
#include <string>

#include "ipc/base/parent_death.hpp"
#include "ipc/shm/latest.hpp"
#include "ipc/shm/link.hpp"
#include "ipc/shm/ring.hpp"
#include "ipc/topics/regions.hpp"
#include "tests/stress/pattern.hpp"

namespace tact::ipc_death_test {
namespace {

using Pattern = stress::Pattern<512>;  // 4 KiB: most of the time the writer is inside a copy

struct DeathRegion {
    static constexpr char kName[] = "tact.test";
    Latest<Pattern> latest;
    Ring<Pattern, 16> ring;
    struct Topic {
        static constexpr TopicInfo kInfo{.name = "pattern", .version = 1, .writer = Writer::rt};
        Pattern p;
    };
    using Topics = TopicList<Topic>;
};

// A child that runs until killed; it never returns into the tests.
class Child {
public:
    explicit Child(const std::function<void()>& work) : pid_(fork()) {
        if (pid_ == 0) {
            work();
            _exit(0);
        }
    }
    ~Child() { kill_now(); }
    Child(const Child&) = delete;
    Child& operator=(const Child&) = delete;
    void kill_now() {
        if (pid_ <= 0) return;
        kill(pid_, SIGKILL);
        waitpid(pid_, nullptr, 0);
        pid_ = 0;
    }
    [[nodiscard]] pid_t pid() const { return pid_; }

private:
    pid_t pid_;
};

TEST(Death, a_writer_killed_while_publishing_leaves_a_whole_value_and_the_next_writer_continues) {
    OwnedRegion<DeathRegion> region;
    region.mark_ready();
    std::string refusal;
    const auto reader =
        MappedRegion<DeathRegion>::map(FileDescriptor(fcntl(region.fd(), F_DUPFD_CLOEXEC, 0)), refusal);
    ASSERT_FALSE(reader.empty()) << refusal;
    std::mt19937 random(20261120);
    std::uint64_t last = 0, cut_short = 0;
    RingCursor cursor;
    for (int round = 0; round < 150; ++round) {
        const std::uint64_t before = reader->latest.count();
        Child writer([&] {
            for (std::uint64_t n = before + 1;; ++n) {
                region->ring.push(stress::pattern<512>(n));
                region->latest.publish(stress::pattern<512>(n));
            }
        });
        // The writer runs for a random time and is then killed at an arbitrary point.
        const std::uint64_t until = before + 5 + random() % 200;
        while (reader->latest.count() < until) {
        }
        writer.kill_now();
        const std::uint64_t newest = reader->latest.count();
        Pattern value{};
        ASSERT_TRUE(reader->latest.read(value)) << "round " << round;
        EXPECT_TRUE(value.whole());
        EXPECT_EQ(value.number(), newest);
        EXPECT_GT(newest, last);
        last = newest;
        cut_short += reader->ring.pushed() != newest ? 1 : 0;

        std::uint64_t taken = 0, previous = 0;
        while (reader->ring.next(cursor, value)) {
            EXPECT_TRUE(value.whole());
            EXPECT_GE(value.number(), previous);
            previous = value.number();
            ++taken;
        }
        EXPECT_GT(taken, 0U);
        EXPECT_LE(taken, 16U);
        EXPECT_EQ(cursor.next, reader->ring.pushed() + 1)
            << "the reader reaches the end for any content of the last cell";
    }
    EXPECT_GT(cut_short, 0U) << "no kill fell between push and publish; the test proves little";
}

TEST(Death, a_child_ends_with_its_parent_on_request) {
    std::array<int, 2> life{};
    ASSERT_EQ(pipe(life.data()), 0);
    Child parent([&] {
        const pid_t self = getpid();
        if (fork() == 0) {
            if (!end_with_parent(self, SIGKILL)) _exit(1);
            static_cast<void>(!write(life[1], "x", 1));
        }
        for (;;) pause();
    });
    close(life[1]);
    char said = 0;
    ASSERT_EQ(read(life[0], &said, 1), 1);
    parent.kill_now();
    EXPECT_EQ(read(life[0], &said, 1), 0);  // returns when both processes have ended
    close(life[0]);
}

TEST(Death, a_request_after_the_end_of_the_parent_fails) {
    const pid_t child = fork();
    if (child == 0) _exit(end_with_parent(getppid() + 1, SIGKILL) ? 0 : 3);
    int status = 0;
    ASSERT_EQ(waitpid(child, &status, 0), child);
    EXPECT_EQ(WEXITSTATUS(status), 3);
}

class LinkDeath : public ::testing::Test {
protected:
    void SetUp() override {
        char name[] = "/tmp/tact-death-XXXXXX";
        folder_ = mkdtemp(name);
        setenv("TACT_RUNTIME_DIR", folder_.c_str(), 1);
    }
    void TearDown() override { std::filesystem::remove_all(folder_); }
    std::string folder_;
};

TEST_F(LinkDeath, the_controller_reads_each_visual_process_that_starts_and_dies) {
    OwnedRegion<RtRegion> rt;
    rt.mark_ready();
    LinkServer server("t", rt.fd());
    std::uint64_t last_generation = 0;
    for (int round = 0; round < 20; ++round) {
        Child gui([&] {
            OwnedRegion<GuiRegion> own;
            LoadTopic load{};
            load.frame = 1000 + static_cast<std::uint64_t>(round);
            own->load.publish(load);
            own.mark_ready();
            LinkClient client("t", own.fd());
            while (true) {
                client.poll();
                ++load.taken_at_ns;
                own->load.publish(load);
            }
        });
        // On a stalled machine the previous process may appear a second time.
        LinkServer::News news;
        while (news.gui_pid != static_cast<std::uint32_t>(gui.pid())) news = server.poll(100);
        ASSERT_TRUE(news.gui_arrived);
        std::string refusal;
        const auto region = MappedRegion<GuiRegion>::map(std::move(news.gui_fd), refusal);
        ASSERT_FALSE(region.empty()) << refusal;
        EXPECT_NE(region.generation(), last_generation);
        last_generation = region.generation();
        gui.kill_now();
        bool left = false;
        while (!left) left = server.poll(100).gui_left;
        LoadTopic load{};
        ASSERT_TRUE(region->load.read(load)) << "the last value remains after its writer has ended";
        EXPECT_EQ(load.frame, 1000U + static_cast<std::uint64_t>(round));
    }
}

TEST_F(LinkDeath, the_visual_process_survives_a_killed_controller_and_attaches_to_the_next) {
    OwnedRegion<GuiRegion> gui;
    gui.mark_ready();
    LinkClient client("t", gui.fd());
    std::uint64_t last_generation = 0;
    for (int round = 0; round < 8; ++round) {
        Child controller([&] {
            OwnedRegion<RtRegion> own;
            HealthTopic health{};
            health.cycle = 500 + static_cast<std::uint64_t>(round);
            own->health.publish(health);
            own.mark_ready();
            LinkServer server("t", own.fd());  // the killed process has released its lock
            while (true) server.poll(50);
        });
        LinkClient::News news;
        while (!news.arrived) {
            news = client.poll();
            ::poll(nullptr, 0, 1);
        }
        EXPECT_EQ(news.rt_pid, static_cast<std::uint32_t>(controller.pid()));
        std::string refusal;
        const auto region = MappedRegion<RtRegion>::map(std::move(news.rt_fd), refusal);
        ASSERT_FALSE(region.empty()) << refusal;
        EXPECT_NE(region.generation(), last_generation);
        last_generation = region.generation();
        controller.kill_now();
        EXPECT_TRUE(client.poll().left);
        HealthTopic health{};
        ASSERT_TRUE(region->health.read(health));
        EXPECT_EQ(health.cycle, 500U + static_cast<std::uint64_t>(round));
    }
}

}  // namespace
}  // namespace tact::ipc_death_test
