#include "gui/base/output_folder.hpp"

#include <cstdlib>
#include <ctime>

#include "ipc/base/error.hpp"

namespace tact {

std::filesystem::path output_folder() {
    const auto absolute = [](const char* name) -> std::filesystem::path {
        const char* const value = std::getenv(name);
        return value != nullptr && value[0] == '/' ? value : "";
    };
    if (auto given = absolute("TACT_OUTPUT"); !given.empty()) return given;
    if (const auto home = absolute("HOME"); !home.empty()) return home / "Tact";
    std::error_code ignored;
    return std::filesystem::current_path(ignored);
}

std::filesystem::path new_output(const std::string& what, const std::string& extension) {
    const std::filesystem::path folder = output_folder();
    std::error_code error;
    std::filesystem::create_directories(folder, error);
    if (!std::filesystem::is_directory(folder))
        throw StartupError("creating the folder " + folder.string(),
                           error ? error.message() : "a file has this name",
                           "set TACT_OUTPUT to a writable folder");
    const std::time_t now = std::time(nullptr);
    std::tm parts{};
    ::localtime_r(&now, &parts);
    char stamp[32];
    std::strftime(stamp, sizeof stamp, "%Y-%m-%d_%H%M%S_", &parts);
    for (int i = 1;; ++i) {
        std::string name = stamp + what;
        if (i > 1) name += "-" + std::to_string(i);
        if (std::filesystem::path path = folder / (name + extension); !std::filesystem::exists(path))
            return path;
    }
}

}  // namespace tact
