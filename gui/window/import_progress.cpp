#include "gui/window/import_progress.hpp"

#include <algorithm>
#include <charconv>
#include <system_error>

namespace tact {

std::string last_line(const std::string& said) {
    const std::size_t end = said.find_last_not_of("\r\n");
    if (end == std::string::npos) return {};
    const std::size_t before = said.find_last_of("\r\n", end);
    const std::size_t from = before == std::string::npos ? 0 : before + 1;
    return said.substr(from, end - from + 1);
}

std::optional<double> share_done(const std::string& said) {
    for (std::size_t at = said.rfind('['); at != std::string::npos;
         at = at > 0 ? said.rfind('[', at - 1) : said.npos) {
        const std::size_t first = said.find_first_not_of(' ', at + 1);
        const bool begins = at == 0 || said[at - 1] == '\n';
        if (!begins || first == said.npos) continue;
        unsigned percent = 0;
        const auto [behind, error] = std::from_chars(said.data() + first, said.data() + said.size(), percent);
        const auto rest = static_cast<std::size_t>(behind - said.data());
        if (error == std::errc{} && percent <= 100 && said.compare(rest, 3, " %]") == 0)
            return 0.01 * percent;
    }
    return std::nullopt;
}

std::string errors_said(const std::string& said) {
    const std::size_t at = std::min(said.find("tact-prep: "), said.find("tact: "));
    const std::string words = at == std::string::npos ? said : said.substr(at);
    return words.empty() ? "The import ended without a word."
                         : words.substr(0, words.find_last_not_of('\n') + 1);
}

}  // namespace tact
