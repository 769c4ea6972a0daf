#include "rt/threads/journal_format.hpp"

#include <sys/stat.h>

#include <cstdlib>
#include <string>
#include <string_view>

namespace tact {
namespace {

std::string_view level_prefix(spdlog::level::level_enum level) {
    switch (level) {
        case spdlog::level::critical:
            return "<2>";
        case spdlog::level::err:
            return "<3>";
        case spdlog::level::warn:
            return "<4>";
        case spdlog::level::info:
            return "<6>";
        default:
            return "<7>";
    }
}

class JournalFormatter final : public spdlog::formatter {
public:
    void format(const spdlog::details::log_msg& message, spdlog::memory_buf_t& into) override {
        const std::string_view prefix = level_prefix(message.level);
        std::string_view rest(message.payload.data(), message.payload.size());
        for (bool more = true; more;) {
            const auto end = rest.find('\n');
            more = end != std::string_view::npos;
            const std::string_view line = rest.substr(0, end);
            into.append(prefix.data(), prefix.data() + prefix.size());
            into.append(line.data(), line.data() + line.size());
            into.push_back('\n');
            if (more) rest.remove_prefix(end + 1);
        }
    }
    [[nodiscard]] std::unique_ptr<spdlog::formatter> clone() const override {
        return std::make_unique<JournalFormatter>();
    }
};

}  // namespace

bool is_journal_stream(int fd) {
    const char* const stream = std::getenv("JOURNAL_STREAM");  // "device:inode"
    struct stat what {};
    if (stream == nullptr || fstat(fd, &what) != 0) return false;
    return std::to_string(what.st_dev) + ":" + std::to_string(what.st_ino) == stream;
}

std::unique_ptr<spdlog::formatter> make_journal_formatter() { return std::make_unique<JournalFormatter>(); }

}  // namespace tact
