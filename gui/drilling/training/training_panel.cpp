#include "gui/drilling/training/training_panel.hpp"

#include <algorithm>

#include "gui/dashboard/letters.hpp"
#include "gui/dashboard/widgets.hpp"

namespace tact {
namespace {

constexpr float kWidth = 268.0F, kTop = 104.0F;  // below the button of scenes
constexpr ImU32 kCard = IM_COL32(18, 22, 29, 215);

void mark(const OverlayPen& pen, ImVec2 at, float size, TrainingItem::State state) {
    const float t = pen.theme.px(1.8F);
    const ImVec2 m{at.x + 0.5F * size, at.y + 0.5F * size};
    switch (state) {
        case TrainingItem::State::done:
            pen.draw->AddLine({at.x + 0.1F * size, m.y}, {at.x + 0.4F * size, at.y + 0.85F * size},
                              colour::kGood, t);
            pen.draw->AddLine({at.x + 0.4F * size, at.y + 0.85F * size},
                              {at.x + 0.95F * size, at.y + 0.12F * size}, colour::kGood, t);
            return;
        case TrainingItem::State::failed:
            pen.draw->AddLine({at.x + 0.12F * size, at.y + 0.12F * size},
                              {at.x + 0.88F * size, at.y + 0.88F * size}, colour::kBad, t);
            pen.draw->AddLine({at.x + 0.88F * size, at.y + 0.12F * size},
                              {at.x + 0.12F * size, at.y + 0.88F * size}, colour::kBad, t);
            return;
        case TrainingItem::State::open:
            pen.draw->AddCircle(m, 0.38F * size, colour::kDim, 0, t);
    }
}

}  // namespace

void draw_training(const OverlayPen& pen, const TrainingShown& shown, const PixelRect& v) {
    if (!shown.on && shown.problem.empty()) return;
    ImFont* const small = pen.theme.small;
    const float pad = pen.theme.px(12.0F), line = pen.theme.px(20.0F), w = pen.theme.px(kWidth);
    const float text_w = w - 2.0F * pad;
    const std::string& words = shown.problem.empty() ? shown.task : shown.problem;
    const bool tell = !shown.problem.empty() || (!shown.begun && !shown.task.empty());
    const float words_h =
        tell ? small->CalcTextSizeA(small->FontSize, 1e9F, text_w, noted(words)).y + 0.4F * pad : 0.0F;
    const float h = 2.0F * pad + pen.theme.px(22.0F) + words_h +
                    (shown.on ? line * static_cast<float>(shown.score.item.size() + 1) : 0.0F);
    const ImVec2 at{v.x + v.width - w - pen.theme.px(10.0F), v.y + pen.theme.px(kTop)};
    if (at.x < v.x + pen.theme.px(200.0F)) return;  // a narrow view is for the bone
    pen.draw->AddRectFilled(at, {at.x + w, at.y + h}, kCard, pen.theme.px(6.0F));
    pen.draw->AddRect(at, {at.x + w, at.y + h}, colour::kPanelEdge, pen.theme.px(6.0F));
    float y = at.y + pad;
    const float x = at.x + pad, right = at.x + w - pad;
    pen.draw->PushClipRect(at, {at.x + w, at.y + h}, true);
    pen.draw->AddText(
        pen.theme.bold, pen.theme.bold->FontSize, {x, y}, colour::kAccent,
        shown.problem.empty() ? cut_text(pen.theme.bold, shown.title, text_w).c_str() : "No training");
    y += pen.theme.px(22.0F);
    if (tell) {
        pen.draw->AddText(small, small->FontSize, {x, y},
                          shown.problem.empty() ? colour::kDim : colour::kWatch, words.c_str(), nullptr,
                          text_w);
        y += words_h;
    }
    if (shown.on) {
        for (const TrainingItem& i : shown.score.item) {
            mark(pen, {x, y + pen.theme.px(1.0F)}, small->FontSize * 0.85F, i.state);
            const float value_w = pen.width(small, i.value);
            const float name_x = x + pen.theme.px(20.0F);
            pen.draw->AddText(small, small->FontSize, {name_x, y},
                              i.state == TrainingItem::State::failed ? colour::kBad : colour::kText,
                              cut_text(small, i.name, right - value_w - pen.theme.px(8.0F) - name_x).c_str());
            pen.draw->AddText(small, small->FontSize, {right - value_w, y}, colour::kDim, i.value.c_str());
            y += line;
        }
        const std::string points = format("%.0f", shown.score.total);
        pen.draw->AddText(pen.theme.bold, pen.theme.bold->FontSize, {x + pen.theme.px(20.0F), y},
                          colour::kText, (points + " of 100 points").c_str());
    }
    pen.draw->PopClipRect();
}

}  // namespace tact
