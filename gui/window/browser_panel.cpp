#include "gui/window/browser_panel.hpp"

#include <algorithm>
#include <array>

#include "gui/dashboard/letters.hpp"
#include "gui/dashboard/widgets.hpp"
#include "gui/window/import_form_panel.hpp"

namespace tact {
namespace {

constexpr ImU32 kHovered = IM_COL32(44, 84, 132, 255);  // dim text stays readable on it

// A check box, left of the row's name.
void tick_box(const Theme& theme, ImVec2 at, bool ticked) {
    ImDrawList* const draw = ImGui::GetWindowDrawList();
    const float side = theme.px(12.0F);
    draw->AddRect(at, {at.x + side, at.y + side}, ticked ? colour::kAccent : colour::kDim);
    if (ticked)
        draw->AddRectFilled({at.x + 0.25F * side, at.y + 0.25F * side},
                            {at.x + 0.75F * side, at.y + 0.75F * side}, colour::kAccent);
}

// A row to click: name and kind, then size and time; below, its folder or its error. Raw data appear only in their
// folder, whose path stands above.
void scene_row(const Theme& theme, const SceneRow& row, float width, BrowserState& browser) {
    const bool usable = row.trouble.empty();
    const float height = theme.px(row.folder || (row.raw && usable) ? 22.0F : 40.0F);
    const ImVec2 at = ImGui::GetCursorScreenPos();
    ImGui::PushID(row.path.c_str());
    ImGui::PushStyleColor(ImGuiCol_HeaderHovered, kHovered);
    ImGui::PushStyleColor(ImGuiCol_HeaderActive, kHovered);
    if (ImGui::Selectable("##row", row.current || row.marked, usable ? 0 : ImGuiSelectableFlags_Disabled,
                          {width, height})) {
        (row.folder ? browser.folder_wanted
         : row.raw  ? browser.mark_wanted
                    : browser.scene_wanted) = row.path;
    }
    ImGui::PopStyleColor(2);
    ImGui::PopID();
    ImDrawList* const draw = ImGui::GetWindowDrawList();
    const float pad = theme.px(6.0F);
    const auto text = [&](ImFont* font, float x, float y, ImU32 c, const std::string& words, float most) {
        draw->AddText(font, font->FontSize, {x, at.y + y}, c, cut_text(font, words, most).c_str());
    };
    if (row.folder) {
        text(theme.text, at.x + pad, theme.px(2.0F), colour::kAccent, row.name + "/", width);
        return;
    }
    const float name = at.x + pad + (row.raw ? theme.px(20.0F) : 0.0F);
    const bool narrow = width < theme.px(420.0F);  // without size and time
    const float kind = at.x + width - theme.px(narrow ? 74.0F : 250.0F),
                size = at.x + width - theme.px(176.0F), when = at.x + width - theme.px(96.0F);
    if (row.raw) tick_box(theme, {at.x + pad, at.y + theme.px(5.0F)}, row.marked);
    text(theme.bold, name, theme.px(2.0F), usable ? colour::kText : colour::kDim, row.name,
         kind - name - pad);
    text(theme.text, kind, theme.px(2.0F), row.raw ? colour::kOrange : colour::kAccent, row.kind,
         theme.px(70.0F));
    if (!narrow) text(theme.text, size, theme.px(2.0F), colour::kDim, row.size, theme.px(76.0F));
    if (!narrow) text(theme.text, when, theme.px(2.0F), colour::kDim, row.when, theme.px(96.0F));
    const std::string below = !usable       ? row.trouble
                              : row.current ? "shown now, " + row.place
                              : row.raw     ? ""
                                            : row.place;
    text(theme.small, name, theme.px(21.0F), usable ? colour::kDim : colour::kWatch, below,
         at.x + width - name - pad);
}

void rows(const Theme& theme, const std::vector<SceneRow>& list, BrowserState& browser) {
    const float width = ImGui::GetContentRegionAvail().x;
    for (const SceneRow& row : list) scene_row(theme, row, width, browser);
}

void import_line(const Theme& theme, BrowserState& browser) {
    if (ImGui::SmallButton("Cancel")) browser.cancel_wanted = true;
    if (!browser.import_share) return;
    ImGui::SameLine();
    ImGui::PushStyleColor(ImGuiCol_PlotHistogram, colour::kAccent);
    ImGui::ProgressBar(static_cast<float>(*browser.import_share), {-1.0F, theme.px(16.0F)}, "");
    ImGui::PopStyleColor();
}

// The result of importing the marked rows, with its buttons; as high as marks_height().
constexpr float kMarksButtons = 130.0F;
float marks_height(const Theme& theme, const BrowserState& browser) {
    if (browser.marks_text.empty()) return 0.0F;
    const float room = ImGui::GetContentRegionAvail().x - theme.px(kMarksButtons);
    return std::max(ImGui::CalcTextSize(browser.marks_text.c_str(), nullptr, false, room).y,
                    ImGui::GetFrameHeight()) +
           2.0F * ImGui::GetStyle().ItemSpacing.y;
}
void marks_line(const Theme& theme, BrowserState& browser) {
    ImGui::Separator();
    const bool can = browser.marks_import || browser.marks_add;
    ImGui::BeginDisabled(!can || browser.importing);
    if (ImGui::Button(browser.marks_add ? "Add" : "Import")) browser.import_wanted = true;
    ImGui::EndDisabled();
    ImGui::SameLine();
    if (ImGui::Button("Clear")) browser.clear_wanted = true;
    ImGui::SameLine(theme.px(kMarksButtons));
    ImGui::AlignTextToFramePadding();
    ImGui::PushTextWrapPos(0.0F);
    text_coloured(can ? colour::kText : colour::kWatch, browser.marks_text);
    ImGui::PopTextWrapPos();
}

}  // namespace

void draw_browser(const Theme& theme, BrowserState& browser, const PixelRect& view) {
    // Below the text in the view's upper corners, which would be drawn over it.
    const bool small = view.height < theme.px(300.0F);
    const float above = theme.px(small ? 6.0F : 66.0F);
    const float width = std::min(theme.px(660.0F), 0.94F * view.width),
                height = std::min(theme.px(440.0F), std::max(view.height - above - theme.px(10.0F), 1.0F));
    const PixelRect card{view.x + 0.5F * (view.width - width), view.y + above, width, height};
    ImGui::GetBackgroundDrawList()->AddRectFilled(
        {card.x, card.y}, {card.x + card.width, card.y + card.height}, IM_COL32(18, 22, 29, 250));
    begin_card(theme, "Scenes", card);
    static constexpr std::array<const char*, 3> kTabs{"Recently used", "Folder", "Drilled bone"};
    const bool one_line = width > theme.px(560.0F);
    if (one_line) {
        ImGui::SameLine(0.0F, theme.px(18.0F));
        choose(theme, kTabs, browser.tab);
    }
    if (browser.can_save) {
        ImGui::SameLine(width - theme.px(168.0F));
        if (ImGui::SmallButton("Save session")) browser.session_wanted = true;
        if (ImGui::IsItemHovered())
            ImGui::SetTooltip(
                "saves scene, bodies, bone, contours, snapshots and view into your Tact folder");
    }
    ImGui::SameLine(width - theme.px(64.0F));
    if (ImGui::SmallButton("Close")) browser.open = false;
    if (!one_line) choose(theme, kTabs, browser.tab);
    if (!browser.message.empty()) {
        ImGui::PushTextWrapPos(0.0F);
        text_coloured(grade_colour(browser.message_grade), browser.message);
        ImGui::PopTextWrapPos();
    }
    if (browser.importing) import_line(theme, browser);
    if (browser.form) {
        draw_import_form(theme, *browser.form);
        end_card();
        return;
    }
    if (browser.tab == 1) text_small(theme, colour::kDim, browser.folder);
    if (browser.tab == 2)
        text_small(theme, colour::kDim,
                   "Bone of this scene as earlier runs left it. Opening one ends the present run, whose bone "
                   "is kept.");
    static const std::string kNone;
    const std::string& trouble = browser.tab == 0   ? browser.recent_trouble
                                 : browser.tab == 1 ? browser.folder_trouble
                                                    : kNone;
    if (!trouble.empty()) {
        ImGui::PushTextWrapPos(0.0F);
        text_coloured(colour::kWatch, trouble);
        ImGui::PopTextWrapPos();
    }
    const float below = marks_height(theme, browser);
    ImGui::BeginChild("rows", {0.0F, -below}, false, ImGuiWindowFlags_NoBackground);
    const std::vector<SceneRow>& list = browser.tab == 0   ? browser.recent
                                        : browser.tab == 1 ? browser.here
                                                           : browser.drilled;
    rows(theme, list, browser);
    if (browser.reading) {
        text_coloured(colour::kDim, "reading ...");
    } else if (browser.tab == 0 && list.empty() && trouble.empty()) {
        text_coloured(colour::kDim, "No recent scenes. The Folder tab shows scenes and raw data.");
    } else if (browser.tab == 2 && list.empty()) {
        text_coloured(colour::kDim, "No drilled bone of this scene is kept.");
    } else if (browser.tab == 1 && trouble.empty() &&
               std::none_of(list.begin(), list.end(), [](const SceneRow& r) { return !r.folder; })) {
        text_coloured(colour::kDim, "This folder has no files that Tact reads.");
    }
    ImGui::EndChild();
    if (below > 0.0F) marks_line(theme, browser);
    end_card();
}

}  // namespace tact
