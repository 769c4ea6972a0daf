// How far any point is from one structure of a bone volume: read off a coarse grid, between its points linearly.
//
// Distance   to the surface of the structure's voxels, taken as cubes; negative inside.
// Error      stated in the section as error_m: no distance that is read off inside the grid is wrong by more. Where
//            the structure is more than a spacing away it is a small part of that (prep/volume/README.md).
// Beyond the grid the result is never more than the true distance and the error.
// Section DIST, one per structure: a header of 64 bytes, then 16-bit integers in steps of quantum_m, x fastest. A view
// on the mapped file.
// Thread     immutable, no allocation; the file outlives it.  Fails by  StartupError
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
    std::span<const std::int16_t> quanta;  // as many as grid points

    [[nodiscard]] std::size_t points() const noexcept { return std::size_t{size[0]} * size[1] * size[2]; }
    // Any point, model.
    [[nodiscard]] double distance_m(const Vec3& model_m) const noexcept;
};

inline constexpr std::uint32_t kDistanceFieldsMax = 255;

// Throws StartupError where the field is none that could be read again.
void write_distance_field(SceneWriter& out, std::uint32_t index, const DistanceField& field);
// All of a scene, at most one for a label; `structures` as many as LABL has.
std::vector<DistanceField> read_distance_fields(const SceneFile& file, std::size_t structures);

}  // namespace tact
