#include "rt/threads/log_sink.hpp"

#include <fcntl.h>
#include <poll.h>
#include <spdlog/details/os.h>
#include <spdlog/sinks/base_sink.h>
#include <sys/socket.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <climits>
#include <mutex>
#include <string>
#include <string_view>

namespace tact {
namespace {

// The colours of spdlog: info green, warning yellow, error red.
std::string_view colour_of(spdlog::level::level_enum level) {
    switch (level) {
        case spdlog::level::info:
            return "\033[32m";
        case spdlog::level::warn:
            return "\033[33m\033[1m";
        case spdlog::level::err:
        case spdlog::level::critical:
            return "\033[31m\033[1m";
        default:
            return "\033[36m";
    }
}

class LogSink final : public spdlog::sinks::base_sink<std::mutex> {
public:
    explicit LogSink(int fd)
        : fd_(fd), coloured_(isatty(fd) == 1 && spdlog::details::os::is_color_terminal()) {
        struct stat what {};
        if (fstat(fd, &what) != 0) return;
        if (S_ISSOCK(what.st_mode)) way_ = Way::send;
        if (!S_ISFIFO(what.st_mode) && !S_ISCHR(what.st_mode)) return;
        const std::string path = "/proc/self/fd/" + std::to_string(fd);
        own_ = open(path.c_str(), O_WRONLY | O_NONBLOCK | O_NOCTTY | O_CLOEXEC);
        way_ = own_ >= 0 ? Way::own : Way::ask;
    }
    ~LogSink() override {
        if (own_ >= 0) close(own_);
    }
    LogSink(const LogSink&) = delete;
    LogSink& operator=(const LogSink&) = delete;

private:
    enum class Way : std::uint8_t {
        plain,  // file
        own,    // reopened as non-blocking
        send,   // socket
        ask,    // cannot be reopened: poll for room first
    };

    void sink_it_(const spdlog::details::log_msg& message) override {
        say_dropped();
        if (dropped_ > 0 || !put(message)) ++dropped_;
    }
    void flush_() override { say_dropped(); }

    void say_dropped() {
        if (dropped_ == 0) return;
        const std::string text =
            std::to_string(dropped_) + " log lines were dropped because standard error was not read";
        if (put({"tact-rt", spdlog::level::warn, text})) dropped_ = 0;
    }

    // False: not written, or only in part.
    bool put(const spdlog::details::log_msg& message) {
        spdlog::memory_buf_t line;
        formatter_->format(message, line);
        const std::string_view all(line.data(), line.size());
        std::string text(torn_ ? "\n" : "");
        if (coloured_ && message.color_range_end > message.color_range_start) {
            const std::size_t from = message.color_range_start, to = message.color_range_end;
            text.append(all.substr(0, from))
                .append(colour_of(message.level))
                .append(all.substr(from, to - from));
            text.append("\033[m").append(all.substr(to));
        } else {
            text.append(all);
        }
        std::size_t done = 0;
        while (done < text.size()) {
            const ssize_t n = write_some(text.data() + done, text.size() - done);
            if (n > 0) done += static_cast<std::size_t>(n);
            if (n < 0 && errno == EINTR) continue;
            if (n <= 0) break;
        }
        if (done > 0) torn_ = done < text.size();
        return done == text.size();
    }

    ssize_t write_some(const char* text, std::size_t size) const {
        switch (way_) {
            case Way::plain:
                return write(fd_, text, size);
            case Way::own:
                return write(own_, text, size);
            case Way::send:
                return send(fd_, text, size, MSG_DONTWAIT | MSG_NOSIGNAL);
            case Way::ask:
                break;
        }
        pollfd room{.fd = fd_, .events = POLLOUT, .revents = 0};
        if (poll(&room, 1, 0) == 1 && room.revents == POLLOUT)
            return write(fd_, text, std::min<std::size_t>(size, PIPE_BUF));  // a ready pipe accepts this much
        errno = EAGAIN;
        return -1;
    }

    const int fd_;
    const bool coloured_;
    Way way_ = Way::plain;
    int own_ = -1;
    bool torn_ = false;  // the last line was written only in part
    std::uint64_t dropped_ = 0;
};

}  // namespace

std::shared_ptr<spdlog::sinks::sink> make_log_sink(int fd) { return std::make_shared<LogSink>(fd); }

}  // namespace tact
