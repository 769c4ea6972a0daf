// Plots over time: force rate, lateness, the governor's levels with the reason of each change, and frame load.
#include <algorithm>
#include <array>

#include "gui/dashboard/panels.hpp"
#include "gui/dashboard/plot.hpp"
#include "gui/dashboard/widgets.hpp"
#include "ipc/topics/level_text.hpp"

namespace tact {
namespace {

constexpr std::array<ImU32, 4> kPathColours{colour::kAccent, colour::kOrange, colour::kGreen, colour::kPink};
constexpr std::array<const char*, kSpans_s.size()> kSpanNames{"1 min", "10 min", "1 h", "6 h", "24 h"};
constexpr std::array<const char*, 3> kLatenessViews{"last minute", "whole run", "over time"};
constexpr std::array<const char*, 3> kLatenessShort{"minute", "run", "trend"};

float choice_width(const Theme& theme, std::span<const char* const> words) {
    float wide = 0.0F;
    for (const char* const word : words) wide += ImGui::CalcTextSize(word).x + theme.px(10.0F);
    return wide;
}

// The part after the dot distinguishes the paths: "mesh", "force".
std::string path_name(const PathLevel& p) {
    const std::string whole(p.path, std::find(p.path, p.path + kPathNameMax, '\0'));
    const std::size_t dot = whole.find('.');
    return dot == std::string::npos ? whole : whole.substr(dot + 1);
}

void lateness_over_time(const Theme& theme, const History& h, PlotSpec spec, ImVec2 size) {
    const PlotLine late[] = {{&h.lateness_p50_s, colour::kGood, "p50"},
                             {&h.lateness_p99_s, colour::kWatch, "p99"},
                             {&h.lateness_max_s, colour::kBad, "max"},
                             {&h.cycle_cost_s, colour::kAccent, "work"}};
    spec.title = "Lateness and work";
    spec.unit = "µs";
    spec.scale = 1e6;
    spec.lines = late;
    spec.logarithmic = true;
    draw_plot(theme, spec, size);
}

void levels(const Theme& theme, const DashboardState& state, PlotSpec spec, ImVec2 size) {
    const History& h = state.history;
    std::array<PlotLine, kPathColours.size()> level{};
    std::array<std::string, kPathColours.size()> name, words;
    const std::size_t paths = state.have_levels ? std::min<std::size_t>(state.levels.count, level.size()) : 0;
    for (std::size_t i = 0; i < paths; ++i) {
        const PathLevel& p = state.levels.path[i];
        name[i] = path_name(p);
        level[i] = {&h.level[i], kPathColours[i], name[i].c_str()};
        words[i] =
            name[i] + format(" %.2f ", static_cast<double>(p.level)) + level_status_text(p, state.now_ns);
    }
    spec.title = "Detail levels";
    spec.unit = "0-1";
    spec.lines = std::span(level).first(paths);
    spec.text = std::span<const std::string>(words).first(paths);
    spec.fixed_top = 1.0;
    spec.steps = true;
    const PlotHover hover = draw_plot(theme, spec, size);
    if (!hover.inside) return;
    std::string text = ago_text(std::max(spec.now_s - hover.t_s, 0.0));
    for (std::size_t i = 0; i < paths; ++i) {
        text += "\n" + name[i] + ": ";
        if (const KnobChange* const c = h.knobs.in_force(i, hover.t_s); c != nullptr) {
            text += knob_change_text(*c) + ", " + ago_text(std::max(spec.now_s - c->end_s, 0.0));
        } else {
            text += h.knobs.forgotten() > 0 ? "change no longer listed" : "since start";
        }
    }
    if (h.knobs.forgotten() > 0)
        text += format("\n%s older changes are not listed", grouped(h.knobs.forgotten()).c_str());
    ImGui::SetTooltip("%s", text.c_str());
}

}  // namespace

void draw_plots(const Theme& theme, DashboardState& state, const PixelRect& card) {
    begin_card(theme, "Over time", card);
    ImGui::SameLine(0.0F, theme.px(16.0F));
    static constexpr std::array<const char*, 2> kStrips{"Load and detail", "Traces"};
    choose(theme, kStrips, state.strip);
    if (state.strip == 1) {
        draw_traces(theme, state);
        return end_card();
    }
    ImGui::PushFont(theme.small);
    same_line_if_fits(theme.px(18.0F), choice_width(theme, kSpanNames));
    choose(theme, kSpanNames, state.span_choice);
    const History& h = state.history;
    const ImVec2 inside = ImGui::GetContentRegionAvail();
    const float gap = theme.px(12.0F);
    // A wide window shows both lateness views.
    const bool wide = inside.x > theme.px(900.0F);
    if (!wide) state.lateness_choice = std::clamp(state.lateness_choice, 0, 2);
    if (wide && state.lateness_choice == 2) state.lateness_choice = 0;
    const bool roomy = inside.x > theme.px(620.0F);
    const auto views = std::span(roomy ? kLatenessViews : kLatenessShort).first(wide ? 2 : 3);
    const float label = roomy ? ImGui::CalcTextSize("lateness:").x + theme.px(6.0F) : 0.0F;
    if (same_line_if_fits(theme.px(20.0F), label + choice_width(theme, views))) {
        if (roomy) {
            text_coloured(colour::kDim, "lateness:");
            ImGui::SameLine(0.0F, theme.px(6.0F));
        }
        choose(theme, views, state.lateness_choice);
    }
    ImGui::PopFont();
    const ImVec2 room = ImGui::GetContentRegionAvail();
    // A narrow window omits values that the controller card shows.
    const bool narrow = inside.x < theme.px(500.0F);
    const float shares = narrow ? 2.8F : wide ? 5.8F : 4.8F, gaps = narrow ? 1.0F : wide ? 4.0F : 3.0F;
    const float unit = (room.x - gaps * gap) / shares;
    const auto sized = [&](float share) { return ImVec2{std::floor(share * unit), room.y}; };

    PlotSpec spec{};
    spec.now_s = h.now_s;
    spec.span_s = kSpans_s[static_cast<std::size_t>(std::clamp(state.span_choice, 0, 4))];
    PlotSpec rate_spec = spec;
    const PlotLine rate[] = {{&h.rate_hz, colour::kGood, "rate"}};
    rate_spec.title = "Force rate";
    rate_spec.unit = "kHz";
    rate_spec.scale = 1e-3;
    rate_spec.lines = rate;
    rate_spec.goal = 1e-3 * (state.have_levels   ? state.levels.goal_hz
                             : state.have_health ? state.health.goal_hz
                                                 : 0.0);
    if (!narrow) {
        draw_plot(theme, rate_spec, sized(1.0F));
        ImGui::SameLine(0.0F, gap);
    }
    if (wide || state.lateness_choice == 2) {
        lateness_over_time(theme, h, spec, sized(wide ? 1.0F : 1.2F));
        ImGui::SameLine(0.0F, gap);
    }
    if (wide || state.lateness_choice != 2) {
        draw_lateness(theme, state, sized(1.2F), state.lateness_choice == 1);
        ImGui::SameLine(0.0F, gap);
    }
    levels(theme, state, spec, sized(1.6F));
    if (narrow) return end_card();
    ImGui::SameLine(0.0F, gap);

    const PlotLine frame[] = {{&h.frame_s, colour::kAccent, "frame"}, {&h.busy_s, colour::kPink, "busy"}};
    spec.title = "Display";
    spec.unit = "ms";
    spec.scale = 1e3;
    spec.lines = frame;
    spec.least_top = 20.0;
    const double goal_hz = state.have_levels ? static_cast<double>(state.levels.display_goal_hz) : 0.0;
    spec.goal = goal_hz > 0.0 ? 1e3 / goal_hz : 0.0;
    draw_plot(theme, spec, sized(1.0F));
    end_card();
}

}  // namespace tact
