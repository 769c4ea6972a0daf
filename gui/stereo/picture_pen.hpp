// Flat figures as triangles, and text as strokes: for the pictures of a screen calibration.
//
// Unit     millimetres on the glass: x right, y up, z towards the viewer; the origin is the display's centre
// Thread   any; plain geometry
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <string_view>
#include <vector>

namespace tact {

struct Ink {
    std::uint8_t r = 255, g = 255, b = 255, a = 255;
};

struct PictureVertex {
    float x_mm, y_mm, z_mm;
    Ink ink;
};

class PicturePen {
public:
    using Point = Eigen::Vector3d;

    // px_mm: size of a pixel; no line is thinner than 1.6 pixels, or it would flicker.
    explicit PicturePen(double px_mm) : px_mm_(px_mm) {}

    void line(const Point& a, const Point& b, double width_mm, Ink ink);
    void plate(const Point& middle, double width_mm, double height_mm, Ink ink);
    void frame(const Point& middle, double width_mm, double height_mm, double line_mm, Ink ink);
    // An arc from the top, clockwise; share 1: a ring.
    void ring(const Point& middle, double radius_mm, double line_mm, Ink ink, double share = 1.0);
    // Capitals, digits and a few signs, from the left, vertically centred; other characters leave a gap.
    void text(const Point& at, double height_mm, std::string_view words, Ink ink);
    void text_centred(const Point& at, double height_mm, std::string_view words, Ink ink) {
        text(at - Point(0.5 * text_width_mm(height_mm, words), 0.0, 0.0), height_mm, words, ink);
    }
    [[nodiscard]] static double text_width_mm(double height_mm, std::string_view words);
    [[nodiscard]] double px_mm() const { return px_mm_; }
    [[nodiscard]] std::vector<PictureVertex> take() { return std::move(vertices_); }

private:
    void quad(const Point& a, const Point& b, const Point& c, const Point& d, Ink ink);
    double px_mm_;
    std::vector<PictureVertex> vertices_;
};

}  // namespace tact
