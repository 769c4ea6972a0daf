// The card of a field scene.
#include <gtest/gtest.h>

#include "gui/field/field_panels.hpp"
#include "tests/unit/gui_dashboard_fixture.hpp"

namespace tact::gui_field_card_test {
namespace {

TEST(FieldPanels, the_card_is_drawn) {
    test::TestDashboard d(1280.0F, 800.0F, 1.0F);
    FieldPanels panels;
    ImGui::NewFrame();
    draw_dashboard(d.theme, d.state, panels, 1280.0F, 800.0F);
    ImGui::Render();
    EXPECT_NE(ImGui::FindWindowByName("Field at the tool"), nullptr);
}

}  // namespace
}  // namespace tact::gui_field_card_test
