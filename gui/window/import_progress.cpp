#include "gui/window/import_progress.hpp"

#include <algorithm>
#include <charconv>
#include <system_error>

namespace tact {

std::string last_line(const std::string& output) {
    const std::size_t end = output.find_last_not_of("\r\n");
    if (end == std::string::npos) return {};
    const std::size_t before = output.find_last_of("\r\n", end);
    const std::size_t from = before == std::string::npos ? 0 : before + 1;
    return output.substr(from, end - from + 1);
}

std::optional<double> share_done(const std::string& output) {
    for (std::size_t at = output.rfind('['); at != std::string::npos;
         at = at > 0 ? output.rfind('[', at - 1) : output.npos) {
        const std::size_t first = output.find_first_not_of(' ', at + 1);
        const bool begins = at == 0 || output[at - 1] == '\n';
        if (!begins || first == output.npos) continue;
        unsigned percent = 0;
        const auto [behind, error] =
            std::from_chars(output.data() + first, output.data() + output.size(), percent);
        const auto rest = static_cast<std::size_t>(behind - output.data());
        if (error == std::errc{} && percent <= 100 && output.compare(rest, 3, " %]") == 0)
            return 0.01 * percent;
    }
    return std::nullopt;
}

std::string error_text(const std::string& output) {
    const std::size_t at = std::min(output.find("tact-prep: "), output.find("tact: "));
    const std::string words = at == std::string::npos ? output : output.substr(at);
    return words.empty() ? "The import failed without a message."
                         : words.substr(0, words.find_last_not_of('\n') + 1);
}

}  // namespace tact
