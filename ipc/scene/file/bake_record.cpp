#include "ipc/scene/file/bake_record.hpp"

#include <zlib.h>

#include <algorithm>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <memory>
#include <sstream>
#include <string_view>
#include <utility>

#include "ipc/base/error.hpp"
#include "ipc/base/printable.hpp"

namespace tact {
namespace {

namespace fs = std::filesystem;
constexpr const char kInputLine[] = "input: ", kOptionsLine[] = "bake options: ";

bool is_option_word(const std::string& word) {
    const bool name = word.starts_with("--") && word.size() > 2;
    const auto inside = [&](const char* set, std::size_t from) {
        return word.find_first_not_of(set, from) == std::string::npos;
    };
    return name ? inside("abcdefghijklmnopqrstuvwxyz0123456789-", 2) : inside("0123456789.+-e", 0);
}

// "312255 bytes, crc32 1a2b3c4d"
bool is_mark(const std::string& text) {
    constexpr std::string_view kMiddle = " bytes, crc32 ";
    const auto digits = text.find_first_not_of("0123456789");
    return digits != std::string::npos && digits > 0 && digits <= 20 &&
           text.compare(digits, kMiddle.size(), kMiddle) == 0 && text.size() == digits + kMiddle.size() + 8 &&
           text.find_first_not_of("0123456789abcdef", digits + kMiddle.size()) == std::string::npos;
}

// "map, 312255 bytes, crc32 1a2b3c4d, /data/emd.mrc"; the path may hold commas.
std::optional<BakeInput> read_input(const std::string& text) {
    const auto role_end = text.find(", ");
    if (role_end == std::string::npos || role_end == 0) return std::nullopt;
    const auto path_at = text.find(", /", role_end);
    if (path_at == std::string::npos || path_at < role_end + 2) return std::nullopt;
    BakeInput input{text.substr(0, role_end), text.substr(role_end + 2, path_at - role_end - 2),
                    text.substr(path_at + 2)};
    if (!is_mark(input.mark) || input.path.native().size() > 4096) return std::nullopt;
    return input;
}

}  // namespace

std::string file_mark(const std::filesystem::path& path) {
    std::FILE* const opened = std::fopen(path.c_str(), "rb");
    if (opened == nullptr)
        throw StartupError("read " + path.string(), std::strerror(errno),
                           "check the path and its permissions");
    const std::unique_ptr<std::FILE, int (*)(std::FILE*)> file(opened, &std::fclose);
    std::vector<unsigned char> part(std::size_t{1} << 18);
    uLong sum = ::crc32(0, nullptr, 0);
    std::uint64_t bytes = 0;
    while (const std::size_t got = std::fread(part.data(), 1, part.size(), file.get())) {
        sum = ::crc32(sum, part.data(), static_cast<uInt>(got));
        bytes += got;
    }
    if (std::ferror(file.get()) != 0)
        throw StartupError("read " + path.string(), std::strerror(errno), "check the disk for errors");
    char text[64];
    std::snprintf(text, sizeof text, "%llu bytes, crc32 %08lx", static_cast<unsigned long long>(bytes), sum);
    return text;
}

BakeInput bake_input(const std::string& role, const fs::path& path) {
    return {role, file_mark(path), printable(fs::absolute(path).lexically_normal().string())};
}

std::vector<std::string> BakeRecord::paths(const std::string& role) const {
    std::vector<std::string> found;
    for (const BakeInput& input : inputs)
        if (input.role == role) found.push_back(input.path.string());
    return found;
}

std::vector<std::string> note_lines(const BakeRecord& record) {
    std::vector<std::string> lines;
    for (const BakeInput& input : record.inputs)
        lines.push_back(kInputLine + input.role + ", " + input.mark + ", " + input.path.string());
    std::string options = kOptionsLine;
    for (std::size_t i = 0; i < record.options.size(); ++i) options += (i > 0 ? " " : "") + record.options[i];
    lines.push_back(options);
    return lines;
}

std::optional<BakeRecord> read_bake_record(const std::string& note) {
    BakeRecord record;
    bool options = false;
    std::istringstream lines(note);
    for (std::string line; std::getline(lines, line);) {
        if (line.starts_with(kInputLine)) {
            auto input = read_input(line.substr(sizeof kInputLine - 1));
            if (!input || record.inputs.size() == BakeRecord::kInputsMost) return std::nullopt;
            record.inputs.push_back(std::move(*input));
        } else if (line.starts_with(kOptionsLine)) {
            if (std::exchange(options, true)) return std::nullopt;
            std::istringstream words(line.substr(sizeof kOptionsLine - 1));
            for (std::string word; words >> word;) {
                if (!is_option_word(word) || record.options.size() == BakeRecord::kOptionsMost)
                    return std::nullopt;
                record.options.push_back(word);
            }
        }
    }
    if (record.inputs.empty() || !options) return std::nullopt;
    return record;
}

void check_unchanged(const BakeRecord& record, const std::string& attempt) {
    for (const BakeInput& input : record.inputs) {
        std::error_code unknown;
        if (!fs::is_regular_file(input.path, unknown))
            throw StartupError(
                attempt, "its " + input.role + ", the file " + input.path.string() + ", is no longer there",
                "put the file back, or bake the scene again from the present path of its files");
        if (const std::string now = file_mark(input.path); now != input.mark)
            throw StartupError(attempt,
                               "its " + input.role + ", the file " + input.path.string() +
                                   ", has changed since the scene was baked: it had " + input.mark +
                                   ", and has " + now,
                               "restore the file, or bake the scene again from its present files");
    }
}

bool extends(const BakeRecord& whole, const BakeRecord& part) {
    auto next = whole.inputs.begin();
    for (const BakeInput& input : part.inputs) {
        next = std::find(next, whole.inputs.end(), input);
        if (next == whole.inputs.end()) return false;
        ++next;
    }
    return whole.options == part.options;
}

}  // namespace tact
