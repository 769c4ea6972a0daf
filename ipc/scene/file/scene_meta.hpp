// Description of a scene and its mapping to the hand's world. Sections META (this struct) and NOTE (text).
//
// x_world = world_per_model * (x_model - centre_model_m): axes are parallel, the scale is uniform.
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <string_view>
#include <type_traits>

#include "ipc/base/pose.hpp"
#include "ipc/scene/file/scene_file.hpp"
#include "ipc/scene/file/scene_kinds.hpp"

namespace tact {

struct SceneMeta {
    static constexpr SectionTag kTag{'M', 'E', 'T', 'A'};
    static constexpr std::uint32_t kVersion = 1;

    SceneKind kind;
    std::uint32_t body_count;
    double world_per_model;
    double centre_model_m[3];
    double energy_j_per_sigma;  // docking: gain of the force, see rt/force/docking
    double map_mean;            // docking: of the map from its file, in the file's unit
    double map_sigma;
    double map_background;  // value of the map outside its box
    double contour;         // isosurface level, in the map's unit
    double resolution_m;    // of a docking scene; 0 in others
    char title[128];        // UTF-8, ends with 0

    [[nodiscard]] Vec3 to_world(const Vec3& model_m) const {
        return world_per_model * (model_m - Vec3(centre_model_m[0], centre_model_m[1], centre_model_m[2]));
    }
    [[nodiscard]] Vec3 to_model(const Vec3& world_m) const {
        return world_m / world_per_model + Vec3(centre_model_m[0], centre_model_m[1], centre_model_m[2]);
    }
};
static_assert(std::is_trivially_copyable_v<SceneMeta> && sizeof(SceneMeta) == 216);

void write_meta(SceneWriter& out, const SceneMeta& meta, const std::string& note);
// Checks every field: finite, positive for a scale, known kind with its sections, terminated title.
SceneMeta read_meta(const SceneFile& file);
// Provenance as lines "key: value": source files, the origin rule applied, sizes, times.
std::string read_note(const SceneFile& file);

}  // namespace tact
