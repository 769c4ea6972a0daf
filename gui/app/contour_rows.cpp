#include "gui/app/contour_rows.hpp"

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

void begin_contours(const Contours& contours, const ContourScale& scale, ContourFacts& facts) {
    facts = ContourFacts{};
    facts.rows_max = kContoursMax;
    facts.least = scale.least();
    facts.greatest = scale.greatest();
    if (scale.voxels() > 0) facts.histogram = scale.histogram(kBinsShown);
    for (const Contour& c : contours.contours()) facts.row.push_back(row_of(c));
}

void follow_contours(Contours& contours, const ContourScale& scale, ContourFacts& facts) {
    if (facts.add && facts.row.size() < facts.rows_max) {
        Contour next;
        // Halfway up from the highest: inside of what is shown.
        double highest = facts.row.empty() ? facts.least : facts.row.front().level;
        for (const ContourRow& r : facts.row) highest = std::max(highest, r.level);
        next.level = 0.5 * (highest + facts.greatest);
        next.colour = contour_colour(facts.row.size());
        facts.row.push_back(row_of(next));
        facts.changed = true;
    }
    facts.add = false;
    if (facts.changed) {
        std::vector<Contour> wanted;
        std::transform(facts.row.begin(), facts.row.end(), std::back_inserter(wanted), contour_of);
        contours.set(wanted);
        facts.changed = false;
    }
    for (std::size_t i = 0; i < facts.row.size(); ++i) {
        ContourRow& row = facts.row[i];
        const ContourState state = contours.state(i);
        row.sigma = scale.sigma_of(row.level);
        row.fraction_inside = scale.fraction_inside(row.level);
        row.final = state.final;
        row.error = state.error;
    }
}

void nudge_contour(ContourFacts& facts, const ContourScale& scale, double tenths) {
    if (facts.row.empty()) return;
    const double sigma = scale.level_of_sigma(1.0) - scale.level_of_sigma(0.0);
    facts.row[0].level = std::clamp(facts.row[0].level + 0.1 * tenths * sigma, facts.least, facts.greatest);
    facts.changed = true;
}

}  // namespace tact
