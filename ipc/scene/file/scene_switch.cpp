#include "ipc/scene/file/scene_switch.hpp"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <charconv>

#include "ipc/base/error.hpp"
#include "ipc/base/whole_file.hpp"

namespace tact {
namespace {

constexpr const char* kAsked = "open";
constexpr const char* kDemo = "demo";
constexpr const char* kPast = "past";
constexpr std::size_t kPastTextMost = 32;
constexpr const char* kRefused = "refused";

// Reads and removes a small file; nothing: it does not exist. A file of more than `most` bytes, or not a
// regular file, gives an empty text.
std::optional<std::string> take_small(const std::filesystem::path& path, std::size_t most) {
    const int fd = ::open(path.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK | O_NOFOLLOW);
    if (fd < 0 && errno == ENOENT) return std::nullopt;
    std::string text;
    struct stat info {};
    if (fd >= 0 && ::fstat(fd, &info) == 0 && S_ISREG(info.st_mode) && info.st_size > 0 &&
        static_cast<std::size_t>(info.st_size) <= most) {
        text.resize(static_cast<std::size_t>(info.st_size));
        const ssize_t got = ::pread(fd, text.data(), text.size(), 0);
        text.resize(got > 0 ? static_cast<std::size_t>(got) : 0);
    }
    if (fd >= 0) ::close(fd);
    std::error_code ignored;
    std::filesystem::remove_all(path, ignored);
    return text;
}

bool control(char c) { return static_cast<unsigned char>(c) < 0x20 || c == 0x7F; }

}  // namespace

void ask_for_scene(const std::filesystem::path& folder, const std::filesystem::path& scene) {
    write_whole_file(folder / kAsked, std::filesystem::absolute(scene).lexically_normal().string() + "\n");
}

std::optional<std::filesystem::path> take_asked_scene(const std::filesystem::path& folder) {
    const auto text = take_small(folder / kAsked, kAskedPathMost);
    if (!text) return std::nullopt;
    const auto refuse = [](const std::string& why) {
        throw StartupError("opening another scene", why, "choose the scene again, or use tact run FILE");
    };
    if (text->empty()) refuse("the request contains no path, or a path that is too long");
    const std::string path = text->substr(0, text->size() - 1);
    if (text->back() != '\n' || std::any_of(path.begin(), path.end(), control))
        refuse("the requested path is not a single line of text");
    if (path.empty() || path.front() != '/') refuse("the requested path is not absolute");
    return path;
}

void ask_for_demo(const std::filesystem::path& folder, const std::string& name) {
    write_whole_file(folder / kDemo, name + "\n");
}

std::optional<std::string> take_asked_demo(const std::filesystem::path& folder) {
    auto text = take_small(folder / kDemo, kDemoNameMost + 1);
    if (!text) return std::nullopt;
    const bool line = !text->empty() && text->back() == '\n';
    if (line) text->pop_back();
    if (!line || text->empty() ||
        !std::all_of(text->begin(), text->end(), [](char c) { return c >= 'a' && c <= 'z'; }))
        throw StartupError("starting a demo", "the request contains no name of lower-case letters",
                           "choose the demo again, or use tact demo");
    return text;
}

void ask_for_past(const std::filesystem::path& folder, double ago_s) {
    char text[kPastTextMost];
    std::snprintf(text, sizeof text, "%.3f\n", ago_s);
    write_whole_file(folder / kPast, text);
}

std::optional<double> take_asked_past(const std::filesystem::path& folder) {
    const auto text = take_small(folder / kPast, kPastTextMost);
    if (!text) return std::nullopt;
    double ago_s = 0.0;
    const auto [end, error] = std::from_chars(text->data(), text->data() + text->size(), ago_s);
    if (error != std::errc() || std::string_view(end, text->data() + text->size()) != "\n" ||
        !(ago_s >= 0.0) || ago_s > kPastMostS)
        throw StartupError("looking back", "the request contains no time", "choose the moment again");
    return ago_s;
}

void refuse_scene(const std::filesystem::path& folder, const std::string& why) {
    write_whole_file(folder / kRefused, why.substr(0, kRefusalMost));
}

std::optional<std::string> take_refusal(const std::filesystem::path& folder) {
    auto text = take_small(folder / kRefused, kRefusalMost);
    if (text)
        std::replace_if(
            text->begin(), text->end(), [](char c) { return control(c) && c != '\n'; }, '?');
    return text;
}

}  // namespace tact
