// The table of shortcuts: every row can be reached, and no two rows conflict.
#include <gtest/gtest.h>

#include <set>

#include "gui/system/keys.hpp"
#include "ipc/base/error.hpp"

namespace tact::gui_keys_test {
namespace {

KeySituation where_applies(KeyWhen when) {
    KeySituation now;
    now.sheet = when == KeyWhen::sheet;
    now.browser = when == KeyWhen::browser;
    now.bodies = when == KeyWhen::bodies;
    now.bone = when == KeyWhen::bone;
    now.stereo = when == KeyWhen::stereo;
    now.controller = when == KeyWhen::controller;
    now.replay = when == KeyWhen::replay;
    now.calibrating = when == KeyWhen::calibrating;
    now.mouse = when == KeyWhen::mouse;
    now.holding = when == KeyWhen::holding;
    return now;
}

TEST(Keys, every_row_is_found_only_by_its_stroke_in_its_situation) {
    const KeyTable table;
    for (const KeyRow& row : table.rows()) {
        if (row.action == KeyAction::none) continue;
        const char last = row.last != '\0' ? row.last : row.stroke.character;
        for (char c = row.stroke.character; c <= last; ++c) {
            KeyStroke stroke = row.stroke;
            stroke.character = c;
            const KeyFound found = table.find(stroke, where_applies(row.when));
            ASSERT_EQ(found.row, &row) << row.keys;
            EXPECT_EQ(found.place, c - row.stroke.character) << row.keys;
            if (row.when != KeyWhen::always) {
                EXPECT_EQ(table.find(stroke, {}).row, nullptr) << row.keys;
            }
            stroke.control = !stroke.control;
            EXPECT_NE(table.find(stroke, where_applies(row.when)).row, &row) << row.keys;
        }
    }
}

TEST(Keys, no_two_rows_that_may_apply_at_once_share_a_stroke) {
    for (const KeyRow& a : key_rows())
        for (const KeyRow& b : key_rows())
            if (&a != &b) {
                EXPECT_FALSE(collide(a, b)) << a.keys << ": " << a.what << " and " << b.what;
            }
    // The check detects a conflict.
    const KeyRow digits{
        {KeyCode::character, '1', false, false}, '9', KeyWhen::bodies, KeyAction::home, "", ""};
    const KeyRow five{{KeyCode::character, '5', false, false}, 0, KeyWhen::always, KeyAction::mark, "", ""};
    KeyRow in_bone = five;
    in_bone.when = KeyWhen::bone;
    EXPECT_TRUE(collide(digits, five));
    EXPECT_FALSE(collide(digits, in_bone));
}

TEST(Keys, every_action_has_a_key_and_every_row_a_text) {
    std::set<KeyAction> acts;
    for (const KeyRow& row : key_rows()) {
        acts.insert(row.action);
        EXPECT_GT(std::string_view(row.keys).size(), 0U);
        EXPECT_GT(std::string_view(row.what).size(), 2U) << row.keys;
    }
    EXPECT_EQ(acts.size(), static_cast<std::size_t>(KeyAction::count));
}

TEST(Keys, a_long_sheet_has_two_columns_if_both_fit) {
    EXPECT_EQ(sheet_columns(13, 40, 2), 1);  // a short sheet stays in one column
    EXPECT_EQ(sheet_columns(24, 40, 2), 2);
    EXPECT_EQ(sheet_columns(24, 40, 1), 1);  // a second column would be cut off at the sides
    EXPECT_EQ(sheet_columns(13, 8, 2), 2);   // short, but too high for the view
}

TEST(Keys, the_sheet_handles_esc_before_the_bodies) {
    const KeyTable table;
    KeySituation now = where_applies(KeyWhen::bodies);
    const KeyStroke escape{KeyCode::escape, '\0', false, false};
    EXPECT_EQ(table.find(escape, now).row->action, KeyAction::revert);
    now.browser = true;
    EXPECT_EQ(table.find(escape, now).row->action, KeyAction::close_browser);
    now.sheet = true;
    EXPECT_EQ(table.find(escape, now).row->action, KeyAction::close_sheet);
    now.holding = true;  // before all else: a person lets go at once
    EXPECT_EQ(table.find(escape, now).row->action, KeyAction::let_go_tool);
    EXPECT_EQ(table.find({KeyCode::character, 'j', false, false}, now).row, nullptr);
}

KeyStroke typed(char c, bool control = false, bool shift = false) {
    return {KeyCode::character, c, control, shift};
}

TEST(KeyTable, a_file_replaces_the_keys_of_the_actions_it_names) {
    const KeyTable own = KeyTable::read(R"(
home_view = "H"
redo = "Ctrl+Y  ctrl+shift+u"
cut = "\\"
disarm = "Space q"
)",
                                        "keys.toml");
    const KeySituation bodies = where_applies(KeyWhen::bodies), bone = where_applies(KeyWhen::bone);
    EXPECT_EQ(own.find(typed('h'), {}).row->action, KeyAction::home);
    EXPECT_STREQ(own.find(typed('h'), {}).row->keys, "H");
    EXPECT_EQ(own.find({KeyCode::home, '\0', false, false}, {}).row, nullptr);
    EXPECT_EQ(own.find(typed('\\'), {}).row->action, KeyAction::cut);
    for (const KeySituation& now : {bodies, bone}) {
        EXPECT_EQ(own.find(typed('u', true, true), now).row->action, KeyAction::redo);
        EXPECT_EQ(own.find(typed('y', true), now).row->action, KeyAction::redo);
        EXPECT_EQ(own.find(typed('z', true, true), now).row, nullptr);
        EXPECT_EQ(own.find(typed('z', true), now).row->action, KeyAction::undo) << "unchanged";
    }
    EXPECT_STRNE(own.find(typed('y', true), bodies).row->what, own.find(typed('y', true), bone).row->what);
    const KeySituation run = where_applies(KeyWhen::controller);
    EXPECT_EQ(own.find(typed('q'), run).row->action, KeyAction::disarm);
    EXPECT_EQ(own.find({KeyCode::space, '\0', false, false}, run).row->action, KeyAction::disarm);
    // A copy lives on alone, and what it prints reads as the same.
    std::optional<KeyTable> first(own);
    const KeyTable copy = *first;
    first.reset();
    EXPECT_STREQ(copy.find(typed('h'), {}).row->keys, "H");
    EXPECT_EQ(KeyTable::read(copy.text(), "again").text(), copy.text());
    EXPECT_NE(copy.text().find("redo = \"Ctrl+Y Ctrl+Shift+U\""), std::string::npos) << copy.text();
}

TEST(KeyTable, the_list_names_every_action_once_and_reads_as_the_built_in_table) {
    const std::string text = KeyTable().text();
    EXPECT_EQ(KeyTable::read(text, "list").text(), text);
    std::set<std::string> names;
    for (std::size_t i = 1; i < static_cast<std::size_t>(KeyAction::count); ++i) {
        const std::string name = action_name(static_cast<KeyAction>(i));
        EXPECT_TRUE(names.insert(name).second) << name;
        const bool range = static_cast<KeyAction>(i) == KeyAction::take_body;
        EXPECT_EQ(text.find("\n" + name + " = ") == std::string::npos, range) << name;
    }
    for (const KeyRow& row : key_rows())
        if (row.action != KeyAction::none && row.last == '\0') {
            EXPECT_EQ(read_stroke(stroke_text(row.stroke)), row.stroke) << row.keys;
            EXPECT_EQ(stroke_text(row.stroke), row.keys);
        }
}

TEST(KeyTable, refuses_what_would_leave_a_person_without_a_key_or_two_actions_with_one) {
    const auto trouble = [](const char* text) {
        try {
            static_cast<void>(KeyTable::read(text, "keys.toml"));
        } catch (const StartupError& e) {
            return std::string(e.what());
        }
        return std::string();
    };
    const auto names = [&](const char* text, const char* what) {
        const std::string why = trouble(text);
        EXPECT_NE(why.find(what), std::string::npos) << why;
        EXPECT_NE(why.find("keys.toml"), std::string::npos) << why;
        EXPECT_NE(why.find("--keys"), std::string::npos) << why;
    };
    names("home_view = \"P\"", "P is also the key of");
    names("disarm = \"\"", "disarm: needs a key");
    names("disarm = \"  \"", "disarm: needs a key");
    names("arm = \"a\"", "arming takes two keys");
    names("home_view = \"F13\"", "'F13' is no key");
    names("home_view = \"Ctrl+\"", "'Ctrl+' is no key");
    names("home_view = 3", "home_view");
    names("hold_body = \"a\"", "hold_body");
    names("fly = \"a\"", "fly");
    names("home_view = ", "keys.toml");
    // The table of keys and the list of scenes take precedence, so Esc may be everybody's.
    EXPECT_EQ(trouble("close_table = \"Esc\""), "");
}

}  // namespace
}  // namespace tact::gui_keys_test
