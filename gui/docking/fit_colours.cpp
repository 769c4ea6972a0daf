#include "gui/docking/fit_colours.hpp"

#include <algorithm>
#include <array>
#include <cmath>

namespace tact {
namespace {

// RdYlBu of ColorBrewer, five classes (C. Brewer, colorbrewer2.org).
constexpr std::array<Rgb8, 5> kScale{
    {{215, 25, 28}, {253, 174, 97}, {255, 255, 191}, {171, 217, 233}, {44, 123, 182}}};

}  // namespace

Rgb8 fit_colour(std::optional<double> correlation) {
    if (!correlation) return kUnknownFit;
    const double at =
        std::clamp((*correlation - kPoorFit) / (kGoodFit - kPoorFit), 0.0, 1.0) * (kScale.size() - 1);
    const auto low = std::min(static_cast<std::size_t>(at), kScale.size() - 2);
    const double part = at - static_cast<double>(low);
    Rgb8 out{};
    for (std::size_t c = 0; c < 3; ++c)
        out[c] =
            static_cast<std::uint8_t>(std::lround((1.0 - part) * kScale[low][c] + part * kScale[low + 1][c]));
    return out;
}

std::vector<Rgb8> fit_colours(std::size_t atoms, std::span<const ResidueFit> residues) {
    std::vector<Rgb8> colours(atoms, kUnknownFit);
    for (const ResidueFit& r : residues)
        for (std::size_t i = r.first_atom; i < std::min(r.first_atom + r.atoms, atoms); ++i)
            colours[i] = fit_colour(r.correlation);
    return colours;
}

}  // namespace tact
