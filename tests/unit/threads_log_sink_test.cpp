// A log without a reader blocks no thread, and later reports the number of lost lines.
#include <fcntl.h>
#include <gtest/gtest.h>
#include <spdlog/logger.h>
#include <sys/socket.h>
#include <unistd.h>

#include <string>

#include "rt/threads/log_sink.hpp"

namespace tact::threads_log_sink_test {
namespace {

struct Ends {
    int read = -1, write = -1;
    Ends() = default;
    Ends(const Ends&) = delete;
    Ends& operator=(const Ends&) = delete;
    ~Ends() {
        close(read);
        close(write);
    }
    // All available bytes.
    [[nodiscard]] std::string drain() const {
        std::string all;
        std::array<char, 65536> part{};
        fcntl(read, F_SETFL, O_NONBLOCK);
        for (ssize_t n = 0; (n = ::read(read, part.data(), part.size())) > 0;)
            all.append(part.data(), static_cast<std::size_t>(n));
        return all;
    }
};

struct Pipe : Ends {
    Pipe() {
        std::array<int, 2> ends{-1, -1};
        EXPECT_EQ(pipe(ends.data()), 0);
        read = ends[0];
        write = ends[1];
    }
};

struct Socket : Ends {
    Socket() {
        std::array<int, 2> ends{-1, -1};
        EXPECT_EQ(socketpair(AF_UNIX, SOCK_STREAM, 0, ends.data()), 0);
        read = ends[0];
        write = ends[1];
    }
};

std::size_t count(const std::string& text, const std::string& what) {
    std::size_t n = 0;
    for (std::size_t at = text.find(what); at != std::string::npos; at = text.find(what, at + 1)) ++n;
    return n;
}

template <class E>
class LogSink : public testing::Test {};
using Kinds = testing::Types<Pipe, Socket>;
TYPED_TEST_SUITE(LogSink, Kinds);

TYPED_TEST(LogSink, drops_lines_that_do_not_fit_and_reports_their_number_later) {
    const TypeParam ends;
    spdlog::logger log("test", make_log_sink(ends.write));
    log.set_pattern("%l %v");
    constexpr std::size_t kLines = 20000;  // more than any pipe or socket holds
    for (std::size_t i = 0; i < kLines; ++i) log.info("line {} of a log that nobody reads", i);
    const std::string first = ends.drain();
    const std::size_t there = count(first, "info line ");
    ASSERT_GT(there, 100U);
    ASSERT_LT(there, kLines);
    EXPECT_EQ(first.rfind("info line 0 of", 0), 0U);

    log.flush();
    const std::string said = "warning " + std::to_string(kLines - there) +
                             " log lines were dropped because standard error was not read\n";
    EXPECT_NE(ends.drain().find(said), std::string::npos);
    log.flush();
    EXPECT_EQ(ends.drain(), "");  // reported once
    log.info("on");
    EXPECT_EQ(ends.drain(), "info on\n");

    for (std::size_t i = 0; i < kLines; ++i) log.info("again {}", i);
    static_cast<void>(ends.drain());
    log.info("with the next line");
    const std::string next = ends.drain();
    EXPECT_NE(next.find("log lines were dropped"), std::string::npos);
    EXPECT_LT(next.find("dropped"), next.find("info with the next line\n"));
}

TEST(LogSinks, leave_a_shared_descriptor_blocking) {
    const Pipe ends;
    spdlog::logger log("test", make_log_sink(ends.write));
    log.info("a line");
    EXPECT_EQ(fcntl(ends.write, F_GETFL) & O_NONBLOCK, 0);
}

TEST(LogSinks, accept_a_line_longer_than_a_pipe) {
    const Pipe ends;
    spdlog::logger log("test", make_log_sink(ends.write));
    log.set_pattern("%v");
    log.info(std::string(1000000, 'x'));
    log.info("lost as well");
    static_cast<void>(ends.drain());
    log.info("next");
    EXPECT_EQ(ends.drain(), "\n2 log lines were dropped because standard error was not read\nnext\n");
}

}  // namespace
}  // namespace tact::threads_log_sink_test
