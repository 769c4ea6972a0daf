#include "gui/stereo/test_picture.hpp"

#include <algorithm>
#include <cmath>

#include "gui/render/camera.hpp"

namespace tact {
namespace {

using Point = PicturePen::Point;

// Left warm, right cold; both are bright enough in an anaglyph's half of the colours.
constexpr Ink kLeft{255, 196, 120, 255}, kRight{110, 220, 255, 255};
constexpr Ink kGrid{70, 84, 104, 255}, kAxis{120, 138, 164, 255}, kLine{225, 232, 242, 255},
    kDim{150, 160, 176, 255};
constexpr Ink kNow{255, 190, 60, 255}, kTaken{80, 214, 140, 255}, kOpen{120, 132, 150, 255},
    kWrong{255, 92, 92, 255}, kTool = kWrong;
constexpr Ink kStep{46, 62, 86, 255};
constexpr double kCellsAcross = 14.0;

// Legible from where the whole display is visible, and on a small one.
double letters_mm(const GlassSize& glass, double share) {
    return std::max(share * std::min(glass.height_mm, 0.56 * glass.width_mm), 13.0 * glass.px_mm);
}

// Smaller if the text would not fit across the display.
double fitted_mm(const GlassSize& glass, double letters, const std::string& words) {
    return letters *
           std::min(1.0, 0.9 * glass.width_mm / std::max(1.0, PicturePen::text_width_mm(letters, words)));
}

std::string millimetres(double mm, bool sign) {
    const auto rounded = static_cast<int>(std::lround(mm));
    return (sign && rounded > 0 ? "+" : "") + std::to_string(rounded);
}

void corners(PicturePen& pen, const GlassSize& glass, Ink ink) {
    const double arm = 0.07 * glass.height_mm, line = std::max(0.006 * glass.height_mm, 2.0 * glass.px_mm);
    for (const double sx : {-1.0, 1.0})
        for (const double sy : {-1.0, 1.0}) {
            const Point corner(0.5 * sx * glass.width_mm, 0.5 * sy * glass.height_mm, 0.0);
            pen.plate(corner - Point(0.5 * sx * arm, 0.5 * sy * line, 0.0), arm, line, ink);
            pen.plate(corner - Point(0.5 * sx * line, 0.5 * sy * arm, 0.0), line, arm, ink);
        }
}

void grid(PicturePen& pen, const GlassSize& glass) {
    const double spacing = grid_spacing_mm(glass), x = 0.5 * glass.width_mm, y = 0.5 * glass.height_mm;
    for (int i = 0; i * spacing <= std::max(x, y); ++i)
        for (const double at : {-i * spacing, i * spacing}) {
            const Ink ink = i == 0 ? kAxis : kGrid;
            if (std::abs(at) <= x) pen.line({at, -y, 0.0}, {at, y, 0.0}, 0.0, ink);
            if (std::abs(at) <= y) pen.line({-x, at, 0.0}, {x, at, 0.0}, 0.0, ink);
        }
}

void stairs(PicturePen& pen, const GlassSize& glass) {
    const auto depths = stair_depths_mm(glass);
    const double step = 0.13 * glass.width_mm, edge = 0.62 * step, y = -0.27 * glass.height_mm;
    const double letters = std::min(letters_mm(glass, 0.035), 0.3 * edge);
    for (std::size_t i = 0; i < depths.size(); ++i) {  // the farthest first: nearer ones cover it
        const Point middle((static_cast<double>(i) - 2.0) * step, y, depths[i]);
        if (i > 0)
            pen.line({middle.x() - step + 0.5 * edge, y, depths[i - 1]}, middle - Point(0.5 * edge, 0.0, 0.0),
                     0.0, kAxis);
        pen.plate(middle, edge, edge, kStep);
        pen.frame(middle, edge, edge, 0.0, kLine);
        pen.text_centred(middle, letters, millimetres(depths[i], true), kLine);
    }
}

void tool(PicturePen& pen, const GlassSize& glass, const Point& tip) {
    const double arm = std::max(10.0, 14.0 * glass.px_mm), line = std::max(0.6, 2.0 * glass.px_mm);
    for (const Point& axis : {Point(arm, 0.0, 0.0), Point(0.0, arm, 0.0), Point(0.0, 0.0, arm)})
        pen.line(tip - axis, tip + axis, line, kTool);
    pen.ring(tip, 0.5 * arm, line, kTool);
    pen.text(tip + Point(0.7 * arm, 0.9 * arm, 0.0), std::max(0.5 * arm, 11.0 * glass.px_mm), "TOOL", kTool);
}

}  // namespace

double grid_spacing_mm(const GlassSize& glass) { return round_length(glass.width_mm / kCellsAcross * 1.6); }

std::array<double, 5> stair_depths_mm(const GlassSize& glass) {
    const double rise = round_length(0.15 * glass.height_mm);
    return {-2.0 * rise, -rise, 0.0, rise, 2.0 * rise};
}

std::vector<PictureVertex> frame_picture(const GlassSize& glass, bool known) {
    PicturePen pen(glass.px_mm);
    pen.frame(Point::Zero(), glass.width_mm, glass.height_mm, 2.0 * glass.px_mm, kLine);
    corners(pen, glass, kNow);
    const double letters = letters_mm(glass, 0.045), x = 0.46 * glass.width_mm, y = 0.44 * glass.height_mm;
    const auto arrow = [&](const Point& end, const Point& along) {
        const double head = 0.03 * glass.height_mm;
        const Point across(-along.y(), along.x(), 0.0);
        pen.line(-end, end, 0.0, kDim);
        for (const double side : {-0.5, 0.5}) {
            pen.line(end, end - head * along + side * head * across, 0.0, kDim);
            pen.line(-end, -end + head * along + side * head * across, 0.0, kDim);
        }
    };
    arrow({x, 0.0, 0.0}, {1.0, 0.0, 0.0});
    arrow({0.0, y, 0.0}, {0.0, 1.0, 0.0});
    const auto words = [known](const char* what, double mm) {
        return known ? std::string(what) + " " + std::to_string(static_cast<int>(std::lround(mm))) + " MM"
                     : std::string(what) + " IN MM";
    };
    pen.text_centred({-0.25 * glass.width_mm, 1.4 * letters, 0.0}, letters, words("WIDTH", glass.width_mm),
                     kLine);
    pen.text({1.2 * letters, 0.28 * glass.height_mm, 0.0}, letters, words("HEIGHT", glass.height_mm), kLine);
    const std::string what = "MEASURE BETWEEN THE OUTER EDGES";
    pen.text_centred({0.0, -0.32 * glass.height_mm, 0.0}, fitted_mm(glass, 0.8 * letters, what), what, kNow);
    return pen.take();
}

std::vector<PictureVertex> marks_picture(const GlassSize& glass, const MarksPicture& marks) {
    PicturePen pen(glass.px_mm);
    corners(pen, glass, kDim);
    const double radius = std::max(0.035 * glass.height_mm, 12.0 * glass.px_mm),
                 letters = letters_mm(glass, 0.045);
    if (!marks.marks) pen.ring(Point::Zero(), 3.0 * radius, radius, kNow, marks.progress);
    for (std::size_t i = 0; marks.marks && i < kMarks; ++i) {
        const MarkStyle look = marks.look[i];
        const Ink ink = look == MarkStyle::current   ? kNow
                        : look == MarkStyle::outlier ? kWrong
                        : look == MarkStyle::taken   ? kTaken
                                                     : kOpen;
        const Point at((kMarkPlaces[i][0] - 0.5) * glass.width_mm,
                       (kMarkPlaces[i][1] - 0.5) * glass.height_mm, 0.0);
        const double arm = look == MarkStyle::current ? 1.5 * radius : radius;
        pen.line(at - Point(arm, 0.0, 0.0), at + Point(arm, 0.0, 0.0), 0.0, ink);
        pen.line(at - Point(0.0, arm, 0.0), at + Point(0.0, arm, 0.0), 0.0, ink);
        pen.ring(at, 0.5 * radius, 0.0, ink);
        if (look == MarkStyle::current) {
            pen.ring(at, radius, 0.0, ink);
            pen.ring(at, 1.2 * radius, 0.3 * radius, ink, marks.progress);
        }
        // Towards the centre, where there is space.
        const double side = at.x() > 0.2 * glass.width_mm ? -1.0 : 1.0;
        pen.text_centred(at + Point(side * 2.1 * radius, 1.2 * radius, 0.0), letters, std::to_string(i + 1),
                         ink);
    }
    pen.text_centred({0.0, 0.24 * glass.height_mm, 0.0}, fitted_mm(glass, letters, marks.text), marks.text,
                     kLine);
    return pen.take();
}

std::vector<PictureVertex> test_picture(const GlassSize& glass, const TestPicture& what) {
    PicturePen pen(glass.px_mm);
    grid(pen, glass);
    pen.frame(Point::Zero(), glass.width_mm, glass.height_mm, 0.0, kAxis);
    corners(pen, glass, kNow);
    const double radius = 0.39 * glass.height_mm, letters = letters_mm(glass, 0.04);
    pen.ring(Point::Zero(), radius, 0.006 * glass.height_mm, kLine);
    // Side by side if both eyes look at once, within the circle.
    const bool left = what.eye == 0;
    const std::string eye = left ? "LEFT" : "RIGHT";
    const double high = std::min(letters_mm(glass, 0.07), 0.07 * glass.height_mm),
                 gap = 0.03 * glass.height_mm;
    pen.text({left ? -gap - PicturePen::text_width_mm(high, eye) : gap, 0.14 * glass.height_mm, 0.0}, high,
             eye, left ? kLeft : kRight);
    pen.text_centred({0.0, 0.3 * glass.height_mm, 0.0}, letters, "ROUND", kDim);
    const double below = -0.5 * glass.height_mm + 1.6 * letters;
    pen.text({-0.5 * glass.width_mm + 0.1 * glass.height_mm, below, 0.0}, letters,
             "GRID " + millimetres(grid_spacing_mm(glass), false) + " MM", kLine);
    const std::string depth = "STAIRS IN MM BEFORE THE GLASS";
    pen.text({0.5 * glass.width_mm - 0.1 * glass.height_mm - PicturePen::text_width_mm(0.75 * letters, depth),
              below, 0.0},
             0.75 * letters, depth, kDim);
    stairs(pen, glass);
    if (what.tool_mm) tool(pen, glass, *what.tool_mm);
    return pen.take();
}

}  // namespace tact
