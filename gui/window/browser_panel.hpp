// What the list of scenes shows and what a person chose there: plain data that the application fills and takes.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "gui/dashboard/pixel_rect.hpp"
#include "gui/dashboard/status_text.hpp"
#include "gui/dashboard/theme.hpp"

namespace tact {

struct SceneRow {
    std::string path, name;
    std::string place;       // its folder
    std::string kind;        // docking, surface, drilling; of raw data map, structure, mesh, scan
    std::string size, when;  // as a person reads it
    std::string trouble;     // why it cannot be opened: missing, not a scene, ...
    bool folder = false, current = false;
    bool raw = false, marked = false;  // raw data: pressed to be marked, not opened
};

struct BrowserState {
    bool open = false;
    int tab = 0;  // recently used, a folder
    std::vector<SceneRow> recent, here;
    std::string recent_trouble;
    std::string folder, folder_trouble;
    bool reading = false;
    bool importing = false, cancel_wanted = false;
    std::optional<double> import_share;  // of the import, 0 to 1, where it says
    std::string marks_text;  // what would be made of the marked rows, or why nothing can; empty: no mark
    bool marks_import = false;
    std::string message;
    Grade message_grade = Grade::unknown;
    // What a person chose; emptied by the application.
    std::string scene_wanted, folder_wanted, mark_wanted;
    bool import_wanted = false, clear_wanted = false;
};

// Over the middle of the view.
void draw_browser(const Theme& theme, BrowserState& browser, const PixelRect& view);
// What opens it, in the corner of the view.
void draw_browser_button(const Theme& theme, BrowserState& browser, const PixelRect& view);

}  // namespace tact
