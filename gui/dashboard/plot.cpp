#include "gui/dashboard/plot.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "gui/dashboard/widgets.hpp"

namespace tact {
namespace {

std::string mark_text(double v) {
    if (v != 0.0 && (std::fabs(v) >= 1e4 || std::fabs(v) < 1e-2)) {
        if (std::fabs(v) >= 1e4 && std::fabs(v) < 1e6) return format("%gk", v * 1e-3);
        return format("%.0e", v);
    }
    return format("%g", v);
}

std::string span_text(double s) {
    if (s < 120.0) return format("%.0f s", s);
    if (s < 7200.0) return format("%.0f min", s / 60.0);
    return format("%.0f h", s / 3600.0);
}

struct Frame {
    ImVec2 low, high;  // corners in pixels
    Axis axis;
    bool logarithmic;
    double begin_s, end_s;

    [[nodiscard]] float x(double t_s) const {
        const double u = std::clamp((t_s - begin_s) / (end_s - begin_s), 0.0, 1.0);
        return low.x + static_cast<float>(u) * (high.x - low.x);
    }
    [[nodiscard]] float y(double v) const {
        double u = 0.0;
        if (logarithmic)
            u = v <= axis.low ? 0.0 : std::log(v / axis.low) / std::log(axis.high / axis.low);
        else
            u = (v - axis.low) / (axis.high - axis.low);
        return high.y - static_cast<float>(std::clamp(u, 0.0, 1.0)) * (high.y - low.y);
    }
};

void draw_line(ImDrawList* draw, const Frame& f, const std::vector<PlotBin>& bins, double scale, ImU32 c,
               float thick, bool steps) {
    static thread_local std::vector<ImVec2> points;
    points.clear();
    // Minimum and maximum per pixel column, and a band between them, so that no spike is lost.
    const ImU32 band = (c & 0x00FFFFFFU) | (0x60U << 24U);
    std::size_t i = 0;
    while (i < bins.size()) {
        const float x = std::floor(f.x(bins[i].t_s + 0.5 * bins[i].width_s));
        float low = bins[i].low, high = bins[i].high;
        double sum = 0.0;
        int count = 0;
        for (; i < bins.size() && std::floor(f.x(bins[i].t_s + 0.5 * bins[i].width_s)) <= x; ++i) {
            low = std::min(low, bins[i].low);
            high = std::max(high, bins[i].high);
            sum += 0.5 * (static_cast<double>(bins[i].low) + static_cast<double>(bins[i].high));
            ++count;
        }
        const float top = f.y(scale * static_cast<double>(high)),
                    bottom = f.y(scale * static_cast<double>(low));
        if (bottom - top > 1.5F) draw->AddRectFilled({x, top}, {x + 1.0F, bottom}, band);
        const ImVec2 point{x + 0.5F, f.y(scale * sum / count)};
        if (steps && !points.empty() && points.back().y != point.y)
            points.push_back({point.x, points.back().y});
        points.push_back(point);
    }
    if (points.size() == 1) draw->AddCircleFilled(points[0], 1.5F * thick, c, 8);
    draw->AddPolyline(points.data(), static_cast<int>(points.size()), c, 0, thick);
}

// Triangles at the upper edge, where values lie above the axis.
void mark_clipped(ImDrawList* draw, const Frame& f, const std::vector<PlotBin>& bins, double scale,
                  float half) {
    float before = -1e9F;
    for (const PlotBin& b : bins) {
        if (scale * static_cast<double>(b.high) <= f.axis.high * (1.0 + 1e-6)) continue;
        const float x = std::floor(f.x(b.t_s + 0.5 * b.width_s)) + 0.5F;
        if (x - before < half) continue;
        before = x;
        draw->AddTriangleFilled({x, f.low.y - 1.0F}, {x + half, f.low.y + 1.5F * half},
                                {x - half, f.low.y + 1.5F * half}, colour::kWatch);
    }
}

struct Values {
    double low = 1e300, high = -1e300;  // shown unit; low: of the positive ones, for a logarithmic axis
    double high_at_s = 0.0;
    double top = -1e300;  // to where the axis shows them
};
Values values_of(const PlotSpec& spec, double begin_s, std::vector<PlotBin>& bins) {
    static thread_local std::vector<float> highs;
    Values v;
    for (const PlotLine& l : spec.lines) {
        l.series->window(begin_s, spec.now_s, bins);
        highs.clear();
        for (const PlotBin& b : bins) {
            if (!spec.logarithmic || b.low > 0.0F)
                v.low = std::min(v.low, spec.scale * static_cast<double>(b.low));
            highs.push_back(b.high);
            const double high = spec.scale * static_cast<double>(b.high);
            if (high <= v.high) continue;
            v.high = high;
            v.high_at_s = b.t_s + 0.5 * b.width_s;
        }
        if (!highs.empty()) v.top = std::max(v.top, spec.scale * axis_top(highs));
    }
    if (spec.logarithmic) v.top = v.high;
    return v;
}

}  // namespace

PlotHover draw_plot(const Theme& theme, const PlotSpec& spec, ImVec2 size) {
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

    static thread_local std::vector<PlotBin> bins;
    const double begin_s = spec.now_s - spec.span_s;
    const Values values = values_of(spec, begin_s, bins);
    const double low = values.low;
    const bool any = values.high > -1e300;
    const double high = std::max({any ? values.top : 0.0, spec.least_top, 1.05 * spec.goal});
    const int marks = std::max(2, static_cast<int>(size.y / theme.px(34.0F)));
    Axis axis = spec.logarithmic ? log_axis(low < 1e300 ? low : 1.0, high) : linear_axis(high, marks);
    if (spec.fixed_top > 0.0) axis = linear_axis(spec.fixed_top, 2);

    float gutter = 0.0F;
    for (const double v : axis.mark) gutter = std::max(gutter, width_of(mark_text(v)));
    const auto rows = static_cast<float>(std::max<std::size_t>(spec.text.size(), 1));
    Frame f{{at.x + gutter + theme.px(5.0F), at.y + (1.1F + rows) * line + theme.px(9.0F)},
            {at.x + size.x - 1.0F, at.y + size.y - line - theme.px(3.0F)},
            axis,
            spec.logarithmic,
            begin_s,
            spec.now_s};

    // Title and unit, then the legend with the newest values; clipped to this plot.
    draw->PushClipRect(at, {at.x + size.x, at.y + size.y}, true);
    const std::string title = std::string(spec.title) + " ";
    draw->AddText(theme.small, line, at, colour::kText, title.c_str());
    label({at.x + width_of(title), at.y}, colour::kDim, "[" + std::string(spec.unit) + "]");
    const auto swatch = [&](float x, float y, ImU32 c) {
        draw->AddRectFilled({x, y + 0.47F * line}, {x + theme.px(8.0F), y + 0.47F * line + theme.px(3.0F)},
                            c);
    };
    for (std::size_t i = 0; i < spec.text.size(); ++i) {
        const float y = at.y + (1.08F + static_cast<float>(i)) * line;
        if (i < spec.lines.size()) swatch(at.x, y, spec.lines[i].colour);
        label({at.x + theme.px(11.0F), y}, colour::kDim,
              cut_text(theme.small, spec.text[i], size.x - theme.px(11.0F)));
    }
    const auto legend = [&](const PlotLine& l, bool with_value) {
        const std::string name = l.name;
        if (!with_value || l.series->empty()) return name;
        return name + " " + format("%.3g", spec.scale * static_cast<double>(l.series->last()));
    };
    float legend_width = 0.0F;
    for (const PlotLine& l : spec.lines) legend_width += width_of(legend(l, true)) + theme.px(20.0F);
    const bool with_values = legend_width < size.x + theme.px(9.0F);
    float x = at.x;
    for (const PlotLine& l : spec.lines) {
        if (!spec.text.empty()) break;
        const std::string text = legend(l, with_values);
        swatch(x, at.y + 1.08F * line, l.colour);
        x += theme.px(11.0F);
        label({x, at.y + 1.08F * line}, colour::kDim, text);
        x += width_of(text) + theme.px(9.0F);
    }

    float last_label = 1e9F;
    for (const double v : axis.mark) {
        const float y = std::round(f.y(v));
        draw->AddRectFilled({f.low.x, y}, {f.high.x, y + 1.0F}, colour::kGrid);
        if (last_label - y < 1.05F * line) continue;
        last_label = y;
        const std::string text = mark_text(v);
        label({f.low.x - theme.px(4.0F) - width_of(text), y - 0.55F * line}, colour::kDim, text);
    }
    for (int i = 1; i < 4; ++i) {
        const float gx = std::round(f.low.x + 0.25F * static_cast<float>(i) * (f.high.x - f.low.x));
        draw->AddRectFilled({gx, f.low.y}, {gx + 1.0F, f.high.y}, colour::kGrid);
    }
    const std::string past = "-" + span_text(spec.span_s);
    label({f.low.x, f.high.y + theme.px(2.0F)}, colour::kDim, past);
    label({f.high.x - width_of("now"), f.high.y + theme.px(2.0F)}, colour::kDim, "now");

    draw->PushClipRect({f.low.x, f.low.y - 2.0F}, {f.high.x + 1.0F, f.high.y + 2.0F}, true);
    if (spec.goal > 0.0) {
        const float y = f.y(spec.goal);
        for (float dash = f.low.x; dash < f.high.x; dash += theme.px(8.0F))
            draw->AddRectFilled({dash, y}, {dash + theme.px(4.0F), y + theme.px(1.0F)}, colour::kText);
    }
    for (const PlotLine& l : spec.lines) {
        l.series->window(begin_s, spec.now_s, bins);
        draw_line(draw, f, bins, spec.scale, l.colour, theme.px(1.3F), spec.steps);
    }
    const bool clipped = !spec.logarithmic && values.high > axis.high * (1.0 + 1e-6);
    if (clipped) {
        for (const PlotLine& l : spec.lines) {
            l.series->window(begin_s, spec.now_s, bins);
            mark_clipped(draw, f, bins, spec.scale, theme.px(4.0F));
        }
        // Beside the mark of the largest value, and on the side with more room.
        const std::string most = format("max %.4g ", values.high) + spec.unit;
        const float at_x = f.x(values.high_at_s), aside = theme.px(11.0F), wide = width_of(most);
        const bool left = at_x > 0.5F * (f.low.x + f.high.x);
        const ImVec2 words{std::clamp(left ? at_x - aside - wide : at_x + aside, f.low.x, f.high.x - wide),
                           f.low.y};
        draw->AddRectFilled(words, {words.x + wide, words.y + line}, colour::kPanel);
        label(words, colour::kWatch, most);
    }
    PlotHover hover;
    if (any && ImGui::IsMouseHoveringRect(f.low, f.high)) {
        const float mouse = ImGui::GetIO().MousePos.x;
        hover = {true, begin_s + static_cast<double>((mouse - f.low.x) / (f.high.x - f.low.x)) * spec.span_s};
        draw->AddRectFilled({mouse, f.low.y}, {mouse + 1.0F, f.high.y}, colour::kDim);
    }
    draw->PopClipRect();
    draw->PopClipRect();
    if (!any) {
        const std::string none = "no data yet";
        label({0.5F * (f.low.x + f.high.x - width_of(none)), 0.5F * (f.low.y + f.high.y) - 0.5F * line},
              colour::kDim, none);
    }
    return hover;
}

}  // namespace tact
