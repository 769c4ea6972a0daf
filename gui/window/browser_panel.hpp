// Contents of the scene list and the user's choices: plain data that the application fills and reads.
#pragma once

#include <array>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "gui/dashboard/pixel_rect.hpp"
#include "gui/dashboard/status_text.hpp"
#include "gui/dashboard/theme.hpp"
#include "gui/window/import_form.hpp"

namespace tact {

struct SceneRow {
    std::string path, name;
    std::string title;       // of a scene
    std::string place;       // as displayed below the name: its folder, whole path or title
    std::string kind;        // docking, surface, drilling; for raw data map, structure, mesh, scan
    std::string size, when;  // as displayed
    std::string trouble;     // why it cannot be opened: missing, not a scene, ...
    bool folder = false, current = false;
    bool raw = false, marked = false;  // raw data: a click marks them instead of opening
};

struct BrowserState {
    bool open = false;
    int tab = 0;  // recently used, a folder, drilled bone
    std::vector<SceneRow> recent, here, drilled;
    std::string recent_trouble;
    std::string folder, folder_trouble;
    bool reading = false;
    bool importing = false, cancel_wanted = false;  // importing: or examining files before an import
    std::optional<double> import_share;             // of the import, 0 to 1, if reported
    std::string
        marks_text;  // result of importing the marked rows, or why nothing can be imported; empty: no mark
    bool marks_import = false,
         marks_add = false;          // they can be imported, or added to the scene that is shown
    bool can_save = false;           // there is a session to save
    std::optional<ImportForm> form;  // drawn in place of the rows until it is answered or cancelled
    std::string message;
    Grade message_grade = Grade::unknown;
    void say(Grade grade, std::string words) {
        message = std::move(words);
        message_grade = grade;
    }
    // The user's choices; emptied by the application.
    std::string scene_wanted, folder_wanted, mark_wanted;
    bool import_wanted = false, clear_wanted = false, session_wanted = false;
    std::string added_scene;  // baked with what is shown and more; waits for the session that continues in it
};

// Over the centre of the view.
void draw_browser(const Theme& theme, BrowserState& browser, const PixelRect& view);

}  // namespace tact
