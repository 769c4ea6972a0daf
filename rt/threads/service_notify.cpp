#include "rt/threads/service_notify.hpp"

#include <sys/socket.h>
#include <sys/un.h>
#include <unistd.h>

#include <charconv>
#include <cmath>
#include <cstddef>
#include <cstdlib>
#include <cstring>
#include <string_view>

namespace tact {
namespace {

constexpr Duration kStatusEvery = std::chrono::seconds(1);

std::int64_t number_in(const char* variable) {
    const char* const text = std::getenv(variable);
    std::int64_t number = -1;
    if (text == nullptr) return number;
    const std::string_view all(text);
    const auto [end, error] = std::from_chars(all.data(), all.data() + all.size(), number);
    return error == std::errc{} && end == all.data() + all.size() ? number : -1;
}

// As sd_watchdog_enabled(3): ignores variables inherited from another process.
Duration watchdog_limit() {
    const std::int64_t process = number_in("WATCHDOG_PID"), us = number_in("WATCHDOG_USEC");
    if (us <= 0 || us > 86'400'000'000 || (process >= 0 && process != getpid())) return Duration{0};
    return std::chrono::microseconds(us);
}

// As sd_notify(3): a path, or with '@' an abstract socket name.
int connect_to_manager() {
    const char* const name = std::getenv("NOTIFY_SOCKET");
    sockaddr_un address{};
    address.sun_family = AF_UNIX;
    const std::size_t length = name == nullptr ? 0 : std::strlen(name);
    if (length < 2 || length >= sizeof address.sun_path || (*name != '/' && *name != '@')) return -1;
    std::memcpy(address.sun_path, name, length);
    if (*name == '@') address.sun_path[0] = 0;
    const auto size =
        static_cast<socklen_t>(offsetof(sockaddr_un, sun_path) + length + (*name == '/' ? 1 : 0));
    const int fd = socket(AF_UNIX, SOCK_DGRAM | SOCK_NONBLOCK | SOCK_CLOEXEC, 0);
    if (fd < 0 || connect(fd, reinterpret_cast<const sockaddr*>(&address), size) == 0) return fd;
    close(fd);
    return -1;
}

}  // namespace

bool WatchdogFeed::due(std::int64_t heartbeat, Instant now) noexcept {
    if (every_ <= Duration{0}) return false;
    if (!heartbeat_) {  // first call: no advance known yet
        heartbeat_ = heartbeat;
        return false;
    }
    if (heartbeat == *heartbeat_ || now - fed_at_ < every_) return false;
    heartbeat_ = heartbeat;
    fed_at_ = now;
    return true;
}

ServiceNotify::ServiceNotify() : fd_(connect_to_manager()), feed_(watchdog_limit()) {}

ServiceNotify::~ServiceNotify() {
    if (fd_ >= 0) close(fd_);
}

void ServiceNotify::update(const ServiceState& now_is, Instant now) {
    if (fd_ < 0) return;
    if (!first_heartbeat_) first_heartbeat_ = now_is.heartbeat;
    std::string lines;
    if (!ready_ && now_is.heartbeat != *first_heartbeat_) {
        ready_ = true;
        lines += "READY=1\n";
    }
    if (feed_.due(now_is.heartbeat, now)) lines += "WATCHDOG=1\n";
    if (ready_ && !stopping_ && (status_.empty() || now - status_at_ >= kStatusEvery)) {
        status_at_ = now;
        std::string status =
            std::string(now_is.state) + ", " + std::to_string(std::lround(now_is.rate_hz)) + " Hz";
        if (status != status_) lines += "STATUS=" + (status_ = std::move(status)) + "\n";
    }
    if (!lines.empty()) send(lines);
}

void ServiceNotify::stopping() {
    if (fd_ < 0 || stopping_) return;
    stopping_ = true;
    send("STOPPING=1\nSTATUS=stopping\n");
}

// Does not repeat a lost message: the service manager then acts as if the servo had stopped.
void ServiceNotify::send(const std::string& lines) const {
    static_cast<void>(::send(fd_, lines.data(), lines.size(), MSG_DONTWAIT | MSG_NOSIGNAL));
}

}  // namespace tact
