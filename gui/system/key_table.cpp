// A person's own keys.
#include <algorithm>
#include <cctype>

#include "gui/base/toml_keys.hpp"
#include "gui/system/keys.hpp"
#include "ipc/base/error.hpp"

namespace tact {
namespace {

constexpr const char* kFix = "tact-gui --keys lists all actions with their keys, in the form of this file";
constexpr std::array<const char*, static_cast<std::size_t>(KeyAction::count)> kActionNames{
    "none",
    "close_table",
    "open_scenes",
    "close_scenes",
    "home_view",
    "near_burr",
    "smaller_burr",
    "larger_burr",
    "other_grit",
    "microscope",
    "surface_style",
    "cut",
    "picture",
    "input_devices",
    "swap_eyes",
    "raise_contour",
    "lower_contour",
    "hold_body",
    "release_bodies",
    "undo",
    "redo",
    "refine",
    "accept",
    "revert",
    "arm",
    "disarm",
    "screenshot",
    "mark",
    "record",
    "save_session",
    "play",
    "step_back",
    "step_on",
    "show_table",
    "calibrate",
    "measure_point",
    "skip_point",
    "redo_point",
    "next_step",
    "leave_calibration",
    "save_calibration",
    "swap_calibrated_eyes",
    "lead_tool",
    "let_go_of_tool"};

struct NamedKey {
    KeyCode code;
    const char* name;
};
constexpr NamedKey kNamedKeys[] = {
    {KeyCode::home, "Home"}, {KeyCode::enter, "Enter"}, {KeyCode::escape, "Esc"}, {KeyCode::space, "Space"}};

std::string lower(std::string_view text) {
    std::string out;
    for (const char c : text) out += static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
    return out;
}

char last_character(const KeyRow& row) { return row.last != '\0' ? row.last : row.stroke.character; }

std::vector<std::string_view> words_of(std::string_view text) {
    std::vector<std::string_view> words;
    while (true) {
        const std::size_t from = text.find_first_not_of(' ');
        if (from == std::string_view::npos) return words;
        text.remove_prefix(from);
        const std::size_t end = std::min(text.find(' '), text.size());
        words.push_back(text.substr(0, end));
        text.remove_prefix(end);
    }
}

}  // namespace

const char* action_name(KeyAction action) noexcept {
    return kActionNames[std::min(static_cast<std::size_t>(action), kActionNames.size() - 1)];
}

std::string stroke_text(const KeyStroke& stroke) {
    std::string text = std::string(stroke.control ? "Ctrl+" : "") + (stroke.shift ? "Shift+" : "");
    for (const NamedKey& key : kNamedKeys)
        if (key.code == stroke.code) return text + key.name;
    return text + static_cast<char>(std::toupper(static_cast<unsigned char>(stroke.character)));
}

std::optional<KeyStroke> read_stroke(std::string_view text) {
    KeyStroke stroke;
    std::string rest = lower(text);
    for (const auto& [prefix, flag] :
         {std::pair{"ctrl+", &stroke.control}, std::pair{"shift+", &stroke.shift}})
        if (rest.size() > std::string_view(prefix).size() && rest.starts_with(prefix)) {
            *flag = true;
            rest.erase(0, std::string_view(prefix).size());
        }
    for (const NamedKey& key : kNamedKeys)
        if (rest == lower(key.name)) {
            stroke.code = key.code;
            return stroke;
        }
    if (rest.size() != 1 || rest[0] <= ' ' || rest[0] > '~') return std::nullopt;
    stroke.code = KeyCode::character;
    stroke.character = rest[0];
    return stroke;
}

KeyTable::KeyTable() : rows_(key_rows().begin(), key_rows().end()) {}

KeyTable& KeyTable::operator=(const KeyTable& other) {
    if (this == &other) return *this;
    rows_ = other.rows_;
    own_ = other.own_;
    for (KeyRow& row : rows_)
        for (std::size_t i = 0; i < own_.size(); ++i)
            if (row.keys == other.own_[i].c_str()) row.keys = own_[i].c_str();
    return *this;
}

KeyFound KeyTable::find(const KeyStroke& stroke, const KeySituation& now) const noexcept {
    KeyFound found;
    for (const KeyRow& row : rows_) {
        if (row.action == KeyAction::none || !applies(row.when, now)) continue;
        KeyStroke of_row = row.stroke;
        if (row.stroke.code == KeyCode::character && stroke.character >= row.stroke.character &&
            stroke.character <= last_character(row))
            of_row.character = stroke.character;
        if (of_row != stroke) continue;
        if (found.row == nullptr || key_precedence(row.when) > key_precedence(found.row->when))
            found = {&row, stroke.character - row.stroke.character};
    }
    return found;
}

const char* KeyTable::key_of(KeyAction action) const noexcept {
    for (const KeyRow& row : rows_)
        if (row.action == action) return row.keys;
    return "";
}

// In every situation in which the action has a row, with that row's description.
void KeyTable::replace(KeyAction action, std::span<const KeyStroke> strokes) {
    std::vector<KeyRow> rows;
    std::vector<KeyWhen> done;
    for (const KeyRow& row : rows_) {
        if (row.action != action) {
            rows.push_back(row);
            continue;
        }
        if (std::find(done.begin(), done.end(), row.when) != done.end()) continue;
        done.push_back(row.when);
        for (const KeyStroke& stroke : strokes) {
            KeyRow own = row;
            own.stroke = stroke;
            own.keys = own_.emplace_back(stroke_text(stroke)).c_str();
            rows.push_back(own);
        }
    }
    rows_ = std::move(rows);
}

KeyTable KeyTable::read(std::string_view text, const std::string& name) {
    const TomlKeys reader(name, kFix);
    KeyTable table;
    std::vector<std::pair<KeyAction, std::string>> wanted;
    for (std::size_t i = 1; i < kActionNames.size(); ++i) {
        const auto action = static_cast<KeyAction>(i);
        const bool range = std::any_of(table.rows_.begin(), table.rows_.end(), [&](const KeyRow& row) {
            return row.action == action && row.last != '\0';
        });
        if (!range) wanted.emplace_back(action, "");
    }
    std::vector<TomlKey> keys;
    keys.reserve(wanted.size());
    for (auto& [action, value] : wanted) keys.push_back({action_name(action), &value});
    const std::vector<std::string> present = reader.read(text, keys);
    for (const auto& [action, value] : wanted) {
        const std::string key = std::string(action_name(action)) + ": ";
        if (std::find(present.begin(), present.end(), action_name(action)) == present.end()) continue;
        std::vector<KeyStroke> strokes;
        for (const std::string_view word : words_of(value)) {
            const auto stroke = read_stroke(word);
            if (!stroke)
                reader.fail(
                    key,
                    "'" + std::string(word) +
                        "' is no key: a letter or sign, Home, Enter, Esc or Space, after Ctrl+ or Shift+");
            if (action == KeyAction::arm && !stroke->control)
                reader.fail(key, "arming takes two keys together: Ctrl+ and another");
            strokes.push_back(*stroke);
        }
        if (strokes.empty()) reader.fail(key, "needs a key");
        table.replace(action, strokes);
    }
    for (const KeyRow& a : table.rows_)
        for (const KeyRow& b : table.rows_)
            if (&a < &b && collide(a, b))
                reader.fail(std::string(action_name(a.action)) + ": ",
                            std::string(a.keys) + " is also the key of " + action_name(b.action));
    return table;
}

std::string KeyTable::text() const {
    std::string text = "# Keys of Tact's window. Several keys of an action are separated by spaces.\n";
    std::vector<KeyAction> done{KeyAction::none};
    for (const KeyRow& row : rows_) {
        if (row.last != '\0' || std::find(done.begin(), done.end(), row.action) != done.end()) continue;
        done.push_back(row.action);
        std::vector<std::string> strokes;
        for (const KeyRow& other : rows_)
            if (other.action == row.action &&
                std::find(strokes.begin(), strokes.end(), stroke_text(other.stroke)) == strokes.end())
                strokes.push_back(stroke_text(other.stroke));
        std::string all;
        for (const std::string& stroke : strokes) {
            if (!all.empty()) all += ' ';
            for (const char c : stroke) {
                if (c == '"' || c == '\\') all += '\\';
                all += c;
            }
        }
        std::string entry = std::string(action_name(row.action)) + " = \"" + all + "\"";
        entry.resize(std::max<std::size_t>(entry.size(), 40), ' ');
        text += entry + "# " + row.what + "\n";
    }
    return text;
}

}  // namespace tact
