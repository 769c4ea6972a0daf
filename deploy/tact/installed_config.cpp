#include "deploy/tact/installed_config.hpp"

namespace tact::launch {

std::filesystem::path installed_config(const std::filesystem::path& program) {
    const auto folder = program.parent_path();
    if (folder.filename() != "bin") return {};
    const auto prefix = folder.parent_path();
    for (const std::filesystem::path& root :
         {prefix, std::filesystem::path(prefix == "/usr" ? "/" : prefix)}) {
        std::error_code ignored;
        if (auto file = root / "etc/tact/tact.toml"; std::filesystem::is_regular_file(file, ignored))
            return file;
    }
    return {};
}

std::filesystem::path installed_config() {
    std::error_code ignored;
    return installed_config(std::filesystem::read_symlink("/proc/self/exe", ignored));
}

}  // namespace tact::launch
