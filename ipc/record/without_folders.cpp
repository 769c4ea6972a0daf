#include "ipc/record/without_folders.hpp"

namespace tact {

std::string without_folders(std::string_view path) {
    if (path.find('/') == std::string_view::npos) return std::string(path);
    while (path.ends_with('/')) path.remove_suffix(1);
    path.remove_prefix(path.find_last_of('/') + 1);  // without '/', the whole text
    return path.empty() ? "." : std::string(path);
}

std::string arguments_without_folders(std::string_view arguments) {
    std::string kept;
    while (!arguments.empty()) {
        const std::size_t end = arguments.find('\0');
        const std::string_view word = arguments.substr(0, end);
        const std::size_t equals = word.starts_with("--") ? word.find('=') : std::string_view::npos;
        if (equals == std::string_view::npos || word.substr(0, equals).find('/') != std::string_view::npos)
            kept += without_folders(word);
        else
            kept.append(word.substr(0, equals + 1)).append(without_folders(word.substr(equals + 1)));
        if (end == std::string_view::npos) break;
        kept += '\0';
        arguments.remove_prefix(end + 1);
    }
    return kept;
}

}  // namespace tact
