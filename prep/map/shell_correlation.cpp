#include "prep/map/shell_correlation.hpp"

#include <algorithm>
#include <cmath>
#include <complex>
#include <numbers>
#include <random>

#include "ipc/base/error.hpp"
#include "prep/map/fft_volume.hpp"
#include "prep/map/map_mask.hpp"

namespace tact {
namespace {

constexpr double kRandomBelow = 0.8;  // of the unmasked curve: beyond this shell phases are replaced
constexpr unsigned kRandomSeed = 143;

// Which shell each wave of the half-complex transform belongs to.
class Shells {
public:
    explicit Shells(const DensityGrid& grid) : size_(grid.size) {
        double longest_m = 0.0;
        for (int a = 0; a < 3; ++a)
            longest_m = std::max(longest_m, grid.spacing_m[a] * size_[static_cast<std::size_t>(a)]);
        step_per_m_ = 1.0 / longest_m;
        const double nyquist_per_m = 0.5 / grid.spacing_m.maxCoeff();
        // A shell that reaches beyond the Nyquist frequency would hold only the corners of the box.
        count_ = static_cast<std::size_t>(std::floor(nyquist_per_m / step_per_m_ - 0.5)) + 1;
        for (int a = 0; a < 3; ++a) {
            const auto i = static_cast<std::size_t>(a);
            axis_per_m_[i].resize(size_[i]);
            for (std::uint32_t k = 0; k < size_[i]; ++k) {
                const double wave = k <= size_[i] / 2 ? k : static_cast<double>(k) - size_[i];
                axis_per_m_[i][k] = wave / (size_[i] * grid.spacing_m[a]);
            }
        }
    }

    [[nodiscard]] std::size_t count() const { return count_; }
    [[nodiscard]] double frequency_per_m(std::size_t shell) const {
        return step_per_m_ * static_cast<double>(shell);
    }

    // visit(index of the wave, shell, how many waves it stands for).
    template <class Visit>
    void each(Visit&& visit) const {
        std::size_t at = 0;
        for (std::uint32_t z = 0; z < size_[2]; ++z)
            for (std::uint32_t y = 0; y < size_[1]; ++y)
                for (std::uint32_t x = 0; x <= size_[0] / 2; ++x, ++at) {
                    const double square = axis_per_m_[0][x] * axis_per_m_[0][x] +
                                          axis_per_m_[1][y] * axis_per_m_[1][y] +
                                          axis_per_m_[2][z] * axis_per_m_[2][z];
                    const auto shell = static_cast<std::size_t>(std::lround(std::sqrt(square) / step_per_m_));
                    const bool own_mirror = x == 0 || 2 * x == size_[0];
                    if (shell < count_) visit(at, shell, own_mirror ? 1 : 2);
                }
    }

private:
    std::array<std::uint32_t, 3> size_;
    std::array<std::vector<double>, 3> axis_per_m_;
    double step_per_m_ = 0.0;
    std::size_t count_ = 0;
};

using Waves = FftBuffer<std::complex<float>>;

class HalfMap {
public:
    HalfMap(const DensityGrid& grid, const FftVolume& fft)
        : fft_(fft), values_(fft.voxels()), waves_(fft.waves()) {
        const std::span<float> to = values_.all();
        double mean = 0.0;
        for (const float v : grid.values) mean += static_cast<double>(v) / static_cast<double>(to.size());
        for (std::size_t i = 0; i < to.size(); ++i)
            to[i] = static_cast<float>(static_cast<double>(grid.values[i]) - mean);
        fft_.forward(values_, waves_);
    }
    [[nodiscard]] const Waves& waves() const { return waves_; }

    // The same amplitudes with random phases beyond a shell.
    void scramble(const Shells& shells, std::size_t from, std::mt19937_64& random) {
        std::uniform_real_distribution<float> phase(0.0F, 2.0F * std::numbers::pi_v<float>);
        shells.each([&](std::size_t at, std::size_t shell, int) {
            if (shell >= from) waves_.data()[at] = std::polar(std::abs(waves_.data()[at]), phase(random));
        });
    }
    void mask(const DensityGrid& mask) {
        fft_.backward(waves_, values_);
        const std::span<float> v = values_.all();
        for (std::size_t i = 0; i < v.size(); ++i) v[i] *= mask.values[i] / static_cast<float>(v.size());
        fft_.forward(values_, waves_);
    }

private:
    const FftVolume& fft_;
    FftBuffer<float> values_;
    Waves waves_;
};

std::vector<Shell> curve(const Shells& shells, const HalfMap& a, const HalfMap& b) {
    std::vector<Shell> out(shells.count());
    std::vector<double> aa(out.size()), bb(out.size());
    shells.each([&](std::size_t at, std::size_t shell, int times) {
        const std::complex<double> p = a.waves().data()[at], q = b.waves().data()[at];
        out[shell].correlation += times * (p * std::conj(q)).real();
        aa[shell] += times * std::norm(p);
        bb[shell] += times * std::norm(q);
        out[shell].waves += static_cast<std::size_t>(times);
    });
    for (std::size_t i = 0; i < out.size(); ++i) {
        const double scale = std::sqrt(aa[i] * bb[i]);
        out[i].correlation = scale > 0.0 ? out[i].correlation / scale : 0.0;
        out[i].frequency_per_m = shells.frequency_per_m(i);
        out[i].waves /= 2;
    }
    return out;
}

bool constant(const DensityGrid& grid) {
    const auto [low, high] = std::minmax_element(grid.values.begin(), grid.values.end());
    return !(*high > *low);
}

// Where the curve first falls below the threshold, between two shells.
std::optional<double> crossing_m(const std::vector<Shell>& shells) {
    for (std::size_t i = 0; i < shells.size(); ++i) {
        if (shells[i].correlation >= kFscThreshold) continue;
        if (i == 0) return 1.0 / shells[0].frequency_per_m;
        const Shell &above = shells[i - 1], &below = shells[i];
        const double share = (above.correlation - kFscThreshold) / (above.correlation - below.correlation);
        return 1.0 / (above.frequency_per_m + share * (below.frequency_per_m - above.frequency_per_m));
    }
    return std::nullopt;
}

}  // namespace

ShellCorrelation shell_correlation(const DensityGrid& half_1, const DensityGrid& half_2,
                                   const DensityGrid* mask) {
    for (const DensityGrid* const other : {&half_2, mask})
        if (other != nullptr && !same_grid(half_1, *other))
            throw StartupError("compare two half-maps", "their boxes or voxels differ",
                               "give both halves, and the mask, as the same program wrote them");
    if (constant(half_1) || constant(half_2))
        throw StartupError("compare two half-maps", "one of them has the same value everywhere",
                           "check the files");
    const FftVolume fft(half_1.size);
    const Shells shells(half_1);
    if (shells.count() < 3)
        throw StartupError("compare two half-maps", "they have fewer than 6 voxels along an axis",
                           "give the half-maps of the whole box");
    HalfMap a(half_1, fft), b(half_2, fft);
    std::vector<Shell> found = curve(shells, a, b);
    if (mask != nullptr) {
        const auto from = static_cast<std::size_t>(
            std::find_if(found.begin() + 1, found.end(),
                         [](const Shell& s) { return s.correlation < kRandomBelow; }) -
            found.begin());
        HalfMap random_a(half_1, fft), random_b(half_2, fft);
        std::mt19937_64 random(kRandomSeed);
        random_a.scramble(shells, from, random);
        random_b.scramble(shells, from, random);
        for (HalfMap* const half : {&a, &b, &random_a, &random_b}) half->mask(*mask);
        found = curve(shells, a, b);
        const std::vector<Shell> by_mask = curve(shells, random_a, random_b);
        // The first shells that were replaced still leak into the kept ones (Chen et al. 2013: two shells apart).
        for (std::size_t i = from + 2; i < found.size(); ++i) {
            const double added = by_mask[i].correlation;
            found[i].correlation = added < 1.0 ? (found[i].correlation - added) / (1.0 - added) : 0.0;
        }
    }
    found.erase(found.begin());
    return {found, crossing_m(found), 2.0 * half_1.spacing_m.maxCoeff()};
}

}  // namespace tact
