// Overlay on the 3D view: scale bar, axes, force legend, frame rate, status, keys.
#include <algorithm>
#include <cmath>
#include <vector>

#include "gui/dashboard/axis_cross.hpp"
#include "gui/dashboard/letters.hpp"
#include "gui/dashboard/panels.hpp"
#include "gui/dashboard/widgets.hpp"
#include "gui/window/layout.hpp"
#include "ipc/base/units.hpp"

namespace tact {
namespace {

double round_down(double most) {
    const double power = std::pow(10.0, std::floor(std::log10(most)));
    return most >= 5.0 * power ? 5.0 * power : most >= 2.0 * power ? 2.0 * power : power;
}

void scale_bar(const OverlayPen& pen, const PanelState& state, const PixelRect& v) {
    if (!(state.a_per_px > 0.0) || !state.scene.loaded) return;
    const double a = round_down(static_cast<double>(pen.theme.px(150.0F)) * state.a_per_px);
    const auto length = static_cast<float>(a / state.a_per_px);
    const float x1 = v.x + v.width - pen.theme.px(18.0F), x0 = x1 - length;
    const float y = v.y + v.height - pen.theme.px(20.0F), t = pen.theme.px(4.0F);
    pen.draw->AddRectFilled({x0, y}, {x1, y + pen.theme.px(2.0F)}, pen.ink(colour::kText));
    pen.draw->AddRectFilled({x0, y - t}, {x0 + pen.theme.px(2.0F), y + t}, pen.ink(colour::kText));
    pen.draw->AddRectFilled({x1 - pen.theme.px(2.0F), y - t}, {x1, y + t}, pen.ink(colour::kText));
    const std::string text = length_text(a * kAngstromM);
    pen.text(pen.theme.small, {0.5F * (x0 + x1 - pen.width(pen.theme.small, text)), y - pen.theme.px(18.0F)},
             colour::kText, text);
}

void axes(const OverlayPen& pen, const PanelState& state, const PixelRect& v) {
    const float r = pen.theme.px(26.0F);
    const ImVec2 o{v.x + pen.theme.px(44.0F), v.y + v.height - pen.theme.px(46.0F)};
    static constexpr ImU32 kColours[3] = {IM_COL32(240, 112, 96, 255), IM_COL32(96, 200, 120, 255),
                                          IM_COL32(96, 160, 250, 255)};
    for (const AxisEnd& end : axis_cross(state.eye_axes, state.scene)) {
        const float long_side = end.negative ? 0.6F : 1.0F, at = (end.negative ? 0.92F : 1.32F) * r;
        pen.draw->AddLine(o, {o.x + long_side * r * end.x, o.y - long_side * r * end.y}, kColours[end.axis],
                          pen.theme.px(end.negative ? 1.0F : 2.0F));
        const float font = pen.theme.small->FontSize;
        pen.text(pen.theme.small, {o.x + at * end.x - 0.25F * font, o.y - at * end.y - 0.5F * font},
                 kColours[end.axis], end.name);
    }
}

// The title of the scene and the force, in a window without room for more.
void compact_legend(const OverlayPen& pen, const PanelState& state, const PixelRect& v) {
    if (!state.scene.loaded) return;
    const float x = v.x + pen.theme.px(10.0F), y = v.y + pen.theme.px(8.0F);
    const std::string title =
        cut_text(pen.theme.small, state.scene.title, v.width - (x - v.x) - pen.theme.px(10.0F));
    pen.text(pen.theme.small, {x, y}, colour::kText, title);
    if (state.toggles.force && state.attached)
        pen.text(pen.theme.small, {x, y + pen.theme.px(17.0F)}, colour::kForce,
                 format("model force %.2f N", state.force_n));
}

void legend(const OverlayPen& pen, const PanelState& state, const SystemPanels& system, const PixelRect& v) {
    const float x = v.x + pen.theme.px(16.0F);
    float y = v.y + pen.theme.px(12.0F), taken = x;  // space for numbers begins right of it
    if (state.scene.loaded) {
        // Up to the sign of a replay, which stands in the middle.
        const std::string title =
            cut_text(pen.theme.bold, state.scene.title,
                     (state.replay.shown ? 0.5F : 1.0F) * v.width - pen.theme.px(60.0F));
        pen.text(pen.theme.bold, {x, y}, colour::kText, title);
        taken = x + pen.width(pen.theme.bold, title);
        y += pen.theme.px(22.0F);
        const auto line = [&](ImU32 swatch, const std::string& text) {
            pen.draw->AddRectFilled({x, y + pen.theme.px(6.0F)},
                                    {x + pen.theme.px(18.0F), y + pen.theme.px(9.0F)}, swatch);
            pen.text(pen.theme.small, {x + pen.theme.px(24.0F), y}, colour::kText, text);
            taken = std::max(taken, x + pen.theme.px(24.0F) + pen.width(pen.theme.small, text));
            y += pen.theme.px(18.0F);
        };
        if (state.toggles.force && state.attached)
            line(colour::kForce, format("model force %.2f N   (arrow: %s per N)", state.force_n,
                                        length_text(state.arrow_a_per_n * kAngstromM).c_str()));
        std::vector<SystemPanels::LegendLine> lines;
        if (state.toggles.cut) lines.push_back({colour::kWatch, "cut: what is nearer is not drawn"});
        system.add_legend(state, lines);
        for (const SystemPanels::LegendLine& l : lines) line(l.swatch, l.text);
        if (state.second_hand)
            line(colour::kSecondHand, format("second hand %.2f N%s", state.second_force_n,
                                             state.second_at_wall ? ", at the workspace boundary" : ""));
        if (!state.stage.empty())
            pen.text(pen.theme.small, {x, y}, state.head_lost ? colour::kWatch : colour::kDim, state.stage);
    }
    if (!state.stage_refused.empty()) {
        const float most = std::min(pen.theme.px(420.0F), v.width - pen.theme.px(32.0F));
        pen.wrapped(pen.theme.small, {x, y}, colour::kWatch, state.stage_refused, most);
    }
    const std::string fps = format("%.0f fps   ", state.load.fps) + system.drawn_text(state);
    float at = v.y + pen.theme.px(12.0F);
    for (const std::string& words :
         {fps, frame_line(state.frames), std::string(state.keys.key_of(KeyAction::help)) + " keys"}) {
        const float left = v.x + v.width - pen.theme.px(16.0F) - pen.width(pen.theme.small, words);
        // In a narrow view, lines that would reach the title are omitted.
        if (left > taken + pen.theme.px(8.0F)) pen.text(pen.theme.small, {left, at}, colour::kDim, words);
        at += pen.theme.px(18.0F);
    }
}

bool has_stop_notice(const PanelState& state) {
    return state.attached && state.have_health && !stop_notice(state.health).why.empty();
}

// Over everything else, because it takes precedence.
void stop_banner(const OverlayPen& pen, const PanelState& state, const Layout& layout) {
    const PixelRect& v = layout.view;
    if (!has_stop_notice(state)) return;
    const StopNotice notice = stop_notice(state.health);
    ImFont* const large = layout.compact ? pen.theme.bold : pen.theme.large;
    ImFont* const text = layout.compact ? pen.theme.small : pen.theme.text;
    const std::string fix = state.replay.shown ? "In the recorded run." : notice.fix;
    const float pad = pen.theme.px(layout.compact ? 8.0F : 16.0F),
                most = (layout.compact ? 0.9F : 0.7F) * v.width;
    const std::string title = (state.replay.shown ? "Then no force: " : "No force: ") + notice.why;
    const ImVec2 head = large->CalcTextSizeA(large->FontSize, 1e9F, most, noted(title)),
                 body = text->CalcTextSizeA(text->FontSize, 1e9F, most, noted(fix));
    const float w = std::max(head.x, body.x) + 2.0F * pad, h = head.y + body.y + 2.5F * pad;
    const ImVec2 at{v.x + 0.5F * (v.width - w),
                    v.y + (layout.compact ? pen.theme.px(8.0F) : 0.16F * v.height)};
    pen.draw->AddRectFilled(at, {at.x + w, at.y + h}, IM_COL32(96, 22, 18, 240), pen.theme.px(8.0F));
    pen.draw->AddRect(at, {at.x + w, at.y + h}, colour::kBad, pen.theme.px(8.0F), 0, pen.theme.px(2.0F));
    pen.draw->AddText(large, large->FontSize, {at.x + pad, at.y + pad}, IM_COL32(255, 235, 232, 255),
                      title.c_str(), nullptr, most);
    pen.draw->AddText(text, text->FontSize, {at.x + pad, at.y + 1.5F * pad + head.y}, colour::kText,
                      fix.c_str(), nullptr, most);
}

// Whoever looks at the view alone sees it too.
void replay_sign(const OverlayPen& pen, const PanelState& state, const PixelRect& v) {
    if (!state.replay.shown) return;
    ImFont* const font = pen.theme.bold;
    const std::string text = "REPLAY";
    const float w = pen.width(font, text) + pen.theme.px(20.0F), h = font->FontSize + pen.theme.px(6.0F);
    const ImVec2 at{v.x + 0.5F * (v.width - w), v.y + pen.theme.px(10.0F)};
    pen.draw->AddRectFilled(at, {at.x + w, at.y + h}, colour::kAccent, 0.5F * h);
    pen.draw->AddText(font, font->FontSize, {at.x + pen.theme.px(10.0F), at.y + pen.theme.px(3.0F)},
                      colour::kGround, text.c_str());
}

void message(const OverlayPen& pen, const PanelState& state, const PixelRect& v) {
    const std::string text = !state.scene.loaded ? state.scene.status
                             : !state.attached   ? state.link_text
                                                 : "";
    if (text.empty()) return;
    ImFont* const font = pen.theme.text;
    const float most = 0.8F * v.width;
    const ImVec2 size = font->CalcTextSizeA(font->FontSize, 1e9F, most, noted(text));
    const float px = pen.theme.px(14.0F), py = pen.theme.px(8.0F);
    const float cx = v.x + 0.5F * v.width;
    const float y = state.scene.loaded ? v.y + v.height - size.y - 2.0F * py - pen.theme.px(14.0F)
                                       : v.y + 0.45F * v.height;
    pen.draw->AddRectFilled({cx - 0.5F * size.x - px, y}, {cx + 0.5F * size.x + px, y + size.y + 2.0F * py},
                            IM_COL32(18, 22, 29, 225), pen.theme.px(6.0F));
    pen.draw->AddText(font, font->FontSize, {cx - 0.5F * size.x, y + py}, colour::kWatch, text.c_str(),
                      nullptr, most);
}

// While a SpaceMouse or a gamepad leads the tool.
std::string device_hint(const MouseHint& m, const char* let_go) {
    const char* const name = kInputNouns[static_cast<std::size_t>(m.device)];
    if (m.silent) return format("The controller received nothing from the %s: the hand relaxed.", name);
    if (m.gone) return format("The %s is gone: the tool's target stays.   %s: let go", name, let_go);
    const std::string begin = m.drives ? std::string(m.bone ? "The burr runs. " : "Second button pressed. ")
                                       : format("The %s leads the tool. ", name);
    const char* const second = m.bone ? "burr" : "second button";
    if (m.device == 0)
        return begin + format("Push: move   Twist: turn   Button 2: %s   %s: let go", second, let_go);
    return begin +
           format("Left stick: move   Triggers: depth   Shoulder: turn   B: %s   %s: let go", second, let_go);
}

// One line about the mouse at the lower edge, while the pointer is over a tool or leads it.
void mouse_hint(const OverlayPen& pen, const PanelState& state, const PixelRect& v) {
    const MouseHint& m = state.mouse;
    if (m.label) {
        const std::string text = "drag to lead";
        const float w = pen.width(pen.theme.small, text), pad = pen.theme.px(6.0F),
                    h = pen.theme.small->FontSize;
        const ImVec2 at{m.label_x - 0.5F * w, m.label_y + pen.theme.px(5.0F)};
        pen.draw->AddRectFilled({at.x - pad, at.y - 0.3F * pad}, {at.x + w + pad, at.y + h + 0.3F * pad},
                                IM_COL32(18, 22, 29, 205), 0.5F * h);
        pen.draw->AddText(pen.theme.small, pen.theme.small->FontSize, at, colour::kMouse, text.c_str());
    }
    if (!m.near && !m.holds && m.waits.empty()) return;
    const bool watch = m.silent || m.gone || (!m.holds && !m.near && m.waits_in_vain);
    const char* const key = state.keys.key_of(KeyAction::lead_tool);
    std::string text = format("Drag to lead the tool, or press %s.", key);
    if (!m.holds && !m.near) text = m.waits;
    if (m.holds && m.device != MouseHint::kMouse) {
        text = device_hint(m, state.keys.key_of(KeyAction::let_go_tool));
    } else if (m.holds) {
        text = m.silent   ? "The controller received nothing from the mouse: the hand relaxed."
               : m.drives ? std::string(m.bone ? "The burr runs. " : "Second button pressed. ")
                          : std::string("The mouse leads the tool. ");
        if (!m.silent)
            text += format(
                "Wheel: depth   Ctrl: turn   Shift: finer   %s: %s   %s: let go",
                m.by_key ? "Buttons" : "Right button", m.bone ? "burr" : "second button",
                m.by_key ? (std::string(key) + " or " + state.keys.key_of(KeyAction::let_go_tool)).c_str()
                         : "Release");
    }
    ImFont* const font = pen.theme.text;
    const float most = v.width - pen.theme.px(40.0F), px = pen.theme.px(14.0F), py = pen.theme.px(7.0F);
    const ImVec2 size = font->CalcTextSizeA(font->FontSize, 1e9F, most - 2.0F * px, text.c_str());
    // Between the axes and the scale bar; above them in a narrow view.
    const float beside = pen.theme.px(190.0F), above = size.x + 2.0F * px > v.width - 2.0F * beside
                                                           ? pen.theme.px(92.0F)
                                                           : pen.theme.px(14.0F);
    const ImVec2 at{v.x + 0.5F * (v.width - size.x) - px, v.y + v.height - size.y - 2.0F * py - above};
    const ImVec2 end{at.x + size.x + 2.0F * px, at.y + size.y + 2.0F * py};
    pen.draw->AddRectFilled(at, end, IM_COL32(18, 22, 29, 225), pen.theme.px(6.0F));
    if (m.holds) pen.draw->AddRect(at, end, watch ? colour::kWatch : colour::kMouse, pen.theme.px(6.0F));
    pen.draw->AddText(font, font->FontSize, {at.x + px, at.y + py}, watch ? colour::kWatch : colour::kText,
                      text.c_str(), nullptr, most - 2.0F * px);
}

// Keys that apply now; in a view too small for them, over the whole window.
void keys(OverlayPen pen, const KeyTable& table, const KeySituation& now, PixelRect v) {
    std::vector<const KeyRow*> rows;
    for (const KeyRow& row : table.rows())
        if (applies(row.when, now)) rows.push_back(&row);
    float line = pen.theme.px(20.0F), column = pen.theme.px(430.0F), word = pen.theme.px(112.0F);
    const float pad = pen.theme.px(14.0F);
    ImFont *name = pen.theme.bold, *text = pen.theme.text;
    const auto fits = [&](float high, float wide) {
        return std::floor((high - 2.0F * pad) / line) * std::floor(wide / column) >=
               static_cast<float>(rows.size());
    };
    if (!fits(v.height, v.width)) {
        v = {0.0F, 0.0F, ImGui::GetIO().DisplaySize.x, ImGui::GetIO().DisplaySize.y};
        pen.draw = ImGui::GetForegroundDrawList();
        if (!fits(v.height, v.width)) {
            line = pen.theme.px(17.0F);
            column = pen.theme.px(400.0F);
            word = pen.theme.px(96.0F);
            name = text = pen.theme.small;
        }
    }
    const auto columns = static_cast<std::size_t>(
        sheet_columns(static_cast<int>(rows.size()), static_cast<int>((v.height - 4.0F * pad) / line),
                      static_cast<int>(v.width / column)));
    const std::size_t each = (rows.size() + columns - 1) / columns;
    const float w = column * static_cast<float>(columns), h = line * static_cast<float>(each) + 2.0F * pad;
    const ImVec2 at{v.x + 0.5F * (v.width - w), v.y + 0.5F * (v.height - h)};
    pen.draw->AddRectFilled(at, {at.x + w, at.y + h}, colour::kPanel, pen.theme.px(8.0F));
    pen.draw->AddRect(at, {at.x + w, at.y + h}, colour::kPanelEdge, pen.theme.px(8.0F));
    for (std::size_t i = 0; i < rows.size(); ++i) {
        const std::size_t in_column = i / each;
        const float x = at.x + pad + column * static_cast<float>(in_column);
        const float y = at.y + pad + line * static_cast<float>(i % each);
        pen.draw->AddText(name, name->FontSize, {x, y}, colour::kAccent, rows[i]->keys);
        pen.draw->AddText(text, text->FontSize, {x + word, y}, colour::kText, rows[i]->what);
    }
}

// What a window without room for panels shows over the view. The list of scenes lies over all of it.
void compact_overlay(const OverlayPen& pen, const PanelState& state, const Layout& layout) {
    const PixelRect& v = layout.view;
    if (state.browser.open) return;
    if (has_stop_notice(state)) return stop_banner(pen, state, layout);
    if (state.situation.sheet || state.picture.open || state.calibration.open) {
        pen.wrapped(pen.theme.text, {v.x + pen.theme.px(14.0F), v.y + 0.3F * v.height}, colour::kWatch,
                    state.situation.sheet ? "Enlarge the window to see the table of keys."
                                          : "Enlarge the window to see the panel.",
                    v.width - pen.theme.px(28.0F));
        return;
    }
    message(pen, state, v);
    compact_legend(pen, state, v);
    if (!state.scene.loaded || !state.attached) return;
    axes(pen, state, v);
    scale_bar(pen, state, v);
}

}  // namespace

void draw_overlay(const Theme& theme, PanelState& state, const SystemPanels& system, const Layout& layout) {
    const PixelRect& view = layout.view;
    const OverlayPen pen{theme, ImGui::GetBackgroundDrawList(),
                         state.toggles.white_ground && state.stage.empty()};
    pen.draw->PushClipRect({view.x, view.y}, {view.x + view.width, view.y + view.height});
    if (layout.compact) {
        compact_overlay(pen, state, layout);
        return pen.draw->PopClipRect();
    }
    if (!state.calibration.open && !state.situation.sheet) {  // the table of keys takes their place
        legend(pen, state, system, view);
        axes(pen, state, view);
        scale_bar(pen, state, view);
        system.draw_over_view(pen, state, view);
        if (state.toggles.frame_times) draw_frame_times(theme, state.frames, view);
        message(pen, state, view);
        mouse_hint(pen, state, view);
    }
    stop_banner(pen, state, layout);
    replay_sign(pen, state, view);
    if (state.situation.sheet) keys(pen, state.keys, state.situation, view);
    pen.draw->PopClipRect();
}

}  // namespace tact
