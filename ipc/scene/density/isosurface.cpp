// Marching cubes (Lorensen, Cline 1987) with the derived case table of ipc/scene/density/cell_cases.cpp.
// Vertices are welded by the edge that contains them: ids are stored for the edges of two slices, in three
// planes of x, y and z.
#include "ipc/scene/density/isosurface.hpp"

#include <algorithm>
#include <cmath>
#include <string>

#include "ipc/base/error.hpp"
#include "ipc/scene/density/cell_cases.hpp"

namespace tact {
namespace {

constexpr std::uint32_t kNone = UINT32_MAX;
constexpr std::size_t kVerticesMax = std::size_t{1} << 28;
// Keeps vertices off the corners, where several edges would share one position and triangles degenerate.
// Displaces the surface by at most this fraction of a voxel edge, and only where a sample is that close to
// the level.
constexpr double kCornerGap = 1.0 / 128.0;

[[noreturn]] void refuse(const std::string& why, const std::string& fix) {
    throw StartupError("extract an isosurface", why, fix);
}

class Marcher {
public:
    Marcher(const DensityGrid& grid, double level) : grid_(grid), level_(level) {
        const std::size_t slice = std::size_t{grid.size[0]} * grid.size[1];
        for (auto& ids : along_x_) ids.assign(slice, kNone);
        for (auto& ids : along_y_) ids.assign(slice, kNone);
        along_z_.assign(slice, kNone);
        for (auto& flags : inside_) flags.resize(slice);
    }

    TriangleMesh run(const Progress& progress) {
        flag(0);
        for (std::uint32_t z = 0; z + 1 < grid_.size[2]; ++z) {
            report(progress, static_cast<double>(z) / grid_.size[2], "isosurface");
            flag(z + 1);
            const std::size_t below = z & 1U;
            std::fill(along_x_[below ^ 1U].begin(), along_x_[below ^ 1U].end(), kNone);
            std::fill(along_y_[below ^ 1U].begin(), along_y_[below ^ 1U].end(), kNone);
            std::fill(along_z_.begin(), along_z_.end(), kNone);
            for (std::uint32_t y = 0; y + 1 < grid_.size[1]; ++y) row(y, z);
        }
        return std::move(mesh_);
    }

private:
    [[nodiscard]] std::size_t at(std::uint32_t x, std::uint32_t y) const {
        return std::size_t{y} * grid_.size[0] + x;
    }

    void flag(std::uint32_t z) {
        const float* values = grid_.values.data() + std::size_t{z} * grid_.size[0] * grid_.size[1];
        auto& flags = inside_[z & 1U];
        for (std::size_t i = 0; i < flags.size(); ++i)
            flags[i] = static_cast<double>(values[i]) > level_ ? 1 : 0;
    }

    void row(std::uint32_t y, std::uint32_t z) {
        const std::uint8_t* f00 = inside_[z & 1U].data() + at(0, y);
        const std::uint8_t* f01 = inside_[z & 1U].data() + at(0, y + 1);
        const std::uint8_t* f10 = inside_[(z + 1) & 1U].data() + at(0, y);
        const std::uint8_t* f11 = inside_[(z + 1) & 1U].data() + at(0, y + 1);
        const auto column = [&](std::uint32_t x) {
            return static_cast<unsigned>(f00[x] | f01[x] << 2 | f10[x] << 4 | f11[x] << 6);
        };
        unsigned left = column(0);
        for (std::uint32_t x = 0; x + 1 < grid_.size[0]; ++x) {
            const unsigned right = column(x + 1);
            const unsigned inside = left | right << 1U;
            left = right;
            if (inside != 0 && inside != 255) cell(x, y, z, cell_cases()[inside]);
        }
    }

    void cell(std::uint32_t x, std::uint32_t y, std::uint32_t z, const CellCase& form) {
        std::array<std::uint32_t, 16> centre{};
        for (std::size_t i = 0; i < form.centre.size(); ++i) {
            Vec3 sum = Vec3::Zero();
            for (const std::uint8_t e : form.centre[i]) {
                const std::size_t v = vertex(x, y, z, e);
                sum +=
                    Vec3(mesh_.position_m[3 * v], mesh_.position_m[3 * v + 1], mesh_.position_m[3 * v + 2]);
            }
            centre[i] = add(sum / static_cast<double>(form.centre[i].size()));
        }
        for (const auto& triangle : form.triangle) {
            for (const std::uint8_t e : triangle) {
                mesh_.triangle.push_back(e >= kCellCentre ? centre[e - kCellCentre] : vertex(x, y, z, e));
            }
        }
    }

    std::uint32_t vertex(std::uint32_t x, std::uint32_t y, std::uint32_t z, std::uint8_t edge) {
        const auto [corner, axis] = kCellEdge[edge];
        const std::array<std::uint32_t, 3> low{x + (corner & 1U), y + (corner >> 1U & 1U),
                                               z + (corner >> 2U)};
        auto& ids = axis == 0 ? along_x_[low[2] & 1U] : axis == 1 ? along_y_[low[2] & 1U] : along_z_;
        std::uint32_t& id = ids[at(low[0], low[1])];
        if (id == kNone) id = add(crossing(low, axis));
        return id;
    }

    [[nodiscard]] Vec3 crossing(const std::array<std::uint32_t, 3>& low, std::size_t axis) const {
        std::array<std::uint32_t, 3> high = low;
        ++high[axis];
        const double a = grid_.at(low[0], low[1], low[2]);
        const double b = grid_.at(high[0], high[1], high[2]);
        double t = (level_ - a) / (b - a);
        if (!std::isfinite(t)) t = 0.5;  // an adjacent sample is NaN or infinite
        Vec3 place(low[0], low[1], low[2]);
        place[static_cast<Eigen::Index>(axis)] += std::clamp(t, kCornerGap, 1.0 - kCornerGap);
        return grid_.origin_m + grid_.spacing_m.cwiseProduct(place);
    }

    std::uint32_t add(const Vec3& model_m) {
        const std::size_t id = mesh_.vertices();
        if (id >= kVerticesMax) {
            refuse("the surface at this level has more than 2^28 vertices",
                   "choose a higher contour level or a coarser map");
        }
        for (int i = 0; i < 3; ++i) mesh_.position_m.push_back(static_cast<float>(model_m[i]));
        return static_cast<std::uint32_t>(id);
    }

    const DensityGrid& grid_;
    double level_;
    TriangleMesh mesh_;
    std::array<std::vector<std::uint32_t>, 2> along_x_, along_y_;  // of even and odd slices
    std::vector<std::uint32_t> along_z_;                           // between the two
    std::array<std::vector<std::uint8_t>, 2> inside_;
};

}  // namespace

TriangleMesh isosurface(const DensityGrid& grid, double level, const Progress& progress) {
    if (!std::isfinite(level))
        refuse("the level is not a finite number", "enter the contour level as a number");
    if (grid.values.size() != grid.count()) {
        refuse("the grid holds " + std::to_string(grid.values.size()) + " values, its size requires " +
                   std::to_string(grid.count()),
               "import the map again");
    }
    if (std::any_of(grid.size.begin(), grid.size.end(), [](std::uint32_t n) { return n < 2; })) return {};
    return Marcher(grid, level).run(progress);
}

}  // namespace tact
