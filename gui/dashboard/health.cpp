// Health panel: state of the controller as numbers, text and colour, and the buttons needed first.
#include <algorithm>
#include <array>
#include <cmath>

#include "gui/dashboard/panels.hpp"
#include "gui/dashboard/widgets.hpp"
#include "ipc/topics/text.hpp"

namespace tact {
namespace {

// Bar of the rate, with a mark at the goal.
void rate_bar(const Theme& theme, const HealthTopic& h, ImU32 c) {
    const ImVec2 at = ImGui::GetCursorScreenPos();
    const float width = ImGui::GetContentRegionAvail().x, height = theme.px(5.0F);
    ImDrawList* const draw = ImGui::GetWindowDrawList();
    draw->AddRectFilled(at, {at.x + width, at.y + height}, colour::kGrid);
    if (h.goal_hz > 0.0 && std::isfinite(h.force_rate_hz)) {
        constexpr double kReach = 1.25;  // of the goal
        const double share = std::clamp(h.force_rate_hz / (kReach * h.goal_hz), 0.0, 1.0);
        draw->AddRectFilled(at, {at.x + static_cast<float>(share) * width, at.y + height}, c);
        const float goal = at.x + width / static_cast<float>(kReach);
        draw->AddRectFilled({goal - theme.px(1.0F), at.y - theme.px(2.0F)},
                            {goal + theme.px(1.0F), at.y + height + theme.px(2.0F)}, colour::kText);
    }
    ImGui::Dummy({width, height + theme.px(2.0F)});
}

// A device notice replaces the state's own text, because it is more specific.
void words(const Theme& theme, const HealthTopic& h, const StatusText& state) {
    bool message = false;
    for (const std::uint8_t code : h.device_notice) {
        const auto notice = static_cast<DeviceNotice>(code);
        if (notice == DeviceNotice::none) continue;
        message = true;
        ImGui::PushTextWrapPos(0.0F);
        text_small(theme, grade_colour(notice_grade(notice)), device_notice_text(notice));
        ImGui::PopTextWrapPos();
    }
    if (!message) text_small(theme, grade_colour(state.grade), state.text);
}

// At the right of the card's title: whether the run is recorded, and the button that does.
void recording(const Theme& theme, DashboardState& state) {
    const bool whole = state.recorders > 0;
    const char* const button = state.own_recording ? "Stop recording" : "Record";
    const std::string text = state.own_recording ? ""
                             : whole             ? "recording"
                             : state.flights > 0 ? "flight recorder on"
                                                 : "";
    ImGui::PushFont(theme.small);
    const float padding = theme.px(8.0F), gap = theme.px(8.0F), r = theme.px(4.0F);
    const float width = ImGui::CalcTextSize(button).x + padding, words = ImGui::CalcTextSize(text.c_str()).x;
    const ImVec2 at = ImGui::GetCursorScreenPos();
    const float x = at.x + ImGui::GetContentRegionAvail().x - width;
    ImDrawList* const draw = ImGui::GetWindowDrawList();
    const float left = text.empty() ? x - gap : x - gap - words;
    draw->AddText({left, at.y}, whole ? colour::kText : colour::kDim, text.c_str());
    if (whole || state.own_recording)
        draw->AddCircleFilled({left - 2.0F * r, at.y + 0.6F * theme.small->FontSize}, r, colour::kBad, 12);
    ImGui::SetCursorScreenPos({x, at.y});
    ImGui::PushStyleVar(ImGuiStyleVar_FramePadding, {0.5F * padding, 0.0F});
    if (ImGui::Button(button)) state.record_wanted = true;
    ImGui::PopStyleVar();
    if (ImGui::IsItemHovered())
        ImGui::SetTooltip("%s", state.own_recording
                                    ? "ends the recording"
                                    : "records every cycle from now on into your Tact folder");
    ImGui::PopFont();
}

// A recording is shown: said first and largest, and what was the case then is said as past.
void replay_hero(const Theme& theme, const DashboardState& state) {
    const ReplayTopic& r = state.replay.now;
    badge(theme, "REPLAY", colour::kAccent, theme.large);
    ImGui::SameLine();
    ImGui::BeginGroup();
    text_small(theme, colour::kText, replay_text(r));
    text_small(theme, colour::kDim, "A recording: no device, no force.");
    ImGui::EndGroup();
    row(theme, "File", cut_text(theme.text, r.name, ImGui::GetContentRegionAvail().x - theme.px(104.0F)));
    if (!state.have_health) return;
    const auto run_state = static_cast<RunState>(state.health.state);
    const std::string why = run_reason_text(static_cast<RunReason>(state.health.reason));
    row(theme, "Then", run_state_text(run_state), why);
    row(theme, "Force rate", rate_text(state.health.force_rate_hz),
        "goal " + rate_text(state.health.goal_hz));
}

// Top of the card: the state with its reason, and the force rate against the goal.
void hero(const Theme& theme, const DashboardState& state) {
    const HealthTopic& h = state.health;
    const auto run_state = static_cast<RunState>(h.state);
    const StatusText v = state_status(run_state, static_cast<RunReason>(h.reason));
    const double silent_s = 1e-9 * static_cast<double>(state.now_ns - h.taken_at_ns);
    badge(theme, run_badge_text(run_state), grade_colour(v.grade), theme.large);
    ImGui::SameLine();
    ImGui::BeginGroup();  // beside it, as many lines as needed
    if (silent_s > 1.0) badge(theme, format("silent for %.0f s", silent_s), colour::kBad);
    words(theme, h, v);
    ImGui::EndGroup();
    const auto lines = static_cast<LinesShown>(h.lines);
    if (lines == LinesShown::stopped || (lines == LinesShown::waiting && run_state != RunState::armed)) {
        const std::string why = run_reason_text(static_cast<RunReason>(h.lines_reason));
        text_small(theme, lines == LinesShown::stopped ? colour::kBad : colour::kDim,
                   std::string("safety inputs ") + lines_text(lines) + (why.empty() ? "" : ": " + why));
    }
    const StatusText rate = rate_status(h.force_rate_hz, h.goal_hz);
    ImGui::PushFont(theme.large);
    text_coloured(grade_colour(rate.grade), rate_text(h.force_rate_hz));
    const float beside = ImGui::GetItemRectSize().x;
    const ImVec2 at = ImGui::GetItemRectMin();
    ImGui::PopFont();
    const ImVec2 below = ImGui::GetCursorScreenPos();
    ImGui::SetCursorScreenPos({at.x + beside + theme.px(10.0F), at.y - theme.px(1.0F)});
    ImGui::BeginGroup();
    text_small(theme, colour::kDim, "force rate, goal " + rate_text(h.goal_hz), false);
    ImGui::SetCursorScreenPos({at.x + beside + theme.px(10.0F), at.y + theme.small->FontSize});
    text_small(theme, grade_colour(rate.grade), rate.text, false);
    ImGui::EndGroup();
    ImGui::SetCursorScreenPos(below);
    rate_bar(theme, h, grade_colour(rate.grade));
}

void timing(const Theme& theme, const DashboardState& state) {
    const HealthTopic& h = state.health;
    row(theme, "Lateness p99", duration_text(1e-9 * static_cast<double>(h.lateness_p99_ns)),
        lateness_status(h.lateness_p99_ns, h.period_ns));
    row(theme, "Overruns", grouped(h.overruns), overrun_status(h, state.now_ns));
    row(theme, "Deadlines", grouped(h.deadline_misses) + " missed", deadline_status(h, state.now_ns));
}

// A loop without a period is never late. Besides its rate, the recomputed fraction of each step's work shows its
// performance.
void free_running(const Theme& theme, const HealthTopic& h) {
    row(theme, "Recomputed", format("%.0f %%", 100.0 * static_cast<double>(h.recomputed_fraction_mean)),
        recomputed_status(h.recomputed_fraction_mean));
    row(theme, "minimum", format("%.0f %%", 100.0 * static_cast<double>(h.recomputed_fraction_least)),
        "in the last 0.1 s");
    row(theme, "Idle", format("%.0f %%", 100.0 * static_cast<double>(h.rested)), "free running");
}

// Loop delay from encoders to motors, and the stiffness of the field now beside that which the delay allows.
void delay(const Theme& theme, const HealthTopic& h) {
    if (h.delay_p99_ns <= 0) return;
    const double now = 1e-3 * static_cast<double>(h.model_n_m),
                 most = 1e-3 * static_cast<double>(h.stiffness_n_m_max);
    const bool reduced = h.field_gain < 0.995F;
    const std::string part = format("force at %.0f %%", 100.0 * static_cast<double>(h.field_gain));
    const std::array<std::string, 2> notes{
        reduced ? part + ", to be stable" : format("%.2f of %.1f N/mm stable", now, most),
        reduced ? part : format("%.2f of %.1f N/mm", now, most)};
    row(theme, "Loop delay", duration_text(1e-9 * static_cast<double>(h.delay_p99_ns)), notes);
}

void law_and_goal(const Theme& theme, DashboardState& state) {
    if (!state.have_levels) return;
    std::string law(state.levels.law, std::find(state.levels.law, state.levels.law + kLawNameMax, '\0'));
    ImGui::BeginDisabled(!state.commands());
    text_coloured(colour::kDim, "Law");
    ImGui::SameLine(theme.px(100.0F));
    ImGui::SetNextItemWidth(theme.px(84.0F));
    if (ImGui::BeginCombo("##law", law.c_str())) {
        for (const char* name : {"elastic", "sensitus", "fixed"})
            if (ImGui::Selectable(name, law == name))
                state.requests.push_back({CommandKind::set_law, 0.0, name});
        ImGui::EndCombo();
    }
    ImGui::SameLine();
    ImGui::SetNextItemWidth(theme.px(62.0F));
    static double edited = 0.0;
    static bool editing = false;
    if (!editing) edited = state.levels.goal_hz;
    ImGui::InputDouble("##goal", &edited, 0.0, 0.0, "%.0f");
    editing = ImGui::IsItemActive();
    if (ImGui::IsItemDeactivatedAfterEdit()) state.requests.push_back({CommandKind::set_goal_hz, edited, {}});
    ImGui::SameLine(0.0F, theme.px(4.0F));
    text_coloured(colour::kDim, "Hz");
    ImGui::EndDisabled();
}

}  // namespace

void draw_health(const Theme& theme, DashboardState& state, const PixelRect& card) {
    begin_card(theme, state.replay.shown ? "Replay" : "Controller", card,
               true);  // scrolls: two hands with long messages are higher than the card
    const HealthTopic& h = state.health;
    const bool known = state.have_health;
    if (state.watching) {
        ImGui::SameLine();
        badge(theme, "watching", colour::kAccent);
    }
    if (state.attached && !state.replay.shown) {
        ImGui::SameLine();
        recording(theme, state);
    }
    if (!state.attached) {
        badge(theme, known ? "ENDED" : "WAITING", colour::kWatch, theme.large);
        ImGui::PushTextWrapPos(0.0F);
        text_coloured(colour::kWatch, state.link_text);
        ImGui::PopTextWrapPos();
    } else if (!known && !state.replay.shown) {
        badge(theme, "ATTACHED", colour::kWatch, theme.large);
        text_coloured(colour::kWatch, "attached; no health data yet");
    }
    if (state.replay.shown)
        replay_hero(theme, state);
    else if (known && state.attached)
        hero(theme, state);
    // Below the top part, so that long device messages do not push the buttons out of the card.
    draw_run_buttons(state);
    if (!state.command_text.empty() && !state.replay.shown)
        text_small(theme, grade_colour(state.command_grade), state.command_text);
    if (known && state.attached) {
        if (h.period_ns > 0) {
            timing(theme, state);
        } else {
            free_running(theme, h);
        }
        draw_device_rows(theme, state);
        delay(theme, h);
        StatusText picture = display_status(
            state.load.fps, state.have_levels ? static_cast<double>(state.levels.display_goal_hz) : 0.0);
        if (state.frames.late > 0) picture.text += ", " + grouped(state.frames.late) + " late";
        row(theme, "Display", format("%.0f /s", state.load.fps), picture);
        const StatusText memory = memory_status(h);
        if (memory.grade != Grade::good) row(theme, "Memory", "unclean", memory);
        law_and_goal(theme, state);
    }
    if (known && state.attached) {
        const bool clean = memory_status(h).grade == Grade::good;
        text_small(theme, colour::kDim, schedule_text(h.schedule_flags) + (clean ? "; memory clean" : ""));
        if (h.bad_input + state.refused_records > 0)
            text_small(theme, colour::kWatch,
                       format("records rejected: %llu by the controller, %llu by this window",
                              static_cast<unsigned long long>(h.bad_input),
                              static_cast<unsigned long long>(state.refused_records)));
    }
    end_card();
}

}  // namespace tact
