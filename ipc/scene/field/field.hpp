// A potential field in a scene: the values on a grid (sections GRID, ipc/scene/density) and this
// description, section FPOT.
//
// The grid is that of the file, extended on all sides by kFieldPad layers (odd reflection about its faces),
// so that the spline's gradient matches the file up to the faces of the box.
// Frame    model, metres
// Force    F_world = -force_n_m_per_unit * grad(phi), grad in model axes and per model metre, phi in the
//          file's unit
#pragma once

#include <cstdint>
#include <string>
#include <type_traits>

#include "ipc/scene/file/scene_file.hpp"

namespace tact {

inline constexpr std::uint32_t kFieldPad = 6;

struct FieldMeta {
    static constexpr SectionTag kTag{'F', 'P', 'O', 'T'};
    static constexpr std::uint32_t kVersion = 1;

    double box_low_m[3], box_high_m[3];  // box of the file's values
    double mean, deviation;              // of the values; deviation > 0
    double low, high;                    // least and greatest value
    double force_n_m_per_unit;           // gain, > 0
    double force_n_max;                  // greatest force inside the box at that gain, for a point tool
    double stiffness_n_m;   // greatest derivative of the force inside the box, N/m in the world frame
    double probe_radius_m;  // radius of the sphere over which the field is averaged; 0: a point
    char unit[32];          // of the values, UTF-8, ends with 0; empty: unknown
};
static_assert(std::is_trivially_copyable_v<FieldMeta> && sizeof(FieldMeta) == 144);

void write_field_meta(SceneWriter& out, const FieldMeta& field);
// Checks every number: finite, in order, positive for a scale. Throws StartupError.
[[nodiscard]] FieldMeta read_field_meta(const SceneFile& file);

}  // namespace tact
