#include "ipc/scene/bone/structure_table.hpp"

#include <cstdio>

namespace tact {

std::filesystem::path structure_table_path(const std::filesystem::path& scan) {
    std::error_code ignored;
    if (std::filesystem::is_directory(scan, ignored)) return scan / "structures.toml";
    const std::string name = scan.filename().string();
    return scan.parent_path() / (name.substr(0, name.find('.', 1)) + ".structures.toml");
}

std::filesystem::path structure_table_beside(const std::filesystem::path& scan) {
    std::error_code ignored;
    std::filesystem::path path = structure_table_path(scan);
    return std::filesystem::is_regular_file(path, ignored) ? path : std::filesystem::path();
}

std::string structure_table_text(std::span<const StructureRow> rows) {
    std::string text =
        "# Names of the structures of a scan. Put it beside the scan: structures.toml in a folder of "
        "slices,\n"
        "# NAME.structures.toml beside a file; or give it with --label-names.\n"
        "# A critical structure has its distance from the burr shown, and warnings.\n";
    for (const StructureRow& s : rows) {
        char colour[16];
        std::snprintf(colour, sizeof colour, "#%02X%02X%02X", s.rgb[0], s.rgb[1], s.rgb[2]);
        text += "\n[[structure]]  # " + std::to_string(s.voxels) + " voxels\n";
        if (s.label != 0) text += "label = " + std::to_string(s.label) + "\n";
        text += std::string("colour = \"") + colour + "\"\nname = \"";
        for (const char c : s.name)
            if (static_cast<unsigned char>(c) >= 32 && c != 127)
                text += (c == '"' || c == '\\' ? "\\" : "") + std::string(1, c);
        text += std::string("\"\ncritical = ") + (s.critical ? "true" : "false") + "\n";
    }
    return text;
}

}  // namespace tact
