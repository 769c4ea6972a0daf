// Frame times per pass in a table over the 3D view, drawn with ImGui draw lists on its own background.
#include <algorithm>

#include "gui/dashboard/panels.hpp"
#include "gui/dashboard/widgets.hpp"

namespace tact {
namespace {

constexpr float kNeverRan_s = 1e-9F;

std::string ms(float s) { return s < 0.0F ? std::string("-") : format("%.2f", 1e3 * static_cast<double>(s)); }

struct Table {
    const Theme& theme;
    float x, y, line;

    void cell(float at, ImU32 c, const std::string& text, bool right = true) const {
        ImFont* const font = theme.small;
        const float width = right ? font->CalcTextSizeA(font->FontSize, 1e9F, 0.0F, text.c_str()).x : 0.0F;
        ImGui::GetBackgroundDrawList()->AddText(font, font->FontSize, {x + theme.px(at) - width, y}, c,
                                                text.c_str());
    }
    void row(const char* what, const PassMetrics& p, ImU32 c) {
        cell(0.0F, c, what, false);
        cell(144.0F, c, ms(p.work_p50_s));
        cell(188.0F, c, ms(p.work_p99_s));
        cell(254.0F, c, ms(p.drawn_p50_s));
        cell(296.0F, c, ms(p.drawn_p99_s));
        y += line;
    }
};

}  // namespace

std::string frame_line(const FrameMetrics& f) {
    if (f.window == 0) return {};
    return format("p50 %s ms   p99 %s ms   %s late", ms(f.p50_s).c_str(), ms(f.p99_s).c_str(),
                  grouped(f.late).c_str());
}

void draw_frame_times(const Theme& theme, const FrameMetrics& f, const PixelRect& view) {
    constexpr float kWide = 320.0F;
    const float line = theme.px(17.0F), pad = theme.px(12.0F);
    std::size_t rows = 0;
    for (const PassMetrics& p : f.pass) rows += p.work_p99_s > kNeverRan_s ? 1 : 0;
    const float height = line * static_cast<float>(rows + kVisualPaths + 4) + 2.0F * pad;
    const ImVec2 at{view.x + theme.px(16.0F), view.y + theme.px(60.0F)};
    ImDrawList* const draw = ImGui::GetBackgroundDrawList();
    draw->AddRectFilled(at, {at.x + theme.px(kWide), at.y + height}, IM_COL32(18, 22, 29, 225),
                        theme.px(6.0F));
    Table t{theme, at.x + pad, at.y + pad, line};
    t.cell(0.0F, colour::kText,
           format("frames %s   late %s   due %s ms", grouped(f.frames).c_str(), grouped(f.late).c_str(),
                  f.due_s > 0.0 ? ms(static_cast<float>(f.due_s)).c_str() : "-"),
           false);
    t.y += line;
    t.cell(0.0F, colour::kText,
           format("all: p50 %s   p99 %s   max %s ms", ms(f.run_p50_s).c_str(), ms(f.run_p99_s).c_str(),
                  ms(f.run_most_s).c_str()),
           false);
    t.y += 1.5F * line;
    t.cell(0.0F, colour::kDim, "ms", false);
    for (const auto& [x, text] :
         {std::pair{144.0F, "work p50"}, {188.0F, "p99"}, {254.0F, "drawn p50"}, {296.0F, "p99"}})
        t.cell(x, colour::kDim, text);
    t.y += line;
    for (std::size_t i = 0; i < kPasses; ++i)
        if (f.pass[i].work_p99_s > kNeverRan_s)
            t.row(pass_text(static_cast<Pass>(i)), f.pass[i], colour::kText);
    t.y += 0.5F * line;
    for (std::size_t i = 0; i < kVisualPaths; ++i) t.row(visual_path_text(i), f.path[i], colour::kAccent);
}

}  // namespace tact
