#include "gui/window/layout.hpp"

#include <algorithm>
#include <cmath>

#include "gui/dashboard/panels.hpp"
#include "gui/window/view_button.hpp"

namespace tact {

MiddleCard middle_card(const PanelState& state, const SystemPanels& system) {
    if (state.calibration.open) return {{}, true};
    return {system.card_size(), false};
}

Strip strip_of(const PanelState& state) {
    return {state.strip == 1, state.replay.shown, state.past.shown && !state.replay.shown};
}

namespace {

// The state, the force rate and the buttons needed first; all else waits for a larger window.
constexpr float kCompactStrip = 64.0F;

Layout compact_layout(const Theme& theme, float width_px, float height_px) {
    const float strip = std::round(std::min(theme.px(kCompactStrip), 0.5F * height_px));
    Layout l;
    l.compact = true;
    l.view = {0.0F, 0.0F, std::max(width_px, 1.0F), std::max(height_px - strip, 1.0F)};
    l.health = {0.0F, l.view.height, l.view.width, strip};
    return l;
}

void draw_compact(const Theme& theme, PanelState& state, const Layout& layout) {
    draw_health_strip(theme, state, layout.health);
    if (state.browser.open) draw_browser(theme, state.browser, layout.view);
}

}  // namespace

Layout layout_for(const Theme& theme, float width_px, float height_px, const MiddleCard& middle,
                  Strip strip) {
    if (width_px < theme.px(kLeastWide) || height_px < theme.px(kLeastHigh))
        return compact_layout(theme, width_px, height_px);
    const float gap = std::round(theme.px(6.0F));
    const float left = std::round(std::min(theme.px(318.0F), 0.5F * width_px));
    const float plots = strip.traces
                            ? std::round(std::clamp(0.5F * height_px, theme.px(196.0F), theme.px(420.0F)))
                            : std::round(std::min(theme.px(196.0F), 0.45F * height_px));
    const float timeline = strip.timeline || strip.past
                               ? std::round(std::min(theme.px(strip.timeline ? kTimelineHeight : kPastHeight),
                                                     0.15F * height_px))
                               : 0.0F;
    const float below = plots + timeline;
    const auto at_least_one = [](float v) { return std::max(v, 1.0F); };
    Layout l;
    l.view = {left, 0.0F, at_least_one(width_px - left), at_least_one(height_px - below)};

    // The scene card contains lists and gets the remaining height; the other two have known heights.
    const float usable = height_px - 4.0F * gap;
    const float health = std::round(std::min(theme.px(344.0F), 0.48F * usable));
    const float between = std::round(std::min(theme.px(middle.size.height), middle.size.share_most * usable));
    const float inner = at_least_one(left - 2.0F * gap);
    float y = gap;
    const auto card = [&](float height) {
        const PixelRect rect{gap, y, inner, at_least_one(height)};
        y += height + gap;
        return rect;
    };
    if (middle.calibration) {
        l.middle = card(height_px - 2.0F * gap);
        l.health = l.scene = {gap, gap, 0.0F, 0.0F};
    } else {
        l.health = card(health);
        const bool any = middle.size.height > 0.0F;
        l.middle = any ? card(between) : PixelRect{gap, y, 0.0F, 0.0F};
        l.scene = card(usable - health - between + (any ? 0.0F : gap));
    }

    const float events = std::round(std::clamp(0.24F * l.view.width, theme.px(190.0F), theme.px(420.0F)));
    const float top = l.view.height + timeline, height = at_least_one(plots - gap);
    l.timeline = {left, l.view.height, at_least_one(l.view.width - gap), std::max(timeline - gap, 0.0F)};
    l.plots = {left, top, at_least_one(l.view.width - events - 2.0F * gap), height};
    l.events = {left + l.plots.width + gap, top, events, height};
    return l;
}

void draw_dashboard(const Theme& theme, PanelState& state, SystemPanels& system, float width_px,
                    float height_px) {
    const MiddleCard middle = middle_card(state, system);
    const Layout layout = layout_for(theme, width_px, height_px, middle, strip_of(state));
    ImGui::PushStyleVar(ImGuiStyleVar_WindowMinSize, ImVec2(1.0F, 1.0F));
    if (layout.compact) {
        draw_compact(theme, state, layout);
        ImGui::PopStyleVar();
        return draw_overlay(theme, state, system, layout);
    }
    if (middle.calibration) draw_calibration(theme, state.calibration, layout.middle);
    if (!middle.calibration) draw_health(theme, state, layout.health);
    if (middle.size.height > 0.0F) system.draw_card(theme, layout.middle, state);
    if (!middle.calibration) draw_scene(theme, state, system, layout.scene);
    if (state.replay.shown)
        draw_timeline(theme, state.replay, layout.timeline);
    else if (state.past.shown)
        draw_past(theme, state.past, layout.timeline);
    draw_plots(theme, state, layout.plots);
    draw_events(theme, state, layout.events);
    const auto button = [&](const char* window, const char* text, KeyAction key, float top) {
        return view_button(theme, window, text, state.keys.key_of(key), top, layout.view);
    };
    if (state.browser.open) {
        draw_browser(theme, state.browser, layout.view);
    } else if (!middle.calibration) {
        if (button("scenes button", "Scenes", KeyAction::open_browser, kScenesButtonTop))
            state.browser.open = true;
        if (state.scene.loaded && button("picture button", "Picture", KeyAction::picture, kPictureButtonTop))
            open_alone(state.picture.open, state.input.open);
        if (state.scene.loaded &&
            button("input button", "Devices", KeyAction::input_devices, kInputButtonTop))
            open_alone(state.input.open, state.picture.open);
        if (state.scene.loaded && state.input.open) draw_input_panel(theme, state.input, layout.view);
        if (state.scene.loaded && state.picture.open)
            draw_picture_panel(theme, state.picture, state.toggles, state.situation.bodies, layout.view);
    }
    ImGui::PopStyleVar();
    draw_overlay(theme, state, system, layout);
}

}  // namespace tact
