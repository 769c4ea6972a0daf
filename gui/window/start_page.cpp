#include "gui/window/start_page.hpp"

#include <algorithm>
#include <cmath>

#include "gui/dashboard/letters.hpp"
#include "gui/dashboard/widgets.hpp"

namespace tact {
namespace {

constexpr float kPageMost = 1160.0F, kGap = 14.0F, kPictureRatio = 560.0F / 350.0F;
constexpr std::size_t kRecentShown = 6;

void heading(const Theme& theme, const char* text) {
    ImGui::PushFont(theme.bold);
    text_coloured(colour::kAccent, text);
    ImGui::PopFont();
}

// Picture, title and what it shows; a click chooses it.
void demo_card(const Theme& theme, const DemoCard& demo, float width, StartPageState& page) {
    const float pad = theme.px(10.0F), picture = std::round(width / kPictureRatio);
    const float wrap = width - 2.0F * pad;
    const float words = theme.small->CalcTextSizeA(theme.small->FontSize, 1e9F, wrap, demo.what).y;
    const float height = picture + theme.px(28.0F) + std::max(words, 2.0F * theme.small->FontSize) + pad;
    const ImVec2 at = ImGui::GetCursorScreenPos();
    ImGui::BeginDisabled(page.preparing);
    if (ImGui::InvisibleButton(demo.name, {width, height})) page.demo_wanted = demo.name;
    const bool hovered = ImGui::IsItemHovered();
    ImGui::EndDisabled();
    ImDrawList* const draw = ImGui::GetWindowDrawList();
    const ImVec2 end{at.x + width, at.y + height};
    draw->AddRectFilled(at, end, colour::kPanel, theme.px(5.0F));
    if (demo.picture != ImTextureID{})
        draw->AddImageRounded(demo.picture, at, {end.x, at.y + picture}, {0.0F, 0.0F}, {1.0F, 1.0F},
                              page.preparing ? IM_COL32(255, 255, 255, 110) : IM_COL32_WHITE, theme.px(5.0F),
                              ImDrawFlags_RoundCornersTop);
    draw->AddRect(at, end, hovered ? colour::kAccent : colour::kPanelEdge, theme.px(5.0F), 0,
                  hovered ? 2.0F : 1.0F);
    const float y = at.y + picture + theme.px(6.0F);
    draw->AddText(theme.bold, theme.bold->FontSize, {at.x + pad, y},
                  page.preparing ? colour::kDim : colour::kText, demo.title);
    draw->AddText(theme.small, theme.small->FontSize, {at.x + pad, y + theme.px(20.0F)}, colour::kDim,
                  demo.what, nullptr, wrap);
}

void demos(const Theme& theme, StartPageState& page, float width) {
    heading(theme, "Demos, with a device or without");
    std::size_t with_picture = 0;
    for (const DemoCard& demo : page.demos) with_picture += demo.what[0] != '\0' ? 1 : 0;
    const float gap = theme.px(kGap), columns = static_cast<float>(std::max<std::size_t>(with_picture, 1));
    const float card = std::floor((width - (columns - 1.0F) * gap) / columns);
    bool first = true;
    for (const DemoCard& demo : page.demos) {
        if (demo.what[0] == '\0') continue;
        if (!std::exchange(first, false)) ImGui::SameLine(0.0F, gap);
        demo_card(theme, demo, card, page);
    }
    ImGui::AlignTextToFramePadding();
    text_coloured(colour::kDim, "Also:");
    ImGui::BeginDisabled(page.preparing);
    for (const DemoCard& demo : page.demos) {
        if (demo.what[0] != '\0') continue;
        ImGui::SameLine();
        if (ImGui::Button(demo.title)) page.demo_wanted = demo.name;
    }
    ImGui::EndDisabled();
}

// Always a line, so that the page does not move when there is something to say.
void progress(const Theme& theme, StartPageState& page) {
    ImGui::AlignTextToFramePadding();
    if (page.preparing) {
        if (ImGui::SmallButton("Cancel")) page.cancel_wanted = true;
        ImGui::SameLine();
        ImGui::PushStyleColor(ImGuiCol_PlotHistogram, colour::kAccent);
        ImGui::ProgressBar(static_cast<float>(page.share.value_or(0.0)), {theme.px(140.0F), theme.px(16.0F)},
                           "");
        ImGui::PopStyleColor();
        ImGui::SameLine();
    }
    const std::string shown = cut_text(ImGui::GetFont(), page.message.text, ImGui::GetContentRegionAvail().x);
    text_coloured(grade_colour(page.message.grade), shown.empty() ? " " : shown);
    if (shown != page.message.text && ImGui::IsItemHovered())
        ImGui::SetTooltip("%s", noted(page.message.text));
}

void recent(const Theme& theme, BrowserState& browser, float width) {
    heading(theme, "Scenes used before");
    ImGui::SameLine(width - theme.px(130.0F));
    if (ImGui::Button("Open file ...", {theme.px(130.0F), 0.0F})) {
        browser.open = true;
        browser.tab = 1;
    }
    if (browser.recent.empty())
        return text_small(
            theme, colour::kDim,
            !browser.recent_trouble.empty() ? browser.recent_trouble
            : browser.reading
                ? "reading ..."
                : "None yet. Drop a map with structures, a mesh or a scan onto this window, or open "
                  "a file.");
    std::size_t shown = 0;
    for (const SceneRow& row : browser.recent) {
        if (!row.trouble.empty()) continue;  // the list of Open file says why
        if (shown++ == kRecentShown) break;
        const ImVec2 at = ImGui::GetCursorScreenPos();
        const float height = theme.px(20.0F);
        ImGui::PushID(row.path.c_str());
        if (ImGui::Selectable("##recent", false, 0, {width, height})) browser.scene_wanted = row.path;
        if (ImGui::IsItemHovered()) ImGui::SetTooltip("%s", noted(row.path));
        ImGui::PopID();
        ImDrawList* const draw = ImGui::GetWindowDrawList();
        const float kind = width - theme.px(170.0F), when = width - theme.px(90.0F);
        const auto text = [&](float x, ImU32 c, const std::string& words, float most) {
            draw->AddText(theme.text, theme.text->FontSize, {at.x + x, at.y}, c,
                          cut_text(theme.text, words, most).c_str());
        };
        text(0.0F, colour::kText, row.name, kind - theme.px(10.0F));
        text(kind, colour::kAccent, row.kind, theme.px(76.0F));
        text(when, colour::kDim, row.when, theme.px(90.0F));
    }
}

void finding(const Theme& theme, const char* what, const StartFinding& found, float width) {
    ImGui::BeginGroup();
    heading(theme, what);
    ImGui::PushTextWrapPos(ImGui::GetCursorPosX() + width);
    text_coloured(grade_colour(found.status.grade), found.status.text);
    ImGui::PopTextWrapPos();
    ImGui::EndGroup();
    if (!found.detail.empty() && ImGui::IsItemHovered()) {
        ImGui::BeginTooltip();
        ImGui::PushTextWrapPos(theme.px(560.0F));
        ImGui::TextUnformatted(noted(found.detail));
        ImGui::PopTextWrapPos();
        ImGui::EndTooltip();
    }
    ImGui::Dummy({0.0F, theme.px(6.0F)});
}

}  // namespace

void draw_start_page(const Theme& theme, StartPageState& page, BrowserState& browser, const PixelRect& area) {
    const float width = std::min(theme.px(kPageMost), area.width - 2.0F * theme.px(kGap));
    ImGui::SetNextWindowPos({area.x, area.y});
    ImGui::SetNextWindowSize({area.width, area.height});
    ImGui::Begin("Start", nullptr,
                 ImGuiWindowFlags_NoTitleBar | ImGuiWindowFlags_NoResize | ImGuiWindowFlags_NoCollapse |
                     ImGuiWindowFlags_NoMove | ImGuiWindowFlags_NoSavedSettings |
                     ImGuiWindowFlags_NoBackground | ImGuiWindowFlags_NoBringToFrontOnFocus |
                     ImGuiWindowFlags_NoNav);
    const float left_edge = std::floor(0.5F * (area.width - width));
    ImGui::Indent(std::max(left_edge - ImGui::GetStyle().WindowPadding.x, 1.0F));
    ImGui::BeginDisabled(browser.open);  // its list lies over the page
    ImGui::PushFont(theme.large);
    text_coloured(colour::kText, "Tact");
    ImGui::PopFont();
    text_coloured(colour::kDim, "Feel density maps and structures, surfaces, and bone under a burr.");
    ImGui::Dummy({0.0F, theme.px(4.0F)});
    demos(theme, page, width);
    progress(theme, page);
    ImGui::Dummy({0.0F, theme.px(2.0F)});
    const float left = std::floor(0.6F * width), gap = theme.px(30.0F);
    ImGui::BeginGroup();
    recent(theme, browser, left);
    ImGui::EndGroup();
    ImGui::SameLine(0.0F, 0.0F);
    ImGui::SetCursorPosX(left_edge + left + gap);
    ImGui::BeginGroup();
    finding(theme, "Device", page.device, width - left - gap);
    finding(theme, "This computer", page.computer, width - left - gap);
    ImGui::EndGroup();
    ImGui::EndDisabled();
    ImGui::End();
}

}  // namespace tact
