// Every shortcut: one table that the window's input is looked up in and that `?` shows. No key is handled elsewhere.
//
// Printed   letters are those printed on the keyboard, wherever they lie; signs and digits are what was typed.
// Modifiers a row is meant with exactly its own, so that Ctrl+Z is never taken for Z.
// Thread    any; the table is constant.
#pragma once

#include <array>
#include <cstdint>
#include <span>

namespace tact {

enum class KeyCode : std::uint8_t { none, character, home, enter, escape, space };

// What was pressed. `character`: lower case or a sign, where the code is so.
struct KeyStroke {
    KeyCode code = KeyCode::none;
    char character = '\0';
    bool control = false, shift = false;
    bool operator==(const KeyStroke&) const = default;
};

enum class KeyAction : std::uint8_t {
    none,  // done with the mouse
    close_sheet,
    open_browser,
    close_browser,
    home,
    approach_burr,
    style,
    swap_eyes,
    raise_contour,
    lower_contour,
    take_body,
    let_go,
    undo,
    redo,
    refine,
    accept,
    revert,
    arm,
    disarm,
    picture,
    mark,
    help,
    calibrate,
    measure,
    skip_point,
    redo_point,
    next_step,
    leave_calibration,
    save_calibration,
    swap_calibrated_eyes,
    count
};

// When a row applies. The sheet comes first, then the list of scenes: what they take reaches nothing below them.
enum class KeyWhen : std::uint8_t { always, sheet, browser, bodies, bone, stereo, controller, calibrating };

struct KeySituation {
    bool sheet = false;        // `?` is shown
    bool browser = false;      // the list of scenes is shown
    bool bodies = false;       // the scene has a map and bodies to place
    bool bone = false;         // the scene is drilled
    bool stereo = false;       // the picture is for two eyes
    bool controller = false;   // attached
    bool calibrating = false;  // then none of scene and stereo
};

struct KeyRow {
    KeyStroke stroke;
    char last;  // of a range of characters from the stroke's own on; 0: that one alone
    KeyWhen when;
    KeyAction action;
    const char* keys;  // as a person reads it
    const char* what;
};

struct KeyFound {
    const KeyRow* row = nullptr;  // null: it means nothing here
    int place = 0;                // in the row's range, from 0
};

[[nodiscard]] std::span<const KeyRow> key_rows() noexcept;
[[nodiscard]] bool applies(KeyWhen when, const KeySituation& now) noexcept;
[[nodiscard]] KeyFound find_key(const KeyStroke& stroke, const KeySituation& now) noexcept;
// Whether both may apply at once and one stroke would mean both.
[[nodiscard]] bool collide(const KeyRow& a, const KeyRow& b) noexcept;
// Columns of the sheet, 1 or 2: two where both have room side by side and one would be long to read or too high.
[[nodiscard]] int sheet_columns(int rows, int rows_high, int columns_wide) noexcept;

}  // namespace tact
