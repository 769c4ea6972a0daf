// Histogram of cycle lateness, logarithmic on both axes: one late cycle in an hour is visible beside three million
// early ones. Colours relate it to the period; four values are also given as text.
#include <algorithm>
#include <cmath>

#include "gui/dashboard/panels.hpp"
#include "gui/dashboard/widgets.hpp"

namespace tact {
namespace {

struct LatenessFrame {
    ImVec2 low, high;  // corners in pixels; low: left and above
    double last_ns;    // right end
    double most;       // highest bar

    [[nodiscard]] float x(double ns) const {
        const double u = std::log(std::max(ns, LatenessBars::kLeastNs) / LatenessBars::kLeastNs) /
                         std::log(last_ns / LatenessBars::kLeastNs);
        return low.x + static_cast<float>(std::clamp(u, 0.0, 1.0)) * (high.x - low.x);
    }
    // A single cycle has a tenth of the height.
    [[nodiscard]] float y(std::uint64_t count) const {
        if (count == 0) return high.y;
        const double u = 0.1 + 0.9 * std::log(static_cast<double>(count)) / std::log(std::max(most, 2.0));
        return high.y - static_cast<float>(std::min(u, 1.0)) * (high.y - low.y);
    }
};

Grade grade_of(double ns, std::int64_t period_ns) {
    return lateness_status(static_cast<std::int64_t>(ns), period_ns).grade;
}

std::string decade_text(double ns) {
    return ns < 1e6 ? format("%g µs", ns * 1e-3) : format("%g ms", ns * 1e-6);
}

}  // namespace

void draw_lateness(const Theme& theme, const DashboardState& state, ImVec2 size, bool whole_run) {
    ImDrawList* const draw = ImGui::GetWindowDrawList();
    const ImVec2 at = ImGui::GetCursorScreenPos();
    ImGui::Dummy(size);
    const float line = theme.small->FontSize;
    const auto label = [&](ImVec2 where, ImU32 c, const std::string& text) {
        draw->AddText(theme.small, line, where, c, text.c_str());
    };
    const auto width_of = [&](const std::string& text) {
        return theme.small->CalcTextSizeA(line, 1e9F, 0.0F, text.c_str()).x;
    };
    const LatenessWindow& l = state.lateness;
    const bool recent = !whole_run && l.recent_metrics().cycles > 0;
    const LatenessMetrics& f = recent ? l.recent_metrics() : l.whole_metrics();
    const std::int64_t period_ns = state.health.period_ns;
    label(at, colour::kText, "Lateness");
    if (!l.empty() && f.cycles > 0)
        label({at.x + width_of("Lateness "), at.y}, colour::kDim,
              recent ? format("last %.0f s", l.recent_s()) : "whole run");
    if (l.empty() || f.cycles == 0) {
        const std::string none =
            state.have_health && period_ns == 0 ? "free running: no lateness" : "no data yet";
        label({at.x + std::max(0.5F * (size.x - width_of(none)), 0.0F), at.y + 0.5F * size.y}, colour::kDim,
              none);
        return;
    }

    // Status text, and the four values in two rows of two.
    const StatusText status = lateness_status(f.p99_ns, period_ns);
    const float words_at = size.x - width_of(status.text);
    if (words_at > width_of("Lateness last 60 s "))
        label({at.x + words_at, at.y}, grade_colour(status.grade), status.text);
    const std::pair<const char*, std::int64_t> metrics[] = {
        {"p50", f.p50_ns}, {"p99", f.p99_ns}, {"p99.9", f.p999_ns}, {"max", f.max_ns}};
    // In two columns if they fit.
    const bool one = 0.5F * size.x < width_of("p99.9  99.9 µs ");
    const std::size_t columns = one ? 1 : 2;
    const float rows = one ? 4.0F : 2.0F;
    for (std::size_t i = 0; i < std::size(metrics); ++i) {
        const ImVec2 where{at.x + 0.5F * size.x * static_cast<float>(i % columns),
                           at.y + (1.08F + 1.02F * static_cast<float>(i / columns)) * line};
        label(where, colour::kDim, metrics[i].first);
        label({where.x + width_of("p99.9  "), where.y}, colour::kText,
              duration_text(1e-9 * static_cast<double>(metrics[i].second)));
    }

    const LatenessBars whole(l.whole()), last(recent ? l.recent() : l.whole());
    const double reach =
        std::max({LatenessBars::edge_ns(whole.last + 2), 1.2 * static_cast<double>(period_ns), 1e5});
    const LatenessFrame frame{{at.x, at.y + (1.55F + rows) * line},
                              {at.x + size.x - 1.0F, at.y + size.y - line - theme.px(3.0F)},
                              reach,
                              static_cast<double>(std::max(whole.most, last.most))};
    draw->PushClipRect({frame.low.x, frame.low.y - 1.0F}, {frame.high.x + 1.0F, frame.high.y + 1.0F}, true);
    const auto bars = [&](const LatenessBars& b, bool filled) {
        for (std::size_t i = 0; i <= b.last; ++i) {
            if (b.count[i] == 0) continue;
            const double from = LatenessBars::edge_ns(i), to = LatenessBars::edge_ns(i + 1);
            const ImU32 c = grade_colour(grade_of(from, period_ns));
            const float x0 = std::floor(frame.x(from)),
                        x1 = std::max(std::floor(frame.x(to)) - 1.0F, x0 + 1.0F);
            const float y = std::floor(frame.y(b.count[i]));
            if (filled) {
                draw->AddRectFilled({x0, y}, {x1, frame.high.y}, c);
            } else {
                draw->AddRectFilled({x0, y}, {x1, frame.high.y},
                                    (colour::kDim & 0x00FFFFFFU) | (0x40U << 24U));
            }
        }
    };
    if (recent) bars(whole, false);
    bars(last, true);
    draw->AddRectFilled({frame.low.x, frame.high.y}, {frame.high.x, frame.high.y + 1.0F}, colour::kGrid);
    if (period_ns > 0) {
        const float x = std::round(frame.x(static_cast<double>(period_ns)));
        for (float y = frame.low.y; y < frame.high.y; y += theme.px(7.0F))
            draw->AddRectFilled({x, y}, {x + theme.px(1.0F), y + theme.px(3.5F)}, colour::kText);
    }
    draw->PopClipRect();
    float free_from = frame.low.x;
    for (double ns = 1e3; ns <= 1.01 * reach; ns *= 10.0) {
        const float x = std::round(frame.x(ns));
        draw->AddRectFilled({x, frame.high.y}, {x + 1.0F, frame.high.y + theme.px(3.0F)}, colour::kDim);
        const std::string text = decade_text(ns);
        const float left = std::clamp(x - 0.5F * width_of(text), frame.low.x,
                                      std::max(frame.high.x - width_of(text), frame.low.x));
        if (left < free_from) continue;
        label({left, frame.high.y + theme.px(2.0F)}, colour::kDim, text);
        free_from = left + width_of(text) + theme.px(6.0F);
    }
    if (ImGui::IsMouseHoveringRect(at, {at.x + size.x, at.y + size.y})) {
        const auto words = [&](const char* name, const LatenessMetrics& g) {
            return format("%s: %s cycles, p50 %s, p99 %s, p99.9 %s, max %s", name, grouped(g.cycles).c_str(),
                          duration_text(1e-9 * static_cast<double>(g.p50_ns)).c_str(),
                          duration_text(1e-9 * static_cast<double>(g.p99_ns)).c_str(),
                          duration_text(1e-9 * static_cast<double>(g.p999_ns)).c_str(),
                          duration_text(1e-9 * static_cast<double>(g.max_ns)).c_str());
        };
        std::string text = words("whole run", l.whole_metrics());
        if (l.recent_metrics().cycles > 0)
            text += "\n" + words(format("last %.0f s", l.recent_s()).c_str(), l.recent_metrics());
        text +=
            "\nColour: selected span. Grey: whole run. Dashed line: one period."
            "\nGreen: below a tenth of the period. Amber: below half. Red: above.";
        ImGui::SetTooltip("%s", text.c_str());
    }
}

}  // namespace tact
