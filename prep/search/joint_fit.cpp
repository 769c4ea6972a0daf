#include "prep/search/joint_fit.hpp"

#include <algorithm>
#include <cmath>

namespace tact {
namespace {

constexpr std::size_t kBeam = 4000;

// A combination of the first structures.
struct Partial {
    std::vector<std::size_t> chosen;
    double with_map = 0.0, with_itself = 0.0;
    [[nodiscard]] double score() const { return with_itself > 0.0 ? with_map / std::sqrt(with_itself) : 0.0; }
};

}  // namespace

JointFit::JointFit(SearchMap map) : map_(std::move(map)) {
    for (const float v : map_.grid.values) size_2_ += static_cast<double>(v) * static_cast<double>(v);
}

PlacedField JointFit::field(const Structure& structure, const Pose& T_model_body) const {
    PlacedField f;
    const PlacedStructure placed{&structure, T_model_body};
    f.box = reached_box(map_.grid, {&placed, 1}, map_.resolution_m);
    f.value.assign(f.box.count(), 0.0F);
    if (f.value.empty()) return f;
    add_simulated(map_.grid, placed, map_.resolution_m, 1.0F, f.box, f.value);
    if (map_.laplacian) f.value = laplacian_of(f.value, f.box.size);
    std::size_t i = 0;
    for (std::uint32_t z = 0; z < f.box.size[2]; ++z)
        for (std::uint32_t y = 0; y < f.box.size[1]; ++y)
            for (std::uint32_t x = 0; x < f.box.size[0]; ++x, ++i) {
                const auto own = static_cast<double>(f.value[i]);
                f.with_map += own * static_cast<double>(map_.grid.at(f.box.first[0] + x, f.box.first[1] + y,
                                                                     f.box.first[2] + z));
                f.with_itself += own * own;
            }
    return f;
}

double JointFit::product(const PlacedField& a, const PlacedField& b) {
    std::array<std::uint32_t, 3> low{}, high{};
    for (std::size_t k = 0; k < 3; ++k) {
        low[k] = std::max(a.box.first[k], b.box.first[k]);
        high[k] = std::min(a.box.first[k] + a.box.size[k], b.box.first[k] + b.box.size[k]);
        if (high[k] <= low[k]) return 0.0;
    }
    const auto at = [](const PlacedField& f, std::uint32_t x, std::uint32_t y, std::uint32_t z) {
        return (std::size_t{z - f.box.first[2]} * f.box.size[1] + (y - f.box.first[1])) * f.box.size[0] +
               (x - f.box.first[0]);
    };
    double sum = 0.0;
    for (std::uint32_t z = low[2]; z < high[2]; ++z)
        for (std::uint32_t y = low[1]; y < high[1]; ++y) {
            const float* const from = &a.value[at(a, low[0], y, z)];
            const float* const with = &b.value[at(b, low[0], y, z)];
            for (std::uint32_t x = 0; x < high[0] - low[0]; ++x)
                sum += static_cast<double>(from[x]) * static_cast<double>(with[x]);
        }
    return sum;
}

double JointFit::correlation(std::span<const PlacedField> fields) const {
    double with_map = 0.0, with_itself = 0.0;
    for (std::size_t i = 0; i < fields.size(); ++i) {
        with_map += fields[i].with_map;
        with_itself += fields[i].with_itself;
        for (std::size_t j = 0; j < i; ++j) with_itself += 2.0 * product(fields[i], fields[j]);
    }
    return with_itself > 0.0 && size_2_ > 0.0 ? with_map / std::sqrt(with_itself * size_2_) : 0.0;
}

std::vector<std::size_t> JointFit::best(const std::vector<std::vector<PlacedField>>& choices) const {
    std::vector<Partial> beam{Partial{}};
    for (std::size_t s = 0; s < choices.size(); ++s) {
        // Products of each choice with all choices before.
        std::vector<std::vector<std::vector<double>>> with(choices[s].size());
        for (std::size_t c = 0; c < choices[s].size(); ++c)
            for (std::size_t before = 0; before < s; ++before) {
                auto& row = with[c].emplace_back();
                for (const PlacedField& other : choices[before]) row.push_back(product(choices[s][c], other));
            }
        std::vector<Partial> longer;
        for (const Partial& p : beam)
            for (std::size_t c = 0; c < choices[s].size(); ++c) {
                Partial next = p;
                next.with_map += choices[s][c].with_map;
                next.with_itself += choices[s][c].with_itself;
                for (std::size_t before = 0; before < s; ++before)
                    next.with_itself += 2.0 * with[c][before][p.chosen[before]];
                next.chosen.push_back(c);
                longer.push_back(std::move(next));
            }
        const std::size_t kept = std::min(longer.size(), kBeam);
        std::partial_sort(longer.begin(), longer.begin() + static_cast<std::ptrdiff_t>(kept), longer.end(),
                          [](const Partial& a, const Partial& b) {
                              return a.score() != b.score() ? a.score() > b.score() : a.chosen < b.chosen;
                          });
        longer.resize(kept);
        beam = std::move(longer);
    }
    return beam.front().chosen;
}

}  // namespace tact
