// A private X server without a screen, for runs with --headless.
//
// Why Xvfb and not EGL   GLFW 3.3 (Debian 12) opens windows only on X. The same program with the same window code then
//                        runs with and without a screen, and Mesa renders in software if there is no graphics card.
// Private                its display number is random, it does not listen on the network, and it admits only clients
//                        with its cookie, which is in a file readable by this user. A server that does not start is
//                        tried again.
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
    // scratch: an existing folder with access for this user only. Throws StartupError: not installed, did not start.
    XServer(const std::filesystem::path& scratch, int width, int height);
    // size: as given with --size, "1280x800". Also throws if it is not within 64..16384.
    XServer(const std::filesystem::path& scratch, const std::string& size);
    [[nodiscard]] const std::string& display() const { return display_; }  // ":1"
    // Environment variables for its clients.
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
