// The table of shortcuts: every row can be reached, and no two rows conflict.
#include <gtest/gtest.h>

#include <set>

#include "gui/system/keys.hpp"

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
    return now;
}

TEST(Keys, every_row_is_found_only_by_its_stroke_in_its_situation) {
    for (const KeyRow& row : key_rows()) {
        if (row.action == KeyAction::none) continue;
        const char last = row.last != '\0' ? row.last : row.stroke.character;
        for (char c = row.stroke.character; c <= last; ++c) {
            KeyStroke stroke = row.stroke;
            stroke.character = c;
            const KeyFound found = find_key(stroke, where_applies(row.when));
            ASSERT_EQ(found.row, &row) << row.keys;
            EXPECT_EQ(found.place, c - row.stroke.character) << row.keys;
            if (row.when != KeyWhen::always) {
                EXPECT_EQ(find_key(stroke, {}).row, nullptr) << row.keys;
            }
            stroke.control = !stroke.control;
            EXPECT_NE(find_key(stroke, where_applies(row.when)).row, &row) << row.keys;
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
    KeySituation now = where_applies(KeyWhen::bodies);
    const KeyStroke escape{KeyCode::escape, '\0', false, false};
    EXPECT_EQ(find_key(escape, now).row->action, KeyAction::revert);
    now.browser = true;
    EXPECT_EQ(find_key(escape, now).row->action, KeyAction::close_browser);
    now.sheet = true;
    EXPECT_EQ(find_key(escape, now).row->action, KeyAction::close_sheet);
    EXPECT_EQ(find_key({KeyCode::character, 'j', false, false}, now).row, nullptr);
}

}  // namespace
}  // namespace tact::gui_keys_test
