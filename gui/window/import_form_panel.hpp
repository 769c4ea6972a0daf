// Draws the dialog before an import.
//
// Thread  frame thread, inside an ImGui frame
#pragma once

#include "gui/dashboard/theme.hpp"
#include "gui/window/import_form.hpp"

namespace tact {

void draw_import_form(const Theme& theme, ImportForm& form);

}  // namespace tact
