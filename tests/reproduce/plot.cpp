#include "tests/reproduce/plot.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace tact::plot {

namespace {

constexpr Colour kPaper{255, 255, 255}, kInk{38, 38, 38}, kFaint{228, 228, 228}, kGrey{110, 110, 110};
constexpr Colour kShade{240, 236, 224}, kTint{214, 214, 214};
constexpr double kStripOpacity = 0.6;
constexpr int kStripPx = 8;
constexpr int kTitlePx = 26, kTextPx = 18, kSmallPx = 16;
constexpr int kMargin = 28;
constexpr int kTickPx = 6;
constexpr double kLinePx = 2.2, kGoalPx = 1.8;
constexpr int kLegendGap = 34, kLegendMark = 34;

bool finite(const Point& p) { return std::isfinite(p.x) && std::isfinite(p.y); }

// Grows to take a value in; starts empty.
struct Extent {
    double low = std::numeric_limits<double>::infinity(), high = -std::numeric_limits<double>::infinity();
    void take(double v) {
        if (!std::isfinite(v)) return;
        low = std::min(low, v);
        high = std::max(high, v);
    }
    [[nodiscard]] Range range() const {
        if (!(low <= high)) return {0.0, 1.0};
        if (high - low > 1e-12 * std::max(std::abs(low), std::abs(high))) return {low, high};
        const double half = low == 0.0 ? 1.0 : 0.5 * std::abs(low);
        return {low - half, high + half};
    }
};

Range x_range(const Plot& plot) {
    Extent e;
    for (const Panel& panel : plot.panels) {
        for (const Curve& c : panel.curves)
            for (const Point& p : c.points)
                if (finite(p)) e.take(p.x);
        for (const Span& s : panel.spans) {
            e.take(s.x_from);
            e.take(s.x_to);
        }
    }
    return e.range();
}

Range y_range(const Panel& panel) {
    Extent e;
    e.take(0.0);
    for (const Curve& c : panel.curves)
        for (const Point& p : c.points)
            if (finite(p)) e.take(p.y);
    for (const Goal& g : panel.goals) e.take(g.y);
    Range r = e.range();
    const double room = 0.06 * (r.high - r.low);
    if (r.high > 0.0) r.high += room;  // room above the highest value, none below zero
    if (r.low < 0.0) r.low -= room;
    if (std::isfinite(panel.y_min)) r.low = panel.y_min;
    if (std::isfinite(panel.y_max)) r.high = panel.y_max;
    if (!(r.high > r.low)) r.high = r.low + 1.0;
    return r;
}

struct LegendItem {
    std::string name;
    Colour colour;
    enum class Mark { line, dashes, goal, patch } mark;
    double width_px;
};

std::vector<LegendItem> legend_of(const Panel& panel, const std::vector<Colour>& colours, const Font& font) {
    std::vector<LegendItem> items;
    const auto add = [&](const std::string& name, Colour colour, LegendItem::Mark mark) {
        const bool known = std::any_of(items.begin(), items.end(),
                                       [&](const LegendItem& i) { return i.name == name && i.mark == mark; });
        if (!name.empty() && !known)
            items.push_back({name, colour, mark, kLegendMark + 10 + font.width(name, kTextPx)});
    };
    for (std::size_t i = 0; i < panel.curves.size(); ++i)
        add(panel.curves[i].name, colours[i],
            panel.curves[i].dashed ? LegendItem::Mark::dashes : LegendItem::Mark::line);
    for (const Goal& g : panel.goals) add(g.name, kInk, LegendItem::Mark::goal);
    for (const Span& s : panel.spans) add(s.name, s.colour < 0 ? kShade : kTint, LegendItem::Mark::patch);
    return items;
}

// Rows of a legend that is `width` wide.
int legend_rows(const std::vector<LegendItem>& items, double width) {
    int rows = items.empty() ? 0 : 1;
    double x = 0.0;
    for (const LegendItem& i : items) {
        if (x > 0.0 && x + i.width_px > width) {
            ++rows;
            x = 0.0;
        }
        x += i.width_px + kLegendGap;
    }
    return rows;
}

void draw_legend(Canvas& canvas, const Font& font, const std::vector<LegendItem>& items, const Box& in) {
    const int row_px = kTextPx + 10;
    double x = in.left, y = in.top;
    const Box all{0, 0, canvas.image().width, canvas.image().height};
    for (const LegendItem& i : items) {
        if (x > in.left && x + i.width_px > in.right) {
            x = in.left;
            y += row_px;
        }
        const double middle = y + row_px / 2.0;
        const std::array<Pixel, 2> mark{Pixel{x, middle}, Pixel{x + kLegendMark, middle}};
        switch (i.mark) {
            case LegendItem::Mark::line:
                canvas.polyline(mark, i.colour, kLinePx + 1.0, all);
                break;
            case LegendItem::Mark::dashes:
                canvas.polyline(mark, i.colour, kLinePx + 1.0, all, 8.0);
                break;
            case LegendItem::Mark::goal:
                canvas.polyline(mark, i.colour, kGoalPx, all, 5.0);
                break;
            case LegendItem::Mark::patch: {
                const int left = static_cast<int>(x), top = static_cast<int>(middle) - 8;
                canvas.fill({left - 1, top - 1, left + kLegendMark + 1, top + 17}, kGrey, 0.5);
                canvas.fill({left, top, left + kLegendMark, top + 16}, i.colour);
                break;
            }
        }
        canvas.text(font, i.name, {x + kLegendMark + 10, middle + kTextPx * 0.36}, kTextPx, kInk);
        x += i.width_px + kLegendGap;
    }
}

struct Axes {
    Box box;
    Range x, y;
    [[nodiscard]] Pixel at(const Point& p) const {
        return {box.left + (p.x - x.low) / (x.high - x.low) * box.width(),
                box.bottom - (p.y - y.low) / (y.high - y.low) * box.height()};
    }
};

void draw_axes(Canvas& canvas, const Font& font, const Axes& a, const Panel& panel, bool x_numbers) {
    std::array<int, 7> row_of{};  // from 1; by colour
    int rows = 0;
    for (const Span& s : panel.spans) {
        const int from =
            static_cast<int>(std::lround(a.at({std::clamp(s.x_from, a.x.low, a.x.high), 0.0}).x));
        const int to = static_cast<int>(std::lround(a.at({std::clamp(s.x_to, a.x.low, a.x.high), 0.0}).x));
        Box box{from, a.box.top, std::max(to, from + 1), a.box.bottom};
        if (s.colour < 0) {
            canvas.fill(box, kShade);
            continue;
        }
        int& row = row_of[static_cast<std::size_t>(s.colour) % row_of.size()];
        if (row == 0) row = ++rows;
        box.top += (row - 1) * (kStripPx + 1);
        box.bottom = box.top + kStripPx;
        canvas.fill(box, okabe_ito(s.colour), kStripOpacity);
    }
    const auto step_of = [](const std::vector<double>& t) { return t.size() > 1 ? t[1] - t[0] : 1.0; };
    const auto ys = ticks(a.y, std::max(a.box.height() / 55, 2));
    for (const double v : ys) {
        const int y = std::min(static_cast<int>(std::lround(a.at({a.x.low, v}).y)), a.box.bottom - 1);
        canvas.fill({a.box.left, y, a.box.right, y + 1}, kFaint);
        canvas.fill({a.box.left - kTickPx, y, a.box.left, y + 1}, kInk);
        canvas.text(font, tick_text(v, step_of(ys)), {a.box.left - kTickPx - 6.0, y + kSmallPx * 0.36},
                    kSmallPx, kInk, Anchor::right);
    }
    const auto xs = ticks(a.x, std::max(a.box.width() / 110, 2));
    for (const double v : xs) {
        const int x = std::min(static_cast<int>(std::lround(a.at({v, a.y.low}).x)), a.box.right - 1);
        canvas.fill({x, a.box.top, x + 1, a.box.bottom}, kFaint);
        canvas.fill({x, a.box.bottom, x + 1, a.box.bottom + kTickPx}, kInk);
        if (x_numbers)
            canvas.text(font, tick_text(v, step_of(xs)), {x + 0.5, a.box.bottom + kTickPx + 4.0 + kSmallPx},
                        kSmallPx, kInk, Anchor::middle);
    }
    canvas.fill({a.box.left - 1, a.box.top, a.box.left, a.box.bottom + 1}, kInk);
    canvas.fill({a.box.left - 1, a.box.bottom, a.box.right, a.box.bottom + 1}, kInk);
}

void draw_data(Canvas& canvas, const Axes& a, const Panel& panel, const std::vector<Colour>& colours) {
    // Half a line outside the box is drawn too, so that a curve on the border is not thinner.
    const Box cut{a.box.left, a.box.top - 2, a.box.right + 2, a.box.bottom + 2};
    for (const Goal& g : panel.goals) {
        const std::array<Pixel, 2> line{a.at({a.x.low, g.y}), a.at({a.x.high, g.y})};
        canvas.polyline(line, kInk, kGoalPx, cut, 5.0);
    }
    for (std::size_t i = 0; i < panel.curves.size(); ++i) {
        const Curve& c = panel.curves[i];
        for (const auto& piece : decimate(c.points, a.x, a.box.width())) {
            std::vector<Pixel> line;
            line.reserve(piece.size() + 1);
            for (const Point& p : piece) line.push_back(a.at(p));
            if (line.size() == 1) line.push_back(line.front());  // a lonely value is a dot
            canvas.polyline(line, colours[i], kLinePx, cut, c.dashed ? 8.0 : 0.0);
        }
    }
}

}  // namespace

Colour okabe_ito(int number) {
    constexpr std::array<Colour, 7> kColours{Colour{0, 114, 178}, Colour{213, 94, 0},   Colour{0, 158, 115},
                                             Colour{230, 159, 0}, Colour{86, 180, 233}, Colour{204, 121, 167},
                                             Colour{0, 0, 0}};
    const int count = static_cast<int>(kColours.size());
    return kColours[static_cast<std::size_t>(((number % count) + count) % count)];
}

Image draw(const Plot& plot, const Font& font) {
    const int width = std::clamp(plot.width_px, 320, 8192);
    const int panel_height = std::clamp(plot.panel_height_px, 120, 4096);
    const Range x = x_range(plot);

    // Rooms around the axes: the widest number of any panel on the left, legends above each.
    double number_px = 0.0;
    std::vector<std::vector<Colour>> colours;
    std::vector<std::vector<LegendItem>> legends;
    for (const Panel& panel : plot.panels) {
        const auto at = ticks(y_range(panel), std::max(panel_height / 55, 2));
        for (const double v : at)
            number_px =
                std::max(number_px, font.width(tick_text(v, at.size() > 1 ? at[1] - at[0] : 1.0), kSmallPx));
        auto& c = colours.emplace_back();
        for (std::size_t i = 0; i < panel.curves.size(); ++i) {
            const int chosen = panel.curves[i].colour;
            c.push_back(okabe_ito(chosen >= 0 ? chosen : static_cast<int>(i)));
        }
        legends.push_back(legend_of(panel, c, font));
    }
    const int left = kMargin + static_cast<int>(std::ceil(number_px)) + kTickPx + 8;
    const int right = width - kMargin - 12;  // half of the last number lies outside the box
    const int row_px = kTextPx + 10;
    int height = kMargin;
    if (!plot.title.empty()) height += kTitlePx + 8;
    if (!plot.remark.empty()) height += kTextPx + 8;
    const int top = height;
    for (const auto& legend : legends)
        height += row_px * (1 + legend_rows(legend, right - left)) + 10 + panel_height + 26;
    height += kSmallPx + row_px + kMargin / 2;

    Canvas canvas(width, height, kPaper);
    int y = kMargin;
    if (!plot.title.empty())
        canvas.text(font, plot.title, {static_cast<double>(kMargin), y + kTitlePx * 0.8}, kTitlePx, kInk);
    if (!plot.title.empty()) y += kTitlePx + 8;
    if (!plot.remark.empty())
        canvas.text(font, plot.remark, {static_cast<double>(kMargin), y + kTextPx * 0.8}, kTextPx, kGrey);
    y = top;
    for (std::size_t i = 0; i < plot.panels.size(); ++i) {
        const Panel& panel = plot.panels[i];
        canvas.text(font, panel.y_label, {static_cast<double>(kMargin), y + row_px * 0.75}, kTextPx, kInk);
        y += row_px;
        const int rows = legend_rows(legends[i], right - left);
        draw_legend(canvas, font, legends[i], {left, y, right, y + rows * row_px});
        y += rows * row_px + 10;
        const Axes axes{{left, y, right, y + panel_height}, x, y_range(panel)};
        draw_axes(canvas, font, axes, panel, i + 1 == plot.panels.size());
        draw_data(canvas, axes, panel, colours[i]);
        y += panel_height + 26;
    }
    canvas.text(font, plot.x_label, {(left + right) / 2.0, y + kSmallPx + row_px * 0.5}, kTextPx, kInk,
                Anchor::middle);
    return canvas.image();
}

void save(const Plot& plot, const std::filesystem::path& path) { save_png(draw(plot, Font()), path); }

}  // namespace tact::plot
