#include "deploy/tact/drilling/report_drilling.hpp"

#include <array>
#include <cstdio>
#include <fstream>
#include <nlohmann/json.hpp>
#include <numbers>

#include "deploy/tact/observer.hpp"

namespace tact::launch {

using nlohmann::json;

namespace {

json tool_json(const DrillTopic& drill, const DrillHand& hand) {
    if (hand.kind == DrillKind::none) return nullptr;
    const auto mm = [](float m) { return 1e3 * static_cast<double>(m); };
    json j = {{"diameter_mm", 2.0 * mm(hand.radius_m)}};
    if (hand.kind == DrillKind::suction_tube) {
        j["suction_l_min"] = 6e4 * static_cast<double>(drill.suction_m3_s_most);
        return j;
    }
    static constexpr std::array kShapes{"sphere", "cylinder", "cone"};
    const auto shape = static_cast<std::size_t>(hand.shape);
    j["shape"] = shape < kShapes.size() ? json(kShapes[shape]) : json(nullptr);
    j["grit"] = hand.grit == DrillGrit::diamond ? "diamond" : "cutting";
    j["length_mm"] = mm(hand.length_m);
    j["shaft_diameter_mm"] = 2.0 * mm(hand.shaft_radius_m);
    j["rpm"] = static_cast<double>(drill.burr_rad_s_most) * 60.0 / (2.0 * std::numbers::pi);
    j["irrigation_ml_min"] = 6e7 * static_cast<double>(drill.irrigation_m3_s_most);
    return j;
}

double number(const json& j, const char* key) {
    return j.is_object() && j.contains(key) && j[key].is_number() ? j[key].get<double>() : 0.0;
}

std::string word(const json& j, const char* key) {
    return j.is_object() && j.contains(key) && j[key].is_string() ? j[key].get<std::string>() : std::string();
}

json part(const json& j, const char* key) {
    return j.is_object() && j.contains(key) ? j[key] : json(nullptr);
}

template <class... T>
std::string line(const char* format, T... values) {
    std::array<char, 512> text{};
    std::snprintf(text.data(), text.size(), format, values...);
    return text.data();
}

std::string critical_lines(const json& trainee) {
    const json near = part(trainee, "near_critical"), structures = part(trainee, "structures");
    if (!near.is_object() || !structures.is_array())
        return "no critical structure is labelled: distances and injuries are unknown\n";
    std::string text = line(
        "near critical structures: within 2 mm %.1f s and %.2f mm3, within 1 mm %.1f s and %.2f mm3; "
        "injuries "
        "%.0f\n",
        number(near, "drilling_within_2_mm_s"), number(near, "removed_within_2_mm_mm3"),
        number(near, "drilling_within_1_mm_s"), number(near, "removed_within_1_mm_mm3"),
        number(trainee, "injuries"));
    for (const json& s : structures) {
        if (!part(s, "nearest_mm").is_number() || !part(s, "name").is_string()) continue;
        const std::string name = s["name"].get<std::string>();
        const double taken = number(s, "removed_mm3"), nearest = number(s, "nearest_mm");
        if (nearest > 2.0 && taken <= 0.0) continue;
        text += line("  %s: %s %.1f mm, removed %.2f mm3, injuries %.0f\n", name.c_str(),
                     nearest < 0.0 ? "burr inside by" : "nearest", nearest < 0.0 ? -nearest : nearest, taken,
                     number(s, "injuries"));
    }
    return text;
}

std::string performance(const json& drilling) {
    const json trainee = part(drilling, "trainee");
    if (!trainee.is_object()) return line("bone removed: %.1f mm3\n", number(drilling, "removed_mm3"));
    const json force = part(trainee, "force"), strokes = part(trainee, "strokes");
    std::string text =
        line("bone removed: %.1f mm3; drilling %.1f s, of which cutting %.1f s\n",
             number(drilling, "removed_mm3"), number(trainee, "drilling_s"), number(trainee, "cutting_s"));
    text += line("force while cutting: mean %.2f N, maximum %.2f N; above %.1f N for %.1f s\n",
                 number(force, "mean_cutting_n"), number(force, "max_n"), number(force, "excess_above_n"),
                 number(force, "excess_s"));
    text += line("strokes: %.0f, mean length %.1f mm, mean speed %.1f mm/s\n", number(strokes, "count"),
                 number(strokes, "mean_length_mm"), number(strokes, "mean_speed_mm_s"));
    const json burrs = part(trainee, "burrs");
    if (burrs.is_array() && burrs.size() > 1)
        for (const json& b : burrs)
            text += line("  %.1f mm %s %s: drilling %.1f s, %.1f mm3\n", number(b, "diameter_mm"),
                         word(b, "grit").c_str(), word(b, "shape").c_str(), number(b, "drilling_s"),
                         number(b, "removed_mm3"));
    if (part(trainee, "burr_visible_share").is_number())
        text += line("burr visible for %.0f %% of the time in which it turned in bone\n",
                     100.0 * number(trainee, "burr_visible_share"));
    return text + critical_lines(trainee);
}

}  // namespace

json drilling_report(const RtRegion& region, const std::filesystem::path& trainee) {
    const auto drill = newest(region.drill);
    if (!drill) return nullptr;
    json j = {{"removed_mm3", 1e9 * drill->level_m3 * static_cast<double>(drill->removed_levels)},
              {"removed_levels", drill->removed_levels},
              {"burr", tool_json(*drill, drill->hand[0])},
              {"suction_tube", tool_json(*drill, drill->hand[1])}};
    std::ifstream in(trainee, std::ios::binary);
    const json told = json::parse(in, nullptr, false);
    j["trainee"] = told.is_object() ? told : json(nullptr);
    return j;
}

std::string drilling_summary(const json& drilling) {
    if (!drilling.is_object()) return {};
    const json kept = part(drilling, "kept_in"), training = part(part(drilling, "trainee"), "training");
    const json page = part(training, "report");
    const std::string points = page.is_string()
                                   ? line("training: %.0f of 100 points\n", number(training, "points")) +
                                         "  report: " + page.get<std::string>() + "\n"
                                   : std::string();
    return performance(drilling) + points +
           (kept.is_string() ? "the bone is kept in " + kept.get<std::string>() +
                                   "\n  continue with it: --resume " + kept.get<std::string>() + "\n"
                             : std::string());
}

}  // namespace tact::launch
