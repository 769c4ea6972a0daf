// Traces panel: every servo cycle of the last minute, as on an oscilloscope. Controls are here; trace_lanes.cpp
// draws. Every control has one place in all modes, so that no click meets another one: what only some modes have comes
// last in its row.
#include "gui/dashboard/traces.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "gui/dashboard/panels.hpp"
#include "gui/dashboard/widgets.hpp"

namespace tact {
namespace {

constexpr std::array<double, 13> kTraceSpans_s{0.01, 0.02, 0.05, 0.1,  0.2,  0.5, 1.0,
                                               2.0,  5.0,  10.0, 20.0, 30.0, 60.0};

void run_row(const Theme& theme, TracesState& t) {
    TraceScope& scope = t.scope;
    if (ImGui::Button(scope.held() ? "Run" : "Pause", {theme.px(58.0F), 0.0F})) {
        if (scope.held()) {
            scope.go_on();
        } else {
            scope.hold();
        }
    }
    ImGui::SameLine();
    static constexpr std::array<const char*, 4> kRuns{"roll", "auto", "normal", "single"};
    int run = static_cast<int>(scope.run());
    const int before = run;
    ImGui::AlignTextToFramePadding();
    choose(theme, kRuns, run);
    if (run != before) scope.choose_run(static_cast<TraceRun>(run));
    same_line_if_fits(ImGui::GetStyle().ItemSpacing.x, theme.px(84.0F));
    ImGui::SetNextItemWidth(theme.px(84.0F));
    if (ImGui::BeginCombo("##span", duration_text(scope.span_s()).c_str())) {
        for (const double s : kTraceSpans_s)
            if (ImGui::Selectable(duration_text(s).c_str(), s == scope.span_s())) scope.set_span(s);
        ImGui::EndCombo();
    }
    same_line_if_fits(ImGui::GetStyle().ItemSpacing.x, theme.px(92.0F));
    ImGui::SetNextItemWidth(theme.px(92.0F));
    if (ImGui::BeginCombo("##channels", "Channels")) {
        for (std::size_t i = 0; i < kTraceChannels; ++i) {
            const TraceChannelInfo& info = trace_channel(static_cast<TraceChannel>(i));
            bool on = t.channels.test(i);
            if (ImGui::Checkbox(format("%s [%s]", info.name, info.unit).c_str(), &on)) t.channels.set(i, on);
        }
        ImGui::EndCombo();
    }
    same_line_if_fits(ImGui::GetStyle().ItemSpacing.x, theme.px(84.0F));
    ImGui::Checkbox("Cursors", &scope.cursors);
    same_line_if_fits(ImGui::GetStyle().ItemSpacing.x, theme.px(62.0F));
    ImGui::BeginDisabled(scope.shown().empty() || t.channels.none());
    if (ImGui::Button("Export")) t.export_wanted = true;
    ImGui::EndDisabled();
    if (scope.run() == TraceRun::single) {
        same_line_if_fits(ImGui::GetStyle().ItemSpacing.x, theme.px(96.0F));
        if (ImGui::Button("Arm trigger")) scope.choose_run(TraceRun::single);
    }
}

void trigger_row(const Theme& theme, TraceScope& scope) {
    ImGui::BeginDisabled(scope.run() == TraceRun::roll);
    TriggerSettings s = scope.trigger();
    bool changed = false;
    text_coloured(colour::kDim, "trigger on");
    same_line_if_fits(ImGui::GetStyle().ItemSpacing.x, theme.px(100.0F));
    ImGui::SetNextItemWidth(theme.px(100.0F));
    const char* const source = s.source == TriggerSource::overrun ? "an overrun"
                               : s.source == TriggerSource::fault ? "a fault"
                                                                  : trace_channel(s.channel).name;
    if (ImGui::BeginCombo("##source", source)) {
        const auto other = [&](const char* name, TriggerSource which) {
            if (ImGui::Selectable(name, s.source == which)) s.source = which, changed = true;
        };
        other("an overrun", TriggerSource::overrun);
        other("a fault", TriggerSource::fault);
        for (std::size_t i = 0; i < kTraceChannels; ++i) {
            const auto c = static_cast<TraceChannel>(i);
            if (!ImGui::Selectable(trace_channel(c).name,
                                   s.source == TriggerSource::channel && s.channel == c))
                continue;
            s.source = TriggerSource::channel;
            s.channel = c;
            changed = true;
        }
        ImGui::EndCombo();
    }
    same_line_if_fits(ImGui::GetStyle().ItemSpacing.x, theme.px(92.0F));
    ImGui::SetNextItemWidth(theme.px(92.0F));
    auto before = static_cast<float>(100.0 * s.pre_share);
    if (ImGui::SliderFloat("##before", &before, 0.0F, 100.0F, "%.0f %% before")) {
        s.pre_share = 0.01 * static_cast<double>(before);
        changed = true;
    }
    if (s.source == TriggerSource::channel) {
        const TraceChannelInfo& info = trace_channel(s.channel);
        same_line_if_fits(ImGui::GetStyle().ItemSpacing.x, theme.px(58.0F));
        if (ImGui::Button(s.rising ? "rising" : "falling", {theme.px(58.0F), 0.0F}))
            s.rising = !s.rising, changed = true;
        same_line_if_fits(ImGui::GetStyle().ItemSpacing.x, theme.px(64.0F));
        ImGui::SetNextItemWidth(theme.px(64.0F));
        double level = s.level * info.scale;
        ImGui::InputDouble("##level", &level, 0.0, 0.0, "%.4g");
        if (ImGui::IsItemDeactivatedAfterEdit() && std::isfinite(level))
            s.level = level / info.scale, changed = true;
        ImGui::SameLine(0.0F, theme.px(4.0F));
        text_coloured(colour::kDim, info.unit);
    }
    ImGui::EndDisabled();
    if (changed) scope.set_trigger(s);
}

void message_row(const Theme& theme, const TracesState& t) {
    const TraceScope& scope = t.scope;
    const bool good = !scope.held() && (scope.run() == TraceRun::roll || scope.captures() > 0);
    text_small(theme, good ? colour::kGood : colour::kWatch, scope.status(), false);
    const auto next = [&](ImU32 c, const std::string& text) {
        same_line_if_fits(theme.px(12.0F),
                          theme.small->CalcTextSizeA(theme.small->FontSize, 1e9F, 0.0F, text.c_str()).x);
        text_small(theme, c, text, false);
    };
    const TraceStore& shown = scope.shown();
    if (!shown.empty())
        next(colour::kDim,
             format("%s kept",
                    duration_text(1e-9 * static_cast<double>(shown.end_ns() - shown.begin_ns())).c_str()));
    if (scope.captures() > 1) next(colour::kDim, format("%s captures", grouped(scope.captures()).c_str()));
    if (scope.missed() + scope.refused() > 0)
        next(colour::kWatch, format("%s cycles missed", grouped(scope.missed() + scope.refused()).c_str()));
    if (scope.cursors && !shown.empty()) {
        const double dt_s = 1e-9 * static_cast<double>(scope.cursor_ns(1) - scope.cursor_ns(0));
        next(colour::kText,
             "B - A: " + duration_text(dt_s) +
                 (dt_s != 0.0 ? ", " + format("%.4g Hz", 1.0 / std::fabs(dt_s)) : std::string()));
    }
    if (!t.message.empty()) next(grade_colour(t.message_grade), t.message);
}

}  // namespace

void draw_traces(const Theme& theme, DashboardState& state) {
    TracesState& t = state.traces;
    run_row(theme, t);
    trigger_row(theme, t.scope);
    message_row(theme, t);
    draw_trace_lanes(theme, state, ImGui::GetContentRegionAvail());
}

}  // namespace tact
