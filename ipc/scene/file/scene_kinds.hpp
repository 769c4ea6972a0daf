// The kinds of scene, one row each. A new kind is a value of SceneKind and a row of the table in scene_kinds.cpp.
//
// The row holds what every program needs of a kind: its number and name in the file, the sections and values that such a
// scene must have, the command that bakes it, and the raw files that the command reads. Programs keep tables of their own for
// the rest (prep/cli/systems, deploy/tact/systems).
#pragma once

#include <cstdint>
#include <span>

#include "ipc/scene/file/scene_file.hpp"

namespace tact {

enum class SceneKind : std::uint32_t { docking = 1, surface = 2, drilling = 3, field = 4 };

inline constexpr std::uint32_t kSceneBodiesMax = 16;  // bodies that a force model holds

// One type of raw file: maps, structures, meshes, ...
struct RawFileType {
    const char* name;                      // "map"
    const char* phrase;                    // in a list of what can be opened: "a map", "its structures"
    std::span<const char* const> endings;  // lower case, with the dot; each may be followed by .gz
    const char* folder_of;    // contents of a folder that stands for one such file; null: no folder
    std::uint32_t files_max;  // that one command takes
    const char* missing;      // message where the other files come without this one; null: it is alone
};

// Limits of the values in section META.
struct MetaLimits {
    double resolution_max_m, energy_min_j, map_sigma_min;
    std::uint32_t bodies_min, bodies_max;
};

struct SceneKindRow {
    SceneKind kind;
    const char* name;                      // "docking"
    const char* command;                   // of tact and tact-prep: "dock"
    const char* action;                    // on buttons and in messages: "Dock"
    std::span<const SectionTag> sections;  // that must be present besides META and NOTE
    MetaLimits limits;
    std::span<const RawFileType> raw;  // in the order of the command's arguments
};

[[nodiscard]] std::span<const SceneKindRow> scene_kinds();
// Null for a number that is no kind.
[[nodiscard]] const SceneKindRow* find_scene_kind(SceneKind kind);
// "docking", ...; "unknown" for a number that is no kind.
[[nodiscard]] const char* scene_kind_text(SceneKind kind);

}  // namespace tact
