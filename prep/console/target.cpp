#include "prep/console/target.hpp"

#include <unistd.h>

#include <filesystem>

#include "ipc/base/error.hpp"

namespace tact {

void check_target(const std::string& attempt_in_words, const std::string& path,
                  const std::vector<std::string>& inputs) {
    namespace fs = std::filesystem;
    const std::string attempt = attempt_in_words + " " + path;
    const fs::path target(path);
    const fs::path folder = target.has_parent_path() ? target.parent_path() : fs::path(".");
    std::error_code ignored;
    if (fs::is_directory(target, ignored))
        throw StartupError(attempt, "the path is a folder", "give the name of a file: -o FOLDER/NAME");
    if (!fs::is_directory(folder, ignored))
        throw StartupError(attempt, "the folder " + folder.string() + " does not exist",
                           "create the folder, or give another with -o");
    if (::access(folder.c_str(), W_OK) != 0)
        throw StartupError(attempt, "the folder " + folder.string() + " is not writable",
                           "give another folder with -o");
    for (const std::string& input : inputs) {
        if (!input.empty() && fs::equivalent(input, target, ignored))
            throw StartupError(attempt, "the path is one of the input files", "give another name with -o");
    }
}

}  // namespace tact
