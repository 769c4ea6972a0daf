// What is shown on a screen while it is calibrated, and the picture that tells whether it was done well.
//
// Unit     millimetres on the glass, see picture_pen.hpp. What lies on the glass looks the same to both eyes, wherever they are
// Thread   any; plain geometry
#pragma once

#include <array>
#include <optional>
#include <string>

#include "gui/stereo/calibration.hpp"
#include "gui/stereo/picture_pen.hpp"

namespace tact {

struct GlassSize {
    double width_mm = 1.0, height_mm = 1.0;
    double px_mm = 1.0;  // of the larger edge of a pixel
};

// The edges that a ruler is laid along; with numbers where the size is known.
[[nodiscard]] std::vector<PictureVertex> frame_picture(const GlassSize& glass, bool known);

enum class MarkStyle : std::uint8_t { open, taken, outlier, current };
struct MarksPicture {
    bool marks = true;  // else the words alone, and how far the measuring is
    std::array<MarkStyle, kMarks> look{};
    double progress = 0.0;  // of the current one
    std::string text;       // what to do, for who stands before the picture
};
[[nodiscard]] std::vector<PictureVertex> marks_picture(const GlassSize& glass, const MarksPicture& marks);

// Grid of known spacing, a round circle, corners, a word for each eye, stairs from behind the glass to before it, and a cross
// where the tool's tip is.
struct TestPicture {
    std::size_t eye = 0;  // left, right: the one that the picture is meant for
    std::optional<Eigen::Vector3d> tool_mm;
};
[[nodiscard]] std::vector<PictureVertex> test_picture(const GlassSize& glass, const TestPicture& what);
[[nodiscard]] double grid_spacing_mm(const GlassSize& glass);
// Of the five steps, from left to right: how far before the glass each stands.
[[nodiscard]] std::array<double, 5> stair_depths_mm(const GlassSize& glass);

}  // namespace tact
