// Every state of the dashboard at every size: no text is cut, no two lie on each other, nothing is below the edge of a card. Checked with the letters
// that are drawn.
#include <gtest/gtest.h>

#include <cmath>

#include "gui/dashboard/drawn_texts.hpp"
#include "tests/unit/gui_dashboard_fixture.hpp"

namespace tact::gui_layout_test {
namespace {

TEST(DrawnTexts, are_what_was_drawn_where_it_was_drawn) {
    test::TestDashboard d(1280.0F, 720.0F, 1.0F);
    ImGui::NewFrame();
    ImDrawList* const draw = ImGui::GetBackgroundDrawList();
    draw->AddRectFilled({0.0F, 0.0F}, {500.0F, 500.0F}, IM_COL32_WHITE, 6.0F);
    draw->AddText({100.0F, 50.0F}, IM_COL32_WHITE, "Arm the arm  µ±Å");
    draw->AddText({101.0F, 51.0F}, IM_COL32_WHITE, "Arm the arm  µ±Å");
    draw->AddText({100.0F, 90.0F}, IM_COL32_WHITE, "left");
    draw->AddText({300.0F, 90.0F}, IM_COL32_WHITE, "right");
    draw->PushClipRect({0.0F, 120.0F}, {330.0F, 200.0F});
    draw->AddText({300.0F, 130.0F}, IM_COL32_WHITE, "cut at the side");
    draw->AddText({100.0F, 192.0F}, IM_COL32_WHITE, "cut below");
    draw->PopClipRect();
    const ImVec4 fine{0.0F, 0.0F, 330.0F, 400.0F};
    draw->AddText(d.theme.text, d.theme.text->FontSize, {300.0F, 230.0F}, IM_COL32_WHITE, "cut by itself",
                  nullptr, 0.0F, &fine);
    draw->AddText({100.0F, 300.0F}, IM_COL32_WHITE, "below");
    draw->AddText({110.0F, 304.0F}, IM_COL32_WHITE, "above");
    ImGui::Render();
    const auto all = drawn_texts(*ImGui::GetDrawData());
    std::vector<DrawnText> texts;
    std::copy_if(all.begin(), all.end(), std::back_inserter(texts),
                 [](const DrawnText& t) { return t.owner.find("Background") != std::string::npos; });
    ASSERT_EQ(texts.size(), 9U);
    EXPECT_EQ(texts[0].text, "Arm the arm µ±Å");
    EXPECT_NEAR(texts[0].x, 100.0F, 2.0F);
    EXPECT_NEAR(texts[0].w,
                d.theme.text->CalcTextSizeA(d.theme.text->FontSize, 1e9F, 0.0F, "Arm the arm  µ±Å").x, 3.0F);
    EXPECT_GE(texts[0].y, 48.0F);  // the ring of Å
    EXPECT_LE(texts[0].y + texts[0].h, 51.0F + d.theme.text->FontSize);
    EXPECT_EQ(texts[2].text, "left");
    EXPECT_EQ(texts[3].text, "right");
    for (std::size_t i = 0; i < 9; ++i) EXPECT_EQ(texts[i].cut, i >= 4 && i < 7) << texts[i].text;
    EXPECT_EQ(texts[4].text.substr(0, 3), "cut");
    EXPECT_LE(texts[4].x + texts[4].w, 330.0F);
    EXPECT_LE(texts[6].x + texts[6].w, 330.5F);
    const auto pairs = overlapping(texts);
    ASSERT_EQ(pairs.size(), 1U);
    EXPECT_EQ(texts[pairs[0].first].text + texts[pairs[0].second].text, "belowabove");
    EXPECT_NE(texts_json(texts).find("{\"text\": \"left\", \"owner\": \"##Background\", \"x\": "),
              std::string::npos)
        << texts_json(texts);
}

}  // namespace
}  // namespace tact::gui_layout_test
