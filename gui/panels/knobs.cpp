// Knobs: rate, lateness, the governor's levels and the loads over time.
#include <algorithm>
#include <array>

#include "gui/panels/panels.hpp"
#include "gui/panels/plot.hpp"
#include "gui/panels/widgets.hpp"

namespace tact {
namespace {

constexpr std::array<ImU32, 4> kPathColours{colour::kAccent, colour::kOrange, colour::kGreen, colour::kPink};

void span_choice(const Theme& theme, DashboardState& state) {
    static constexpr std::array<const char*, kSpans_s.size()> kNames{"1 min", "10 min", "1 h", "6 h", "24 h"};
    ImGui::PushFont(theme.small);
    choose(theme, kNames, state.span_choice);
    ImGui::PopFont();
}

}  // namespace

void draw_plots(const Theme& theme, DashboardState& state, const PixelRect& card) {
    begin_card(theme, "Load and knobs", card);
    ImGui::SameLine(0.0F, theme.px(16.0F));
    span_choice(theme, state);
    const History& h = state.history;
    const double span = kSpans_s[static_cast<std::size_t>(std::clamp(state.span_choice, 0, 4))];
    const ImVec2 room = ImGui::GetContentRegionAvail();
    const float gap = theme.px(12.0F);
    const ImVec2 each{std::floor((room.x - 3.0F * gap) / 4.0F), room.y};

    PlotSpec spec{};
    spec.now_s = h.now_s;
    spec.span_s = span;
    const PlotLine rate[] = {{&h.rate_hz, colour::kGood, "rate"}};
    spec.title = "Force rate";
    spec.unit = "kHz";
    spec.scale = 1e-3;
    spec.lines = rate;
    spec.goal = 1e-3 * (state.have_levels   ? state.levels.goal_hz
                        : state.have_health ? state.health.goal_hz
                                            : 0.0);
    draw_plot(theme, spec, each);
    ImGui::SameLine(0.0F, gap);

    const PlotLine late[] = {{&h.lateness_p50_s, colour::kGood, "p50"},
                             {&h.lateness_p99_s, colour::kWatch, "p99"},
                             {&h.lateness_max_s, colour::kBad, "max"},
                             {&h.cycle_cost_s, colour::kAccent, "work"}};
    spec.title = "Lateness and work";
    spec.unit = "µs";
    spec.scale = 1e6;
    spec.lines = late;
    spec.goal = 0.0;
    spec.logarithmic = true;
    draw_plot(theme, spec, each);
    ImGui::SameLine(0.0F, gap);

    std::array<PlotLine, kPathsMax> level{};
    std::array<std::array<char, kPathNameMax>, kPathsMax> name{};
    const std::size_t paths =
        state.have_levels ? std::min<std::size_t>(state.levels.count, kPathColours.size()) : 0;
    for (std::size_t i = 0; i < paths; ++i) {
        std::copy_n(state.levels.path[i].path, kPathNameMax - 1, name[i].begin());
        // The part behind the dot tells them apart: "mesh", "force".
        const auto dot = std::find(name[i].begin(), name[i].end(), '.');
        const char* const tail = dot != name[i].end() ? &*dot + 1 : name[i].data();
        level[i] = {&h.level[i], kPathColours[i], tail};
    }
    spec.title = "Levels";
    spec.unit = "of 1";
    spec.scale = 1.0;
    spec.lines = std::span(level).first(paths);
    spec.logarithmic = false;
    spec.fixed_top = 1.0;
    draw_plot(theme, spec, each);
    ImGui::SameLine(0.0F, gap);

    const PlotLine frame[] = {{&h.frame_s, colour::kAccent, "frame"}, {&h.busy_s, colour::kPink, "busy"}};
    spec.title = "Picture";
    spec.unit = "ms";
    spec.scale = 1e3;
    spec.lines = frame;
    spec.fixed_top = 0.0;
    spec.least_top = 20.0;
    const double goal_hz = state.have_levels ? static_cast<double>(state.levels.picture_goal_hz) : 0.0;
    spec.goal = goal_hz > 0.0 ? 1e3 / goal_hz : 0.0;
    draw_plot(theme, spec, each);
    end_card();
}

}  // namespace tact
