#include "gui/stereo/picture_pen.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

namespace tact {
namespace {

constexpr double kThinnestPx = 1.6;
constexpr double kGlyphHigh = 6.0, kAdvance = 5.6, kStroke = 0.13;  // of the height
constexpr int kRingPieces = 96;

// Polylines as pairs of digits: right 0 to 4, up 0 to 6; a comma lifts the pen.
struct Glyph {
    char letter;
    std::string_view strokes;
};
constexpr std::array kGlyphs{
    Glyph{'A', "002640,1333"},
    Glyph{'B', "00063645443303,3342413000"},
    Glyph{'C', "4536160501103041"},
    Glyph{'D', "00062644422000"},
    Glyph{'E', "46060040,0333"},
    Glyph{'F', "460600,0333"},
    Glyph{'G', "45361605011030414323"},
    Glyph{'H', "0006,4046,0343"},
    Glyph{'I', "1030,2026,1636"},
    Glyph{'J', "4641301001"},
    Glyph{'K', "0006,460340"},
    Glyph{'L', "060040"},
    Glyph{'M', "0006234640"},
    Glyph{'N', "00064046"},
    Glyph{'O', "163645413010010516"},
    Glyph{'P', "00063645443303"},
    Glyph{'Q', "163645413010010516,2240"},
    Glyph{'R', "00063645443303,2340"},
    Glyph{'S', "453616050413334241301001"},
    Glyph{'T', "0646,2026"},
    Glyph{'U', "060110304146"},
    Glyph{'V', "062046"},
    Glyph{'W', "0610233046"},
    Glyph{'X', "0046,0640"},
    Glyph{'Y', "062346,2320"},
    Glyph{'Z', "06460040"},
    Glyph{'0', "163645413010010516"},
    Glyph{'1', "052620,1030"},
    Glyph{'2', "05163645440040"},
    Glyph{'3', "05163645443323,334241301001"},
    Glyph{'4', "30360242"},
    Glyph{'5', "460603334241301001"},
    Glyph{'6', "36160501103041423303"},
    Glyph{'7', "064610"},
    Glyph{'8', "163645443313040516,1302011030414233"},
    Glyph{'9', "10304145361605041343"},
    Glyph{'+', "2125,0343"},
    Glyph{'-', "0343"},
    Glyph{'.', "2021"},
    Glyph{',', "2110"},
    Glyph{':', "2122,2425"},
    Glyph{'/', "0046"},
    Glyph{'=', "0242,0444"},
};

}  // namespace

void PicturePen::quad(const Point& a, const Point& b, const Point& c, const Point& d, Ink ink) {
    for (const Point* const p : {&a, &b, &c, &a, &c, &d})
        vertices_.push_back(
            {static_cast<float>(p->x()), static_cast<float>(p->y()), static_cast<float>(p->z()), ink});
}

void PicturePen::line(const Point& a, const Point& b, double width_mm, Ink ink) {
    const double half = 0.5 * std::max(width_mm, kThinnestPx * px_mm_);
    const Point along = b - a;
    const double on_glass = along.head<2>().norm();
    if (on_glass > 1e-9) {
        const Point across = Point(-along.y(), along.x(), 0.0) * (half / on_glass);
        quad(a - across, b - across, b + across, a + across, ink);
    }
    if (std::abs(along.z()) > 1e-9 && on_glass < std::abs(along.z()))  // visible from the side as well
        for (const Point& across : {Point(half, 0.0, 0.0), Point(0.0, half, 0.0)})
            quad(a - across, b - across, b + across, a + across, ink);
}

void PicturePen::plate(const Point& middle, double width_mm, double height_mm, Ink ink) {
    const Point x(0.5 * width_mm, 0.0, 0.0), y(0.0, 0.5 * height_mm, 0.0);
    quad(middle - x - y, middle + x - y, middle + x + y, middle - x + y, ink);
}

void PicturePen::frame(const Point& middle, double width_mm, double height_mm, double line_mm, Ink ink) {
    const double line = std::max(line_mm, kThinnestPx * px_mm_);
    const Point x(0.5 * (width_mm - line), 0.0, 0.0), y(0.0, 0.5 * (height_mm - line), 0.0);
    plate(middle - x, line, height_mm, ink);
    plate(middle + x, line, height_mm, ink);
    plate(middle - y, width_mm, line, ink);
    plate(middle + y, width_mm, line, ink);
}

void PicturePen::ring(const Point& middle, double radius_mm, double line_mm, Ink ink, double share) {
    const double half = 0.5 * std::max(line_mm, kThinnestPx * px_mm_);
    const int pieces = static_cast<int>(std::lround(kRingPieces * std::clamp(share, 0.0, 1.0)));
    const auto at = [&](int i, double radius) {
        const double angle = 2.0 * std::numbers::pi * i / kRingPieces;
        return Point(middle + radius * Point(std::sin(angle), std::cos(angle), 0.0));
    };
    for (int i = 0; i < pieces; ++i)
        quad(at(i, radius_mm - half), at(i + 1, radius_mm - half), at(i + 1, radius_mm + half),
             at(i, radius_mm + half), ink);
}

double PicturePen::text_width_mm(double height_mm, std::string_view words) {
    return words.empty()
               ? 0.0
               : height_mm / kGlyphHigh * (kAdvance * static_cast<double>(words.size()) - kAdvance + 4.0);
}

void PicturePen::text(const Point& at, double height_mm, std::string_view words, Ink ink) {
    const double unit = height_mm / kGlyphHigh;
    Point origin = at - Point(0.0, 0.5 * height_mm, 0.0);
    for (char letter : words) {
        if (letter >= 'a' && letter <= 'z') letter = static_cast<char>(letter - 'a' + 'A');
        const auto* const glyph = std::find_if(kGlyphs.begin(), kGlyphs.end(),
                                               [letter](const Glyph& g) { return g.letter == letter; });
        bool down = false;
        Point before = Point::Zero();
        for (std::size_t i = 0; glyph != kGlyphs.end() && i + 1 < glyph->strokes.size();) {
            if (glyph->strokes[i] < '0' || glyph->strokes[i] > '9') {
                down = down && glyph->strokes[i] != ',';
                ++i;
                continue;
            }
            const Point here =
                origin + unit * Point(glyph->strokes[i] - '0', glyph->strokes[i + 1] - '0', 0.0);
            if (down) line(before, here, kStroke * height_mm, ink);
            before = here;
            down = true;
            i += 2;
        }
        origin.x() += kAdvance * unit;
    }
}

}  // namespace tact
