#include <cmath>

#include "ipc/scene/density/density_map.hpp"
#include "ipc/scene/file/bytes.hpp"

namespace tact {
namespace {

constexpr SectionTag kGridTag{'G', 'R', 'I', 'D'};
constexpr std::uint32_t kGridVersion = 1;
constexpr std::uint32_t kSizeMax = 8192;

// 64 bytes, so that the values are aligned in the mapped file.
struct GridHeader {
    std::uint32_t size[3];
    std::uint32_t reserved;  // zero
    double origin_m[3];
    double spacing_m[3];
};
static_assert(sizeof(GridHeader) == 64);

}  // namespace

void write_grid(SceneWriter& out, const DensityGrid& grid, std::uint32_t index) {
    GridHeader header{};
    for (int a = 0; a < 3; ++a) {
        header.size[a] = grid.size[static_cast<std::size_t>(a)];
        header.origin_m[a] = grid.origin_m[a];
        header.spacing_m[a] = grid.spacing_m[a];
    }
    BytesOut bytes;
    bytes.put(header);
    bytes.put_all(grid.values);
    out.add(kGridTag, kGridVersion, index, bytes.take());
}

DensityGrid read_grid(const SceneFile& file, std::uint32_t index) {
    BytesIn in(file.section(kGridTag, kGridVersion, index),
               file.name() + ", section GRID " + std::to_string(index));
    const auto header = in.get<GridHeader>("header");
    if (header.reserved != 0) in.fail("a reserved field is not zero");
    DensityGrid grid;
    std::uint64_t count = 1;  // 8192^3 is far below 2^64
    for (int a = 0; a < 3; ++a) {
        if (header.size[a] < 2 || header.size[a] > kSizeMax) {
            in.fail("the grid has " + std::to_string(header.size[a]) +
                    " voxels along an axis; allowed are 2 to " + std::to_string(kSizeMax));
        }
        if (!(std::abs(header.origin_m[a]) <= 1e6))
            in.fail("the origin is " + std::to_string(header.origin_m[a]) + " m");
        if (!(header.spacing_m[a] >= 1e-13 && header.spacing_m[a] <= 1e3)) {
            in.fail("the voxel is " + std::to_string(header.spacing_m[a]) + " m wide");
        }
        grid.size[static_cast<std::size_t>(a)] = header.size[a];
        grid.origin_m[a] = header.origin_m[a];
        grid.spacing_m[a] = header.spacing_m[a];
        count *= header.size[a];
    }
    grid.values = in.get_all<float>(count, "voxels");
    in.finish();
    in.check_finite(grid.values, 1e30, "voxel");
    return grid;
}

DensityGrid read_force_map_grid(const SceneFile& file) {
    return read_grid(file, file.count(kGridTag) > kForceMapGrid ? kForceMapGrid : kMapGrid);
}

}  // namespace tact
