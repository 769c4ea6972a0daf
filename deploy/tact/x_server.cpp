#include "deploy/tact/x_server.hpp"

#include <fcntl.h>
#include <poll.h>
#include <sys/random.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <charconv>
#include <cstring>
#include <fstream>

#include "ipc/base/error.hpp"
#include "ipc/base/whole_numbers.hpp"

namespace tact::launch {
namespace {

// A start takes 0.2 s. With a load of nine it once hung, so it is tried again.
constexpr std::array kStartLimits{std::chrono::seconds(10), std::chrono::seconds(20),
                                  std::chrono::seconds(40)};
// Display numbers are random: counting from 0 would collide with servers of other containers that share the network
// namespace.
constexpr unsigned kDisplayFirst = 100, kDisplays = 20000;

std::array<int, 2> typed_size(const std::string& size) {
    const auto px = numbers_between(size, "x");
    if (!px || std::min((*px)[0], (*px)[1]) < 64 || std::max((*px)[0], (*px)[1]) > 16384)
        throw StartupError("reading --size " + size,
                           "the size is not WIDTHxHEIGHT with numbers from 64 to 16384",
                           "give a size such as --size 1280x800");
    return {static_cast<int>((*px)[0]), static_cast<int>((*px)[1])};
}

unsigned random_display() {
    unsigned number = 0;
    if (getrandom(&number, sizeof number, 0) != static_cast<ssize_t>(sizeof number))
        number = static_cast<unsigned>(getpid());
    return kDisplayFirst + number % kDisplays;
}

// The format of Xauthority files: big-endian lengths; family 65535 matches any address, an empty number any display.
void write_cookie(const std::filesystem::path& path) {
    std::array<unsigned char, 16> cookie{};
    if (getrandom(cookie.data(), cookie.size(), 0) != static_cast<ssize_t>(cookie.size()))
        throw StartupError("making a key for the X server", std::strerror(errno), "try again");
    std::string text;
    const auto field = [&text](std::string_view s) {
        text += static_cast<char>(s.size() >> 8);
        text += static_cast<char>(s.size() & 0xFFU);
        text += s;
    };
    text += "\xFF\xFF";
    field("");
    field("");
    field("MIT-MAGIC-COOKIE-1");
    field({reinterpret_cast<const char*>(cookie.data()), cookie.size()});
    const int fd = open(path.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0600);
    const bool ok = fd >= 0 && write(fd, text.data(), text.size()) == static_cast<ssize_t>(text.size());
    const int why = errno;
    if (fd >= 0) close(fd);
    if (!ok)
        throw StartupError("writing " + path.string(), std::strerror(why),
                           "free some space or fix the permissions");
}

// True once the server has written its display number, which it does when it listens.
bool listens(int fd, Child& server, Duration limit) {
    const Instant end = Monotonic::now() + limit;
    while (Monotonic::now() < end && !server.poll()) {
        pollfd p{.fd = fd, .events = POLLIN, .revents = 0};
        char letter = 0;
        if (::poll(&p, 1, 100) != 1) continue;
        if (read(fd, &letter, 1) != 1) return false;
        if (letter == '\n') return true;  // not earlier: closing the pipe too early ends the server
    }
    return false;
}

std::string last_line(const std::filesystem::path& log) {
    std::string said;
    std::ifstream in(log);
    for (std::string line; std::getline(in, line);) said = line.empty() ? said : line;
    return said;
}

}  // namespace

XServer::XServer(const std::filesystem::path& scratch, const std::string& size)
    : XServer(scratch, typed_size(size)) {}

XServer::XServer(const std::filesystem::path& scratch, int width, int height)
    : cookie_file_(scratch / "xauthority") {
    const auto program = find_in_path("Xvfb");
    if (program.empty())
        throw StartupError("starting an X server for --headless", "the program Xvfb is not installed",
                           "sudo apt-get install xvfb, or run with --no-gui");
    write_cookie(cookie_file_);
    const auto log = scratch / "xvfb.log";
    std::string why;
    for (const auto limit : kStartLimits) {
        display_ = ":" + std::to_string(random_display());
        std::array<int, 2> number{};
        const int log_fd = open(log.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0600);
        if (log_fd < 0 || pipe2(number.data(), O_CLOEXEC) != 0)
            throw StartupError("starting Xvfb", std::strerror(errno),
                               "free disk space, or fix the permissions of " + scratch.string());
        ChildSettings settings;
        settings.arguments = {display_,
                              "-displayfd",
                              std::to_string(number[1]),
                              "-screen",
                              "0",
                              std::to_string(width) + "x" + std::to_string(height) + "x24",
                              "-nolisten",
                              "tcp",
                              "-auth",
                              cookie_file_.string(),
                              "-noreset",
                              "+extension",
                              "GLX"};
        settings.output_fd = log_fd;
        settings.keep_fd = number[1];
        settings.grace = std::chrono::seconds(10);
        child_.emplace("Xvfb", program, settings);
        close(log_fd);
        close(number[1]);
        const bool good = listens(number[0], *child_, limit);
        close(number[0]);
        if (good) return;
        const auto& ending = child_->wait(std::chrono::milliseconds(200));
        const std::string said = last_line(log);
        why = (ending ? "Xvfb " + ending->text() : "Xvfb did not listen in time") +
              (said.empty() ? "" : ": " + said);
        child_.reset();  // kills a server that hangs
    }
    throw StartupError("starting Xvfb for --headless", why,
                       "run 'Xvfb " + display_ + "' to find the cause, or omit --headless and use a display");
}

std::vector<std::pair<std::string, std::string>> XServer::environment() const {
    return {{"DISPLAY", display_}, {"XAUTHORITY", cookie_file_.string()}, {"WAYLAND_DISPLAY", ""}};
}

}  // namespace tact::launch
