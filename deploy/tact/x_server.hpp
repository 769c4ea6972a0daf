// An X server of our own, without a screen, for runs with --headless.
//
// Why Xvfb and not EGL   GLFW 3.3 (Debian 12) opens windows on X alone; the same program with the same window
//                        code then runs with and without a screen, and Mesa draws in software where there is
//                        no graphics card.
// Private                its display number is drawn at random, it listens on no network and lets in only
//                        those who know its cookie, which lies in a file readable by this user. What does not
//                        start is tried again.
// Life                   ended by stop() or the destructor; if tact is killed, the kernel ends it.
#pragma once

#include <array>
#include <filesystem>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "deploy/tact/child.hpp"

namespace tact::launch {

class XServer {
public:
    // scratch: an existing folder of this user alone. Throws StartupError: not installed, did not start.
    XServer(const std::filesystem::path& scratch, int width, int height);
    // size: as typed behind --size, "1280x800". Throws as well where it is none in 64..16384.
    XServer(const std::filesystem::path& scratch, const std::string& size);
    [[nodiscard]] const std::string& display() const { return display_; }  // ":1"
    // What a program needs to use it.
    [[nodiscard]] std::vector<std::pair<std::string, std::string>> environment() const;
    Child& child() { return *child_; }

private:
    XServer(const std::filesystem::path& scratch, std::array<int, 2> size)
        : XServer(scratch, size[0], size[1]) {}

    std::filesystem::path cookie_file_;
    std::string display_;
    std::optional<Child> child_;
};

}  // namespace tact::launch
