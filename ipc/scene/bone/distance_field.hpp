// Distance of any point from one structure of a bone volume: linear interpolation on a coarse grid.
//
// Distance   to the surface of the structure's voxels, as cubes; negative inside
// Error      error_m in the section: bound for interpolated distances inside the grid. More than one
//            spacing away from the structure, the error is much smaller (prep/volume/README.md)
// Outside    the grid, the result never exceeds the true distance plus the error
// Section    DIST, one per structure: a header of 64 bytes, then 16-bit integers in steps of quantum_m, x
//            fastest. A view of the mapped file.
// Thread     immutable, no allocation; the file outlives it
// Errors     StartupError
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "ipc/base/pose.hpp"
#include "ipc/scene/file/scene_file.hpp"

namespace tact {

struct DistanceField {
    std::uint32_t label = 0;  // of the structure, as in LABL
    std::array<std::uint32_t, 3> size{};
    double spacing_m = 0.0;
    Vec3 origin_m = Vec3::Zero();  // model; of grid point (0, 0, 0)
    double quantum_m = 0.0;
    double error_m = 0.0;
    std::span<const std::int16_t> quanta;  // one per grid point

    [[nodiscard]] std::size_t points() const noexcept { return std::size_t{size[0]} * size[1] * size[2]; }
    // For any point in the model frame.
    [[nodiscard]] double distance_m(const Vec3& model_m) const noexcept;
};

inline constexpr std::uint32_t kDistanceFieldsMax = 255;

// Throws StartupError for a field that could not be read again.
void write_distance_field(SceneWriter& out, std::uint32_t index, const DistanceField& field);
// All fields of a scene, at most one per label; `structures`: their number in LABL.
std::vector<DistanceField> read_distance_fields(const SceneFile& file, std::size_t structures);

}  // namespace tact
