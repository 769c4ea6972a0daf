#include "tests/reproduce/law_pairs.hpp"

#include <cmath>
#include <functional>
#include <limits>

#include "tests/reproduce/text.hpp"

namespace tact::launch {
namespace {

struct Column {
    const char* name;
    int decimals;
    std::function<double(const Run&)> value;
    const char* note;
};

std::vector<Column> columns() {
    return {{"mean rate, % of the goal", 2,
             [](const Run& r) { return 100.0 * r.loaded.rate_mean_hz / r.goal_hz; }, ""},
            {"worst undisturbed 0.1 s, % of the goal", 1,
             [](const Run& r) {
                 const double hz = r.worst_loaded.quiet_rate_hz;  // 0: no such window
                 return hz > 0.0 ? 100.0 * hz / r.goal_hz : std::numeric_limits<double>::quiet_NaN();
             },
             "pairs with such windows in both runs"},
            {"worst 0.1 s of all, % of the goal", 1,
             [](const Run& r) { return 100.0 * r.worst_loaded.rate_hz / r.goal_hz; }, ""},
            {"vertices", 0, [](const Run& r) { return r.loaded.vertices_mean; }, ""},
            {"triangles of the structure, % of full detail", 1,
             [](const Run& r) { return 100.0 * r.loaded.structures_mean; }, ""},
            {"pixels, % of full detail", 1, [](const Run& r) { return 100.0 * r.loaded.pixels_mean; }, ""},
            {"hunting: deviation of the vertices", 0, [](const Run& r) { return r.loaded.vertices_sd; }, ""},
            {"hunting: changes of the level", 1,
             [](const Run& r) { return static_cast<double>(r.loaded.level_changes); }, ""},
            {"recomputed part of the work, %", 2,
             [](const Run& r) { return 100.0 * r.loaded.recomputed_fraction_mean; }, ""}};
}

}  // namespace

PairedMean paired_mean(const std::vector<std::pair<double, double>>& pairs) {
    PairedMean m;
    const auto n = static_cast<double>(pairs.size());
    for (const auto& [a, b] : pairs) {
        m.first += a / n;
        m.second += b / n;
    }
    m.difference = m.first - m.second;
    if (pairs.size() < 2) return m;
    double square = 0.0;
    for (const auto& [a, b] : pairs) square += (a - b - m.difference) * (a - b - m.difference);
    m.difference_error = std::sqrt(square / (n - 1.0) / n);
    return m;
}

std::vector<SummaryRow> summary_of(const std::vector<LawPair>& pairs) {
    std::vector<SummaryRow> rows;
    if (pairs.size() < 2) return rows;
    for (const Column& c : columns()) {
        std::vector<std::pair<double, double>> values;
        for (const LawPair& p : pairs)
            if (std::isfinite(c.value(p.own) + c.value(p.published)))
                values.emplace_back(c.value(p.own), c.value(p.published));
        if (values.size() < 2) {
            rows.push_back({"8", c.name, "not published", "fewer than two pairs have it", c.note});
            continue;
        }
        const PairedMean m = paired_mean(values);
        rows.push_back(
            {"8", c.name, "not published",
             text("%s %.*f, %s %.*f: difference %+.*f +- %.*f in %zu pairs", pairs.front().own.law.c_str(),
                  c.decimals, m.first, pairs.front().published.law.c_str(), c.decimals, m.second, c.decimals,
                  m.difference, c.decimals, m.difference_error, values.size()),
             c.note});
    }
    return rows;
}

}  // namespace tact::launch
