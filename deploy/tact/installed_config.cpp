#include "deploy/tact/installed_config.hpp"

namespace tact::launch {

std::filesystem::path installed_config(const std::filesystem::path& program) {
    const auto folder = program.parent_path();
    if (folder.filename() != "bin") return {};
    const auto prefix = folder.parent_path();
    const auto file = (prefix == "/usr" ? std::filesystem::path("/") : prefix) / "etc/tact/tact.toml";
    std::error_code ignored;
    return std::filesystem::is_regular_file(file, ignored) ? file : std::filesystem::path();
}

std::filesystem::path installed_config() {
    std::error_code ignored;
    return installed_config(std::filesystem::read_symlink("/proc/self/exe", ignored));
}

}  // namespace tact::launch
