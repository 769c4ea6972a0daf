#include "gui/docking/contour_rows.hpp"

#include <algorithm>

namespace tact {
namespace {

constexpr std::size_t kBinsShown = 128;

ContourRow row_of(const Contour& c) {
    ContourRow row;
    row.level = c.level;
    std::copy_n(c.colour.data(), 3, row.colour);
    row.opacity = c.opacity;
    row.style = c.style ? static_cast<int>(*c.style) + 1 : 0;
    row.shown = c.shown;
    return row;
}

Contour contour_of(const ContourRow& row) {
    Contour c;
    c.level = row.level;
    c.colour = Eigen::Vector3f(row.colour);
    c.opacity = row.opacity;
    if (row.style > 0) c.style = static_cast<SurfaceStyle>(row.style - 1);
    c.shown = row.shown;
    return c;
}

}  // namespace

void begin_contours(const Contours& contours, const ContourScale& scale, ContourRowState& state) {
    state = ContourRowState{};
    state.rows_max = kContoursMax;
    state.least = scale.least();
    state.greatest = scale.greatest();
    if (scale.voxels() > 0) state.histogram = scale.histogram(kBinsShown);
    for (const Contour& c : contours.contours()) state.row.push_back(row_of(c));
}

void follow_contours(Contours& contours, const ContourScale& scale, ContourRowState& state) {
    if (state.add && state.row.size() < state.rows_max) {
        Contour next;
        // Halfway between the highest level and the map's maximum: inside the surfaces shown.
        double highest = state.row.empty() ? state.least : state.row.front().level;
        for (const ContourRow& r : state.row) highest = std::max(highest, r.level);
        next.level = 0.5 * (highest + state.greatest);
        next.colour = contour_colour(state.row.size());
        state.row.push_back(row_of(next));
        state.changed = true;
    }
    state.add = false;
    if (state.changed) {
        std::vector<Contour> wanted;
        std::transform(state.row.begin(), state.row.end(), std::back_inserter(wanted), contour_of);
        contours.set(wanted);
        state.changed = false;
    }
    for (std::size_t i = 0; i < state.row.size(); ++i) {
        ContourRow& row = state.row[i];
        const ContourState shown = contours.state(i);
        row.sigma = scale.sigma_of(row.level);
        row.fraction_inside = scale.fraction_inside(row.level);
        row.final = shown.final;
        row.error = shown.error;
    }
}

void nudge_contour(ContourRowState& state, const ContourScale& scale, double tenths) {
    if (state.row.empty()) return;
    const double sigma = scale.level_of_sigma(1.0) - scale.level_of_sigma(0.0);
    double& level = state.row[state.chosen_row()].level;
    level = std::clamp(level + 0.1 * tenths * sigma, state.least, state.greatest);
    state.changed = true;
}

void choose_contour(ContourRowState& state, int rows_down) {
    const auto rows = static_cast<std::ptrdiff_t>(state.row.size());
    if (rows == 0) return;
    const auto at = static_cast<std::ptrdiff_t>(state.chosen_row()) + rows_down;
    state.chosen = static_cast<std::size_t>((at % rows + rows) % rows);
}

}  // namespace tact
