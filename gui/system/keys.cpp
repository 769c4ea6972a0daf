#include "gui/system/keys.hpp"

#include <algorithm>

namespace tact {
namespace {

constexpr KeyStroke typed_key(char c) { return {KeyCode::character, c, false, false}; }
constexpr KeyStroke control_key(char c) { return {KeyCode::character, c, true, false}; }
constexpr KeyStroke named_key(KeyCode code) { return {code, '\0', false, false}; }

// Arming takes two keys together; disarming takes the widest key.
constexpr auto kKeyRows = [] {
    using enum KeyWhen;
    return std::to_array<KeyRow>({
        {{}, 0, always, KeyAction::none, "left drag", "rotate"},
        {{}, 0, always, KeyAction::none, "right drag", "pan"},
        {{}, 0, always, KeyAction::none, "wheel", "zoom"},
        {{}, 0, always, KeyAction::none, "Shift+wheel", "move the cut"},
        {{}, 0, bodies, KeyAction::none, "Alt+wheel", "contour level"},
        {{}, 0, bodies, KeyAction::none, "Ctrl+wheel", "choose another contour"},
        {{}, 0, mouse, KeyAction::none, "drag the ring", "lead the tool"},
        {typed_key('l'), 0, mouse, KeyAction::lead_tool, "L", "lead the tool without a button, or let go"},
        {{}, 0, mouse, KeyAction::none, "led: wheel", "the tool away from the viewer, or nearer"},
        {{}, 0, mouse, KeyAction::none, "led: Ctrl", "turn the tool"},
        {{}, 0, mouse, KeyAction::none, "led: Shift", "a fifth of the motion"},
        {{}, 0, mouse, KeyAction::none, "led: right", "second button of the stylus: runs a burr"},
        {{}, 0, mouse, KeyAction::none, "led: middle", "first button: the tool moves alone"},
        {named_key(KeyCode::escape), 0, holding, KeyAction::let_go_tool, "Esc", "let go of the tool"},
        {{}, 0, watching, KeyAction::none, "Ctrl+click", "mark this place on the bone"},
        {named_key(KeyCode::escape), 0, sheet, KeyAction::close_sheet, "Esc", "close this table"},
        {named_key(KeyCode::escape), 0, browser, KeyAction::close_browser, "Esc", "close the list of scenes"},
        {named_key(KeyCode::space), 0, controller, KeyAction::disarm, "Space", "disarm: no force"},
        {{KeyCode::enter, '\0', true, false}, 0, controller, KeyAction::arm, "Ctrl+Enter", "arm"},
        {named_key(KeyCode::space), 0, replay, KeyAction::play, "Space", "replay: play or pause"},
        {typed_key(','), 0, replay, KeyAction::step_back, ",", "replay: one step back"},
        {typed_key('.'), 0, replay, KeyAction::step_on, ".", "replay: one step on"},
        {named_key(KeyCode::home), 0, always, KeyAction::home, "Home", "home view"},
        {typed_key('f'), 0, bone, KeyAction::approach_burr, "F", "close view of the burr"},
        {typed_key('['), 0, bone, KeyAction::smaller_burr, "[", "smaller burr"},
        {typed_key(']'), 0, bone, KeyAction::larger_burr, "]", "larger burr"},
        {typed_key('g'), 0, bone, KeyAction::other_grit, "G", "burr: cutting or diamond"},
        {typed_key('v'), 0, bone, KeyAction::microscope, "V", "operating microscope on or off"},
        {typed_key('s'), 0, always, KeyAction::style, "S", "surface: glass, solid, wire"},
        {typed_key('c'), 0, always, KeyAction::cut, "C", "cut what is near"},
        {typed_key('i'), 0, always, KeyAction::picture, "I", "how the view is drawn; save a picture"},
        {typed_key('d'), 0, always, KeyAction::input_devices, "D", "what SpaceMouse and gamepad do"},
        {typed_key('x'), 0, stereo, KeyAction::swap_eyes, "X", "stereo: swap the eyes"},
        {typed_key('+'), 0, bodies, KeyAction::raise_contour, "+", "contour level up"},
        {typed_key('-'), 0, bodies, KeyAction::lower_contour, "-", "contour level down"},
        {typed_key('1'), '9', bodies, KeyAction::take_body, "1 ... 9", "hold the body of this number"},
        {{}, 0, bodies, KeyAction::none, "click", "hold the body under the pointer"},
        {typed_key('0'), 0, bodies, KeyAction::let_go, "0", "release all bodies"},
        {control_key('z'), 0, bodies, KeyAction::undo, "Ctrl+Z",
         "undo the last gesture, or an added structure"},
        {control_key('y'), 0, bodies, KeyAction::redo, "Ctrl+Y", "redo"},
        {{KeyCode::character, 'z', true, true},
         0,
         bodies,
         KeyAction::redo,
         "Ctrl+Shift+Z",
         "redo the last gesture"},
        {control_key('z'), 0, bone, KeyAction::undo, "Ctrl+Z", "undo the last cut of the burr"},
        {control_key('y'), 0, bone, KeyAction::redo, "Ctrl+Y", "redo the cut"},
        {{KeyCode::character, 'z', true, true}, 0, bone, KeyAction::redo, "Ctrl+Shift+Z", "redo the cut"},
        {typed_key('r'), 0, bodies, KeyAction::refine, "R", "refine the body in the hand"},
        {named_key(KeyCode::enter), 0, bodies, KeyAction::accept, "Enter",
         "accept the current poses (clears undo)"},
        {named_key(KeyCode::escape), 0, bodies, KeyAction::revert, "Esc", "return to the accepted poses"},
        {typed_key('k'), 0, always, KeyAction::calibrate, "K", "calibrate the stereo screen"},
        {typed_key('t'), 0, calibrating, KeyAction::measure, "T", "measure the point, or cancel"},
        {typed_key('n'), 0, calibrating, KeyAction::skip_point, "N", "skip to the next point"},
        {typed_key('b'), 0, calibrating, KeyAction::redo_point, "B", "repeat the last point"},
        {named_key(KeyCode::enter), 0, calibrating, KeyAction::next_step, "Enter", "next step"},
        {control_key('s'), 0, calibrating, KeyAction::save_calibration, "Ctrl+S", "save the calibration"},
        {typed_key('x'), 0, calibrating, KeyAction::swap_calibrated_eyes, "X", "swap the eyes"},
        {named_key(KeyCode::escape), 0, calibrating, KeyAction::leave_calibration, "Esc",
         "leave the calibration"},
        {typed_key('o'), 0, always, KeyAction::open_browser, "O", "open another scene"},
        {typed_key('p'), 0, always, KeyAction::screenshot, "P", "save a picture of the window"},
        {control_key('r'), 0, controller, KeyAction::record, "Ctrl+R",
         "record the run, or end the recording"},
        {KeyStroke{KeyCode::character, 's', true, true}, 0, controller, KeyAction::save_session,
         "Ctrl+Shift+S", "save the session, to go on later"},
        {typed_key('m'), 0, controller, KeyAction::mark, "M", "mark this moment for the flight recorder"},
        {typed_key('?'), 0, always, KeyAction::help, "?", "this table"},
    });
}();

}  // namespace

std::span<const KeyRow> key_rows() noexcept { return kKeyRows; }

bool applies(KeyWhen when, const KeySituation& now) noexcept {
    using enum KeyWhen;
    switch (when) {
        case always:
            return true;
        case sheet:
            return now.sheet;
        case browser:
            return now.browser;
        case bodies:
            return now.bodies;
        case bone:
            return now.bone;
        case stereo:
            return now.stereo;
        case controller:
            return now.controller;
        case replay:
            return now.replay;
        case calibrating:
            return now.calibrating;
        case watching:
            return now.watching && now.controller;
        case mouse:
            return now.mouse;
        case holding:
            return now.holding;
    }
    return false;
}

namespace {
char last_of(const KeyRow& row) { return row.last != '\0' ? row.last : row.stroke.character; }
}  // namespace

int key_precedence(KeyWhen when) noexcept {
    switch (when) {
        case KeyWhen::holding:
            return 3;
        case KeyWhen::sheet:
            return 2;
        case KeyWhen::browser:
            return 1;
        default:
            return 0;
    }
}

bool collide(const KeyRow& a, const KeyRow& b) noexcept {
    using enum KeyWhen;
    if (a.action == KeyAction::none || b.action == KeyAction::none) return false;
    if (key_precedence(a.when) != key_precedence(b.when)) return false;  // one of them takes precedence
    const bool of_scenes = (a.when == bodies && b.when == bone) || (a.when == bone && b.when == bodies);
    if (of_scenes) return false;  // no scene is both
    const bool of_controllers =
        (a.when == controller && b.when == replay) || (a.when == replay && b.when == controller);
    if (of_controllers) return false;  // a replay is no controller
    const auto of_picture = [](KeyWhen when) { return when == bodies || when == bone || when == stereo; };
    if ((a.when == calibrating && of_picture(b.when)) || (b.when == calibrating && of_picture(a.when)))
        return false;  // calibration replaces the scene display
    const KeyStroke &p = a.stroke, &q = b.stroke;
    return p.code == q.code && p.control == q.control && p.shift == q.shift && p.character <= last_of(b) &&
           q.character <= last_of(a);
}

int sheet_columns(int rows, int rows_high, int columns_wide) noexcept {
    constexpr int kLong = 16;  // readable at a glance; a longer column hides the scene over its whole height
    return columns_wide >= 2 && rows > std::min(rows_high, kLong) ? 2 : 1;
}

}  // namespace tact
