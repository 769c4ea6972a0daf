// Table of all keyboard shortcuts: the window looks keys up in it, and `?` shows it. No key is handled elsewhere. A person's own keys replace
// the table's (KeyTable::read).
//
// Letters   as printed on the keyboard, in any layout; signs and digits as typed
// Modifiers must match a row exactly, so Ctrl+Z is never taken for Z
// Thread    any; a table is constant once made
#pragma once

#include <array>
#include <cstdint>
#include <deque>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace tact {

enum class KeyCode : std::uint8_t { none, character, home, enter, escape, space };

// A pressed key. `character`: a lower-case letter or a sign, if `code` is `character`.
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
    smaller_burr,
    larger_burr,
    other_grit,
    microscope,
    style,
    cut,
    picture,
    input_devices,
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
    screenshot,
    mark,
    record,
    save_session,
    play,
    step_back,
    step_on,
    help,
    calibrate,
    measure,
    skip_point,
    redo_point,
    next_step,
    leave_calibration,
    save_calibration,
    swap_calibrated_eyes,
    lead_tool,
    let_go_tool,
    count
};

// Condition of a row. A tool in the mouse's hold takes precedence, then the sheet, then the list of scenes; a key that they use goes no further.
enum class KeyWhen : std::uint8_t {
    always,
    sheet,
    browser,
    bodies,
    bone,
    stereo,
    controller,
    replay,
    calibrating,
    watching,
    mouse,
    holding
};

struct KeySituation {
    bool sheet = false;        // the key table (`?`) is shown
    bool browser = false;      // the list of scenes is shown
    bool bodies = false;       // the scene has a map and bodies to place
    bool bone = false;         // a drilling scene
    bool stereo = false;       // the display is stereoscopic
    bool controller = false;   // attached, and no replay
    bool replay = false;       // the window shows a recording
    bool watching = false;     // an instructor's window
    bool mouse = false;        // it may lead a tool
    bool holding = false;      // it leads one
    bool calibrating = false;  // bodies, bone and stereo then do not apply
};

struct KeyRow {
    KeyStroke stroke;
    char last;  // last character of a range that begins with the stroke's; 0: that character alone
    KeyWhen when;
    KeyAction action;
    const char* keys;  // as shown to the user
    const char* what;
};

struct KeyFound {
    const KeyRow* row = nullptr;  // null: the key has no function here
    int place = 0;                // index in the row's range, from 0
};

[[nodiscard]] std::span<const KeyRow> key_rows() noexcept;         // as built in
[[nodiscard]] const char* action_name(KeyAction action) noexcept;  // in a file of keys
// "Ctrl+Shift+Z", "Space", "+"; read_stroke() reads it in any case of letters.
[[nodiscard]] std::string stroke_text(const KeyStroke& stroke);
[[nodiscard]] std::optional<KeyStroke> read_stroke(std::string_view text);
[[nodiscard]] bool applies(KeyWhen when, const KeySituation& now) noexcept;
// Of rows that apply at once, the one with the highest is meant.
[[nodiscard]] int key_precedence(KeyWhen when) noexcept;
// True if both rows can apply at once and one stroke would match both.
[[nodiscard]] bool collide(const KeyRow& a, const KeyRow& b) noexcept;

class KeyTable {
public:
    KeyTable();  // as built in
    KeyTable(KeyTable&&) = default;
    KeyTable& operator=(KeyTable&&) = default;
    KeyTable(const KeyTable& other) { *this = other; }
    KeyTable& operator=(const KeyTable& other);
    ~KeyTable() = default;
    // The built-in table with the keys of a TOML text: ACTION = "KEY", several keys separated by spaces. Every action keeps a key; arming takes
    // two keys together; keys of a range (1 to 9) stay. Throws StartupError with the action and `name` of the file.
    [[nodiscard]] static KeyTable read(std::string_view text, const std::string& name);
    [[nodiscard]] std::span<const KeyRow> rows() const noexcept { return rows_; }
    [[nodiscard]] KeyFound find(const KeyStroke& stroke, const KeySituation& now) const noexcept;
    // As shown; the first of several.
    [[nodiscard]] const char* key_of(KeyAction action) const noexcept;
    // Reading it gives the same table.
    [[nodiscard]] std::string text() const;

private:
    void replace(KeyAction action, std::span<const KeyStroke> strokes);

    std::vector<KeyRow> rows_;
    std::deque<std::string> own_;  // texts of keys that are not built in
};

// Columns of the sheet, 1 or 2: two if they fit side by side and one would be too long or too high.
[[nodiscard]] int sheet_columns(int rows, int rows_high, int columns_wide) noexcept;

}  // namespace tact
