// Notifications to the service manager, read from a datagram socket in its place.
#include "rt/threads/service_notify.hpp"

#include <gtest/gtest.h>
#include <spdlog/details/log_msg.h>
#include <sys/socket.h>
#include <sys/stat.h>
#include <sys/un.h>
#include <unistd.h>

#include <array>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <string>

#include "rt/threads/journal_format.hpp"

namespace tact::threads_service_notify_test {
namespace {

using namespace std::chrono_literals;

class Manager {
public:
    Manager() {
        std::string name = (std::filesystem::temp_directory_path() / "notify-XXXXXX").string();
        folder_ = mkdtemp(name.data());
        const std::string path = folder_ + "/notify";
        fd_ = socket(AF_UNIX, SOCK_DGRAM | SOCK_NONBLOCK | SOCK_CLOEXEC, 0);
        sockaddr_un address{};
        address.sun_family = AF_UNIX;
        std::strncpy(address.sun_path, path.c_str(), sizeof address.sun_path - 1);
        EXPECT_EQ(bind(fd_, reinterpret_cast<const sockaddr*>(&address), sizeof address), 0);
        setenv("NOTIFY_SOCKET", path.c_str(), 1);
        setenv("WATCHDOG_USEC", "2000000", 1);
        setenv("WATCHDOG_PID", std::to_string(getpid()).c_str(), 1);
    }
    ~Manager() {
        for (const char* const name : {"NOTIFY_SOCKET", "WATCHDOG_USEC", "WATCHDOG_PID"}) unsetenv(name);
        close(fd_);
        std::filesystem::remove_all(folder_);
    }
    Manager(const Manager&) = delete;
    Manager& operator=(const Manager&) = delete;

    // All data since the last call.
    std::string received() const {
        std::string all;
        std::array<char, 512> text{};
        for (ssize_t n = 0; (n = recv(fd_, text.data(), text.size(), 0)) > 0;)
            all.append(text.data(), static_cast<std::size_t>(n));
        return all;
    }

private:
    std::string folder_;
    int fd_ = -1;
};

int count(const std::string& text, const std::string& what) {
    int n = 0;
    for (auto at = text.find(what); at != std::string::npos; at = text.find(what, at + 1)) ++n;
    return n;
}

const Instant kBegin = instant_from_ns(1'000'000'000);

TEST(WatchdogFeed, feeds_four_times_per_limit_while_the_heartbeat_advances) {
    WatchdogFeed feed(2s);
    int fed = 0;
    for (int ms = 0; ms < 10000; ms += 100) fed += feed.due(ms, kBegin + ms * 1ms) ? 1 : 0;
    EXPECT_EQ(fed, 20);
}

TEST(WatchdogFeed, stops_feeding_while_the_servo_is_stopped_and_resumes_when_it_runs) {
    WatchdogFeed feed(2s);
    static_cast<void>(feed.due(1, kBegin));
    EXPECT_TRUE(feed.due(2, kBegin + 1s));
    for (int s = 2; s < 100; ++s) EXPECT_FALSE(feed.due(2, kBegin + s * 1s)) << s;
    EXPECT_TRUE(feed.due(3, kBegin + 100s));
}

TEST(WatchdogFeed, one_heartbeat_alone_is_no_proof_of_a_running_servo) {
    WatchdogFeed feed(2s);
    for (int s = 0; s < 10; ++s) EXPECT_FALSE(feed.due(7, kBegin + s * 1s));
}

TEST(WatchdogFeed, feeds_nothing_without_a_watchdog) {
    WatchdogFeed feed(0s);
    for (int s = 0; s < 10; ++s) EXPECT_FALSE(feed.due(s, kBegin + s * 1s));
}

TEST(ServiceNotify, is_ready_once_the_servo_runs_and_not_before) {
    const Manager manager;
    ServiceNotify service;
    for (int i = 0; i < 20; ++i)
        service.update({.heartbeat = 5, .state = "ready", .rate_hz = 0.0}, kBegin + i * 100ms);
    EXPECT_EQ(manager.received(), "");
    service.update({.heartbeat = 6, .state = "ready", .rate_hz = 1000.2}, kBegin + 3s);
    const std::string text = manager.received();
    EXPECT_NE(text.find("READY=1\n"), std::string::npos) << text;
    EXPECT_NE(text.find("STATUS=ready, 1000 Hz\n"), std::string::npos) << text;
    for (int i = 0; i < 100; ++i)
        service.update({.heartbeat = 7 + i, .state = "ready", .rate_hz = 1000.0}, kBegin + 4s + i * 100ms);
    EXPECT_EQ(count(manager.received(), "READY=1"), 0);  // once
}

TEST(ServiceNotify, feeds_the_watchdog_only_while_the_servo_runs) {
    const Manager manager;
    ServiceNotify service;
    std::string text;
    for (int i = 0; i < 100; ++i) {
        service.update({.heartbeat = i, .state = "active", .rate_hz = 1000.0}, kBegin + i * 100ms);
        text += manager.received();
    }
    EXPECT_EQ(count(text, "WATCHDOG=1"), 20);
    for (int i = 100; i < 200; ++i)
        service.update({.heartbeat = 99, .state = "active", .rate_hz = 1000.0}, kBegin + i * 100ms);
    EXPECT_LE(count(manager.received(), "WATCHDOG=1"), 1);  // for the cycles before the servo stopped
}

TEST(ServiceNotify, reports_a_changed_state_within_a_second_and_its_end_once) {
    const Manager manager;
    ServiceNotify service;
    for (int i = 0; i < 3; ++i)
        service.update({.heartbeat = i, .state = "ready", .rate_hz = 1000.0}, kBegin + i * 100ms);
    static_cast<void>(manager.received());
    for (int i = 3; i < 15; ++i)
        service.update({.heartbeat = i, .state = "active", .rate_hz = 999.6}, kBegin + i * 100ms);
    EXPECT_EQ(count(manager.received(), "STATUS=active, 1000 Hz\n"), 1);
    service.stopping();
    service.stopping();
    EXPECT_EQ(count(manager.received(), "STOPPING=1"), 1);
}

TEST(ServiceNotify, does_not_wait_for_a_manager_that_does_not_read) {
    const Manager manager;
    ServiceNotify service;
    for (int i = 0; i < 10000; ++i)
        service.update({.heartbeat = i, .state = "active", .rate_hz = 1.0 * i}, kBegin + i * 1s);
    EXPECT_GE(count(manager.received(), "WATCHDOG=1"), 5);  // as many as the socket buffer holds
    service.update({.heartbeat = -1, .state = "active", .rate_hz = 1000.0}, kBegin + 20000s);
    EXPECT_EQ(count(manager.received(), "WATCHDOG=1"), 1);
}

TEST(ServiceNotify, does_nothing_without_a_service_manager) {
    ServiceNotify service;
    service.update({.heartbeat = 1, .state = "ready", .rate_hz = 1000.0}, kBegin);
    service.update({.heartbeat = 2, .state = "ready", .rate_hz = 1000.0}, kBegin + 1s);
    service.stopping();
}

std::string formatted(spdlog::level::level_enum level, const char* text) {
    spdlog::memory_buf_t into;
    make_journal_formatter()->format(spdlog::details::log_msg("tact-rt", level, text), into);
    return {into.data(), into.size()};
}

TEST(JournalFormat, puts_the_level_before_each_line_without_time) {
    EXPECT_EQ(formatted(spdlog::level::warn, "late\n  fix: a shorter period"),
              "<4>late\n<4>  fix: a shorter period\n");
    EXPECT_EQ(formatted(spdlog::level::info, "ready"), "<6>ready\n");
    EXPECT_EQ(formatted(spdlog::level::err, ""), "<3>\n");
    EXPECT_EQ(formatted(spdlog::level::debug, "x"), "<7>x\n");
}

TEST(JournalFormat, is_used_only_for_the_stream_of_the_journal) {
    int ends[2];
    ASSERT_EQ(pipe(ends), 0);
    struct stat what {};
    ASSERT_EQ(fstat(ends[1], &what), 0);
    unsetenv("JOURNAL_STREAM");
    EXPECT_FALSE(is_journal_stream(ends[1]));
    setenv("JOURNAL_STREAM", (std::to_string(what.st_dev) + ":" + std::to_string(what.st_ino)).c_str(), 1);
    EXPECT_TRUE(is_journal_stream(ends[1]));
    EXPECT_FALSE(is_journal_stream(STDIN_FILENO));  // standard input is a different stream
    unsetenv("JOURNAL_STREAM");
    close(ends[0]);
    close(ends[1]);
}

}  // namespace
}  // namespace tact::threads_service_notify_test
