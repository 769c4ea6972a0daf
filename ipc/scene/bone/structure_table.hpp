// Where the names of a scan's structures lie beside it: `structures.toml` in a folder of slices, `NAME.structures.toml`
// beside a file NAME.nrrd or NAME.nii.gz. Read by tact-prep; a scene depends on its content.
//
// Thread   any
#pragma once

#include <filesystem>
#include <string>

namespace tact {

// Empty: there is none.
[[nodiscard]] inline std::filesystem::path structure_table_beside(const std::filesystem::path& scan) {
    namespace fs = std::filesystem;
    std::error_code ignored;
    const fs::path in_folder = scan / "structures.toml";
    if (fs::is_directory(scan, ignored))
        return fs::is_regular_file(in_folder, ignored) ? in_folder : fs::path();
    const std::string name = scan.filename().string();
    const fs::path beside = scan.parent_path() / (name.substr(0, name.find('.', 1)) + ".structures.toml");
    return fs::is_regular_file(beside, ignored) ? beside : fs::path();
}

}  // namespace tact
