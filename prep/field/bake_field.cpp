#include "prep/field/bake_field.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>

#include "ipc/base/error.hpp"
#include "ipc/base/printed.hpp"
#include "ipc/scene/density/isosurface.hpp"
#include "prep/mesh/progressive.hpp"
#include "prep/mesh/simplify.hpp"

namespace tact {
namespace {

template <std::size_t N>
void put_text(char (&to)[N], const std::string& text) {
    std::size_t length = std::min(text.size(), N - 1);
    while (length < text.size() && length > 0 && (static_cast<unsigned char>(text[length]) & 0xC0) == 0x80)
        --length;
    std::memcpy(to, text.data(), length);
    for (std::size_t i = 0; i < length; ++i)
        if (static_cast<unsigned char>(to[i]) < 0x20 || to[i] == 0x7f) to[i] = '?';
}

// Largest gradient and largest second derivative (Frobenius norm of the Hessian, an upper bound of its largest
// eigenvalue) by central differences over the inner points.
struct Slopes {
    double gradient = 0.0, curvature = 0.0;
};

Slopes slopes_of(const DensityGrid& grid, const Progress& progress) {
    Slopes most;
    const auto value = [&](std::uint32_t x, std::uint32_t y, std::uint32_t z) {
        return static_cast<double>(grid.at(x, y, z));
    };
    const Vec3& h = grid.spacing_m;
    for (std::uint32_t z = 1; z + 1 < grid.size[2]; ++z) {
        report(progress, static_cast<double>(z) / grid.size[2], "computing the slopes of the field");
        for (std::uint32_t y = 1; y + 1 < grid.size[1]; ++y) {
            for (std::uint32_t x = 1; x + 1 < grid.size[0]; ++x) {
                const double at = value(x, y, z);
                const double low[3] = {value(x - 1, y, z), value(x, y - 1, z), value(x, y, z - 1)};
                const double high[3] = {value(x + 1, y, z), value(x, y + 1, z), value(x, y, z + 1)};
                double gradient2 = 0.0, curvature2 = 0.0;
                for (Eigen::Index a = 0; a < 3; ++a) {
                    gradient2 += std::pow((high[a] - low[a]) / (2.0 * h[a]), 2);
                    curvature2 += std::pow((high[a] - 2.0 * at + low[a]) / (h[a] * h[a]), 2);
                }
                const auto mixed = [&](double pp, double pm, double mp, double mm, double area) {
                    return 2.0 * std::pow((pp - pm - mp + mm) / (4.0 * area), 2);
                };
                curvature2 += mixed(value(x + 1, y + 1, z), value(x + 1, y - 1, z), value(x - 1, y + 1, z),
                                    value(x - 1, y - 1, z), h.x() * h.y());
                curvature2 += mixed(value(x + 1, y, z + 1), value(x + 1, y, z - 1), value(x - 1, y, z + 1),
                                    value(x - 1, y, z - 1), h.x() * h.z());
                curvature2 += mixed(value(x, y + 1, z + 1), value(x, y + 1, z - 1), value(x, y - 1, z + 1),
                                    value(x, y - 1, z - 1), h.y() * h.z());
                most.gradient = std::max(most.gradient, std::sqrt(gradient2));
                most.curvature = std::max(most.curvature, std::sqrt(curvature2));
            }
        }
    }
    return most;
}

// Extends the grid by kFieldPad layers on all sides by odd reflection about the faces, v(-i) = 2 v(0) - v(i), axis by
// axis, so that the gradient is continuous at a face.
DensityGrid padded(const DensityGrid& grid) {
    DensityGrid out;
    out.spacing_m = grid.spacing_m;
    out.origin_m = grid.origin_m - static_cast<double>(kFieldPad) * grid.spacing_m;
    for (std::size_t a = 0; a < 3; ++a) out.size[a] = grid.size[a] + 2 * kFieldPad;
    out.values.assign(out.count(), 0.0F);
    const auto index = [&](std::uint32_t x, std::uint32_t y, std::uint32_t z) {
        return (std::size_t{z} * out.size[1] + y) * out.size[0] + x;
    };
    for (std::uint32_t z = 0; z < grid.size[2]; ++z)
        for (std::uint32_t y = 0; y < grid.size[1]; ++y)
            for (std::uint32_t x = 0; x < grid.size[0]; ++x)
                out.values[index(x + kFieldPad, y + kFieldPad, z + kFieldPad)] = grid.at(x, y, z);
    // One axis after the other, over the range that the previous axes have filled.
    for (std::size_t a = 0; a < 3; ++a) {
        std::array<std::uint32_t, 3> low{kFieldPad, kFieldPad, kFieldPad}, high{};
        for (std::size_t b = 0; b < 3; ++b) high[b] = kFieldPad + grid.size[b];
        for (std::size_t b = 0; b < a; ++b) low[b] = 0, high[b] = out.size[b];
        low[a] = 0, high[a] = 1;
        const auto fill = [&](std::array<std::uint32_t, 3> at, std::uint32_t face, int side) {
            for (std::uint32_t i = 1; i <= kFieldPad; ++i) {
                std::array<std::uint32_t, 3> outer = at, edge = at, inner = at;
                const std::uint32_t within = std::min(i, grid.size[a] - 1);
                outer[a] = side < 0 ? face - i : face + i;
                edge[a] = face;
                inner[a] = side < 0 ? face + within : face - within;
                out.values[index(outer[0], outer[1], outer[2])] =
                    2.0F * out.values[index(edge[0], edge[1], edge[2])] -
                    out.values[index(inner[0], inner[1], inner[2])];
            }
        };
        for (std::uint32_t z = low[2]; z < high[2]; ++z)
            for (std::uint32_t y = low[1]; y < high[1]; ++y)
                for (std::uint32_t x = low[0]; x < high[0]; ++x) {
                    fill({x, y, z}, kFieldPad, -1);
                    fill({x, y, z}, kFieldPad + grid.size[a] - 1, 1);
                }
    }
    return out;
}

// Two surfaces in one mesh; empty if the field has neither.
TriangleMesh surfaces_of(const DensityGrid& grid, const Progress& progress) {
    std::vector<float> sorted = grid.values;
    TriangleMesh both;
    for (const double part_of_all : {0.1, 0.9}) {
        const auto at = sorted.begin() +
                        static_cast<std::ptrdiff_t>(part_of_all * static_cast<double>(sorted.size() - 1));
        std::nth_element(sorted.begin(), at, sorted.end());
        const TriangleMesh one = isosurface(grid, static_cast<double>(*at), progress);
        const auto first = static_cast<std::uint32_t>(both.vertices());
        both.position_m.insert(both.position_m.end(), one.position_m.begin(), one.position_m.end());
        for (std::size_t i = 0; i < one.triangle.size(); i += 3) {
            // Around low values the outside has the higher values.
            const bool turned = part_of_all < 0.5;
            both.triangle.push_back(first + one.triangle[i]);
            both.triangle.push_back(first + one.triangle[i + (turned ? 2 : 1)]);
            both.triangle.push_back(first + one.triangle[i + (turned ? 1 : 2)]);
        }
    }
    return both;
}

}  // namespace

BakedField bake_field(const FieldInput& input, SceneWriter& out, const Progress& progress) {
    BakedField baked;
    FieldMeta& f = baked.field;
    const DensityGrid& grid = input.grid;
    for (const std::string& line : input.note) baked.note += line + '\n';

    double sum = 0.0, sum2 = 0.0;
    f.low = f.high = static_cast<double>(grid.values.front());
    for (const float v : grid.values) {
        const auto value = static_cast<double>(v);
        f.low = std::min(f.low, value);
        f.high = std::max(f.high, value);
        sum += value;
    }
    f.mean = sum / static_cast<double>(grid.values.size());
    for (const float v : grid.values) sum2 += std::pow(static_cast<double>(v) - f.mean, 2);
    f.deviation = std::sqrt(sum2 / static_cast<double>(grid.values.size()));
    const Slopes most = slopes_of(grid, part(progress, 0.0, 0.6));
    if (!(f.deviation > 0.0) || !(most.gradient > 0.0))
        throw StartupError("bake a field", "all values are " + std::to_string(f.mean),
                           "give a potential that changes in space");

    const Vec3 extent_m =
        grid.spacing_m.cwiseProduct(Vec3(grid.size[0] - 1.0, grid.size[1] - 1.0, grid.size[2] - 1.0));
    SceneMeta& meta = baked.meta;
    meta.kind = SceneKind::field;
    meta.world_per_model = input.size_m / extent_m.maxCoeff();
    const Vec3 middle_m = grid.origin_m + 0.5 * extent_m;
    for (Eigen::Index a = 0; a < 3; ++a) {
        meta.centre_model_m[a] = middle_m[a];
        f.box_low_m[a] = grid.origin_m[a];
        f.box_high_m[a] = grid.origin_m[a] + extent_m[a];
    }
    put_text(meta.title, input.title);
    put_text(f.unit, input.unit);
    f.force_n_m_per_unit = input.force_n_max / most.gradient;
    f.stiffness_n_m = f.force_n_m_per_unit * most.curvature / meta.world_per_model;
    const bool stiff = f.stiffness_n_m > input.stiffness_n_m_max;
    if (stiff) {
        f.force_n_m_per_unit *= input.stiffness_n_m_max / f.stiffness_n_m;
        f.stiffness_n_m = input.stiffness_n_m_max;
    }
    f.force_n_max = f.force_n_m_per_unit * most.gradient;
    f.probe_radius_m = input.probe_radius_m / meta.world_per_model;

    baked.note += printed("field values: %.6g to %.6g, mean %.6g\n", f.low, f.high, f.mean);
    baked.note += printed("gain: %.6g N m per unit; at most %.3g N and %.3g N/m%s\n", f.force_n_m_per_unit,
                          f.force_n_max, f.stiffness_n_m, stiff ? ", limited by the stiffness" : "");
    baked.note += printed("hand: 1 mm is %.6g m of the model; the box is %.0f mm wide\n",
                          1e-3 / meta.world_per_model, 1e3 * input.size_m);
    TriangleMesh picture = surfaces_of(grid, part(progress, 0.6, 0.7));
    if (input.vertices_max > 0 && picture.vertices() > input.vertices_max) {
        SimplifySettings settings;
        settings.vertices_min = input.vertices_max;
        picture = simplify(picture, settings, part(progress, 0.7, 0.8)).mesh;
    }
    baked.vertices = picture.vertices();
    if (picture.triangles() > 0) write_mesh(out, 0, make_progressive(picture, {}, part(progress, 0.8, 0.95)));
    report(progress, 0.95, "writing the field");
    write_meta(out, meta, baked.note);
    write_field_meta(out, f);
    write_grid(out, padded(grid));
    return baked;
}

}  // namespace tact
