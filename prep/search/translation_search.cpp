#include "prep/search/translation_search.hpp"

#include <algorithm>
#include <cmath>
#include <map>

#include "ipc/scene/density/simulated_map.hpp"
#include "prep/map/low_pass.hpp"

namespace tact {
namespace {

constexpr float kRegionShare = 0.05F;

// Trilinear, with 0 outside.
double value_at(const DensityGrid& grid, const Vec3& at_m) {
    const Vec3 t = (at_m - grid.origin_m).cwiseQuotient(grid.spacing_m);
    double sum = 0.0;
    for (int corner = 0; corner < 8; ++corner) {
        double weight = 1.0;
        std::array<std::uint32_t, 3> node{};
        for (int a = 0; a < 3 && weight > 0.0; ++a) {
            const double base = std::floor(t[a]), up = t[a] - base;
            const double i = base + (corner >> a & 1);
            weight *= (corner >> a & 1) != 0 ? up : 1.0 - up;
            if (!(i >= 0.0 && i < grid.size[static_cast<std::size_t>(a)])) weight = 0.0;
            node[static_cast<std::size_t>(a)] = static_cast<std::uint32_t>(std::max(i, 0.0));
        }
        if (weight > 0.0) sum += weight * static_cast<double>(grid.at(node[0], node[1], node[2]));
    }
    return sum;
}

FftVolume::Size padded(const SearchMap& map, std::uint32_t reach) {
    FftVolume::Size size{};
    for (std::size_t a = 0; a < 3; ++a)
        size[a] = FftVolume::quick_length(std::max(map.grid.size[a] + reach, 2 * reach + 1));
    return size;
}

}  // namespace

std::vector<float> laplacian_of(const std::vector<float>& v, const std::array<std::uint32_t, 3>& n) {
    std::vector<float> out(v.size());
    const std::array<std::size_t, 3> stride{1, n[0], std::size_t{n[0]} * n[1]};
    std::size_t i = 0;
    std::array<std::uint32_t, 3> at{};
    for (at[2] = 0; at[2] < n[2]; ++at[2])
        for (at[1] = 0; at[1] < n[1]; ++at[1])
            for (at[0] = 0; at[0] < n[0]; ++at[0], ++i) {
                float sum = 6.0F * v[i];
                for (std::size_t a = 0; a < 3; ++a) {
                    if (at[a] > 0) sum -= v[i - stride[a]];
                    if (at[a] + 1 < n[a]) sum -= v[i + stride[a]];
                }
                out[i] = sum;
            }
    return out;
}

SearchMap search_map(const DensityGrid& map, double background, double resolution_m, double search_m,
                     bool with_laplacian, double voxels_per_resolution) {
    SearchMap out;
    out.resolution_m = std::max(resolution_m, search_m);
    out.voxel_m = out.resolution_m / voxels_per_resolution;
    out.laplacian = with_laplacian;
    DensityGrid from = map;
    for (float& v : from.values) v -= static_cast<float>(background);
    const double more_m = std::sqrt(std::max(search_m * search_m - resolution_m * resolution_m, 0.0));
    if (more_m > 0.05 * resolution_m) from = low_pass(from, 0.0, more_m);
    out.grid.origin_m = map.origin_m;
    out.grid.spacing_m = Vec3::Constant(out.voxel_m);
    for (std::size_t a = 0; a < 3; ++a) {
        const auto axis = static_cast<Eigen::Index>(a);
        out.grid.size[a] =
            static_cast<std::uint32_t>(std::ceil((map.size[a] - 1.0) * map.spacing_m[axis] / out.voxel_m)) +
            1;
    }
    out.grid.values.reserve(out.grid.count());
    for (std::uint32_t z = 0; z < out.grid.size[2]; ++z)
        for (std::uint32_t y = 0; y < out.grid.size[1]; ++y)
            for (std::uint32_t x = 0; x < out.grid.size[0]; ++x)
                out.grid.values.push_back(
                    static_cast<float>(value_at(from, out.grid.origin_m + out.voxel_m * Vec3(x, y, z))));
    double sum = 0.0, sum_2 = 0.0;
    for (const float v : out.grid.values) {
        sum += static_cast<double>(v);
        sum_2 += static_cast<double>(v) * static_cast<double>(v);
    }
    const double count = static_cast<double>(out.grid.count()), mean = sum / count,
                 deviation = std::sqrt(std::max(sum_2 / count - mean * mean, 0.0));
    for (std::uint32_t z = 0; z < out.grid.size[2]; ++z)
        for (std::uint32_t y = 0; y < out.grid.size[1]; ++y)
            for (std::uint32_t x = 0; x < out.grid.size[0]; ++x)
                if (static_cast<double>(out.grid.at(x, y, z)) > mean + deviation)
                    out.inside.push_back({x, y, z});
    if (with_laplacian) out.grid.values = laplacian_of(out.grid.values, out.grid.size);
    return out;
}

Structure coarse_structure(const Structure& s, double cell_m) {
    struct Cell {
        Vec3 sum_m = Vec3::Zero();
        double weight = 0.0;
    };
    std::map<std::array<int, 3>, Cell> cells;
    double total = 0.0;
    for (std::size_t i = 0; i < s.size(); ++i) {
        const Vec3 at(static_cast<double>(s.x_m[i]), static_cast<double>(s.y_m[i]),
                      static_cast<double>(s.z_m[i]));
        const double weight = scattering_weight(s, i);
        std::array<int, 3> key{};
        for (int a = 0; a < 3; ++a)
            key[static_cast<std::size_t>(a)] = static_cast<int>(std::floor(at[a] / cell_m));
        Cell& cell = cells[key];
        cell.sum_m += weight * at;
        cell.weight += weight;
        total += weight;
    }
    Structure out;
    out.name = s.name;
    out.home_com_model_m = s.home_com_model_m;
    out.mass_u = total;
    for (const auto& [key, cell] : cells) {
        const Vec3 at = cell.sum_m / cell.weight;
        out.x_m.push_back(static_cast<float>(at.x()));
        out.y_m.push_back(static_cast<float>(at.y()));
        out.z_m.push_back(static_cast<float>(at.z()));
        out.mass_fraction.push_back(static_cast<float>(cell.weight / total));
        out.element.push_back(0);
    }
    return out;
}

double radius_m(const Structure& s) {
    double most_2 = 0.0;
    for (std::size_t i = 0; i < s.size(); ++i)
        most_2 = std::max(most_2, Vec3(static_cast<double>(s.x_m[i]), static_cast<double>(s.y_m[i]),
                                       static_cast<double>(s.z_m[i]))
                                      .squaredNorm());
    return std::sqrt(most_2);
}

CorrelationPoints search_points(const Structure& structure, const SearchMap& map) {
    Frame frame(structure, map);
    CorrelationPoints points;
    if (!frame.fill(structure, Quat::Identity(), map)) return points;
    std::size_t i = 0;
    for (std::uint32_t z = 0; z < frame.grid.size[2]; ++z)
        for (std::uint32_t y = 0; y < frame.grid.size[1]; ++y)
            for (std::uint32_t x = 0; x < frame.grid.size[0]; ++x, ++i) {
                if (!frame.inside(i)) continue;
                points.at_m.emplace_back(frame.grid.origin_m + map.voxel_m * Vec3(x, y, z));
                points.value.push_back(static_cast<double>(frame.value()[i]));
            }
    return points;
}

Frame::Frame(const Structure& structure, const SearchMap& map)
    : reach(static_cast<std::uint32_t>(std::ceil(
                (radius_m(structure) + kSimulatedCutSigmas * kSigmaPerResolution * map.resolution_m) /
                map.voxel_m)) +
            1) {
    const std::uint32_t wide = 2 * reach + 1;
    grid.size = {wide, wide, wide};
    grid.origin_m = Vec3::Constant(-static_cast<double>(reach) * map.voxel_m);
    grid.spacing_m = Vec3::Constant(map.voxel_m);
    density_.resize(grid.count());
}

bool Frame::fill(const Structure& structure, const Quat& turn, const SearchMap& map) {
    std::fill(density_.begin(), density_.end(), 0.0F);
    add_simulated(grid, {&structure, {Vec3::Zero(), turn}}, map.resolution_m, 1.0F, whole_box(grid),
                  density_);
    least_ = kRegionShare * *std::max_element(density_.begin(), density_.end());
    if (map.laplacian) filtered_ = laplacian_of(density_, grid.size);
    return least_ > 0.0F;
}

MapWaves::MapWaves(const SearchMap& map, const Structure& structure)
    : map_(map),
      structure_(structure),
      frame_(structure, map),
      fft_(padded(map, frame_.reach)),
      values_(fft_.waves()),
      squares_(fft_.waves()) {
    FftBuffer<float> values(fft_.voxels()), squares(fft_.voxels());
    const auto& n = fft_.size();
    double sum = 0.0, sum_2 = 0.0;
    std::size_t i = 0;
    for (std::uint32_t z = 0; z < map.grid.size[2]; ++z)
        for (std::uint32_t y = 0; y < map.grid.size[1]; ++y)
            for (std::uint32_t x = 0; x < map.grid.size[0]; ++x, ++i) {
                const float v = map.grid.values[i];
                const std::size_t to = (std::size_t{z} * n[1] + y) * n[0] + x;
                values.data()[to] = v;
                squares.data()[to] = v * v;
                sum += static_cast<double>(v);
                sum_2 += static_cast<double>(v) * static_cast<double>(v);
            }
    const auto count = static_cast<double>(map.grid.count());
    vary_least_2_ = RotationScore::kVaryLeast * RotationScore::kVaryLeast *
                    std::max(sum_2 / count - sum * sum / (count * count), 0.0);
    fft_.forward(values, values_);
    fft_.forward(squares, squares_);
}

RotationScore::RotationScore(const MapWaves& map)
    : map_(map),
      frame_(map.frame_),
      score_(map.fft_.voxels()),
      mean_(map.fft_.voxels()),
      square_(map.fft_.voxels()),
      model_(map.fft_.waves()),
      mask_(map.fft_.waves()),
      product_(map.fft_.waves()) {}

// to(t) = sum over x of model(x - t) with(x), times the number of voxels.
void RotationScore::correlate(const FftBuffer<std::complex<float>>& model,
                              const FftBuffer<std::complex<float>>& with, FftBuffer<float>& to) {
    for (std::size_t i = 0; i < map_.fft_.waves(); ++i)
        product_.data()[i] = std::conj(model.data()[i]) * with.data()[i];
    map_.fft_.backward(product_, to);
}

bool RotationScore::at(const Quat& turn) {
    if (!frame_.fill(map_.structure_, turn, map_.map_)) return false;
    const std::vector<float>& u = frame_.value();
    double n = 0.0, sum = 0.0, sum_2 = 0.0;
    for (std::size_t i = 0; i < u.size(); ++i) {
        if (!frame_.inside(i)) continue;
        n += 1.0;
        sum += static_cast<double>(u[i]);
        sum_2 += static_cast<double>(u[i]) * static_cast<double>(u[i]);
    }
    const double varied = sum_2 - sum * sum / std::max(n, 1.0);
    if (!(n > 1.0 && varied > 0.0)) return false;
    // The origin of the structure is voxel 0 of the transform; what is before it wraps around.
    const auto& size = map_.fft_.size();
    const auto mean = static_cast<float>(sum / n), per = static_cast<float>(1.0 / std::sqrt(varied));
    std::fill_n(score_.data(), map_.fft_.voxels(), 0.0F);
    std::fill_n(mean_.data(), map_.fft_.voxels(), 0.0F);
    std::size_t i = 0;
    const auto wrapped = [&](std::uint32_t k, std::size_t a) {
        return (k + size[a] - frame_.reach) % size[a];
    };
    for (std::uint32_t z = 0; z < frame_.grid.size[2]; ++z)
        for (std::uint32_t y = 0; y < frame_.grid.size[1]; ++y) {
            const std::size_t row = (std::size_t{wrapped(z, 2)} * size[1] + wrapped(y, 1)) * size[0];
            for (std::uint32_t x = 0; x < frame_.grid.size[0]; ++x, ++i) {
                if (!frame_.inside(i)) continue;
                score_.data()[row + wrapped(x, 0)] = per * (u[i] - mean);
                mean_.data()[row + wrapped(x, 0)] = 1.0F;
            }
        }
    map_.fft_.forward(score_, model_);
    map_.fft_.forward(mean_, mask_);
    correlate(model_, map_.values_, score_);
    correlate(mask_, map_.values_, mean_);
    correlate(mask_, map_.squares_, square_);
    const float per_voxel = 1.0F / static_cast<float>(map_.fft_.voxels()),
                per_n = static_cast<float>(1.0 / n), root_n = static_cast<float>(std::sqrt(n)),
                vary_least_2 = static_cast<float>(std::max(map_.vary_least_2_, 1e-30));
    for (std::size_t k = 0; k < map_.fft_.voxels(); ++k) {
        const float m = mean_.data()[k] * per_voxel * per_n, s = square_.data()[k] * per_voxel * per_n;
        score_.data()[k] *= per_voxel / (root_n * std::sqrt(std::max(s - m * m, vary_least_2)));
    }
    return true;
}

std::vector<SearchPeak> RotationScore::peaks(std::size_t most, const Vec3& middle_m, double within_m) const {
    std::vector<SearchPeak> found;
    const auto& n = map_.map_.grid.size;
    for (std::uint32_t z = 0; z < n[2]; ++z)
        for (std::uint32_t y = 0; y < n[1]; ++y)
            for (std::uint32_t x = 0; x < n[0]; ++x) {
                const float here = score(x, y, z);
                if (found.size() == most && !(static_cast<double>(here) > found.back().score)) continue;
                const Vec3 at_m = map_.map_.grid.origin_m + map_.map_.voxel_m * Vec3(x, y, z);
                if (within_m > 0.0 && (at_m - middle_m).norm() > within_m + map_.map_.voxel_m) continue;
                bool top = here > 0.0F;
                for (int k = 0; k < 27 && top; ++k) {
                    const std::int64_t i = x + k % 3 - 1LL, j = y + k / 3 % 3 - 1LL, l = z + k / 9 - 1LL;
                    if (k == 13 || i < 0 || j < 0 || l < 0 || i >= n[0] || j >= n[1] || l >= n[2]) continue;
                    const float there = score(static_cast<std::uint32_t>(i), static_cast<std::uint32_t>(j),
                                              static_cast<std::uint32_t>(l));
                    top = k < 13 ? here > there : here >= there;
                }
                if (!top) continue;
                // The top of a parabola through three voxels, along each axis.
                Vec3 at(x, y, z);
                const std::array<std::uint32_t, 3> node{x, y, z};
                for (std::size_t a = 0; a < 3; ++a) {
                    if (node[a] == 0 || node[a] + 1 >= n[a]) continue;
                    auto low = node, high = node;
                    --low[a], ++high[a];
                    const auto l = static_cast<double>(score(low[0], low[1], low[2])),
                               h = static_cast<double>(score(high[0], high[1], high[2])),
                               bend = l + h - 2.0 * static_cast<double>(here);
                    if (bend < 0.0)
                        at[static_cast<Eigen::Index>(a)] += std::clamp(0.5 * (l - h) / bend, -0.5, 0.5);
                }
                SearchPeak peak{map_.map_.grid.origin_m + map_.map_.voxel_m * at, static_cast<double>(here)};
                const auto place = std::upper_bound(
                    found.begin(), found.end(), peak,
                    [](const SearchPeak& a, const SearchPeak& b) { return a.score > b.score; });
                found.insert(place, peak);
                if (found.size() > most) found.pop_back();
            }
    return found;
}

}  // namespace tact
