// The names of a scan's structures, in a table beside it that a person edits: `structures.toml` in a folder of slices,
// `NAME.structures.toml` beside a file NAME.nrrd or NAME.nii.gz. Read by tact-prep; a scene depends on its content.
//
// Thread   any
#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <span>
#include <string>

namespace tact {

// Where the table of a scan lies, or would lie.
[[nodiscard]] std::filesystem::path structure_table_path(const std::filesystem::path& scan);
// Empty: there is none.
[[nodiscard]] std::filesystem::path structure_table_beside(const std::filesystem::path& scan);

struct StructureRow {
    std::uint8_t label = 0;  // 0: known by its colour
    std::array<std::uint8_t, 3> rgb{};
    std::string name;
    bool critical = false;
    std::uint64_t voxels = 0;
};
// As TOML to be edited.
[[nodiscard]] std::string structure_table_text(std::span<const StructureRow> rows);

}  // namespace tact
