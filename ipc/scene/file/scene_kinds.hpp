// The kinds of scenes, one row each. A new kind is a value of SceneKind and a row of the table in
// scene_kinds.cpp.
//
// The row holds the data of a kind that every program needs: its number and name in the file, the sections
// and values that such a scene must have, the command that bakes it, and the raw files that the command
// reads. Programs keep their own tables for the rest (prep/cli/systems, deploy/tact/systems).
#pragma once

#include <cstdint>
#include <span>

#include "ipc/scene/file/scene_file.hpp"

namespace tact {

enum class SceneKind : std::uint32_t { docking = 1, surface = 2, drilling = 3, field = 4 };

inline constexpr std::uint32_t kSceneBodiesMax = 16;  // bodies in a force model

// One type of raw file: maps, structures, meshes, ...
struct RawFileType {
    const char* name;                      // "map"
    const char* phrase;                    // in a list of supported files: "a map", "its structures"
    std::span<const char* const> endings;  // lower case, with the dot; each may be followed by .gz
    const char* folder_of;    // contents of a folder that counts as one such file; null: no folder
    std::uint32_t files_max;  // accepted by one command
    const char* missing;      // message if the other files come without this one; null: none needed
    bool adds = false;        // tact COMMAND SCENE FILE... adds such files to a scene of this kind
};

// Limits of the values in section META.
struct MetaLimits {
    double resolution_min_m, resolution_max_m, energy_min_j, map_sigma_min;
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
    bool asks;  // tact-prep examine WORD FILE... says what a person must answer before the import
};

[[nodiscard]] std::span<const SceneKindRow> scene_kinds();
// Null for a number without a kind.
[[nodiscard]] const SceneKindRow* find_scene_kind(SceneKind kind);
// "docking", ...; "unknown" for a number without a kind.
[[nodiscard]] const char* scene_kind_text(SceneKind kind);

}  // namespace tact
