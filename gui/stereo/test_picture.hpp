// Pictures on a screen during its calibration, and the test picture that checks the result.
//
// Unit     millimetres on the glass, see picture_pen.hpp. Content on the glass looks the same to both eyes, wherever
//          they are
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
    double px_mm = 1.0;  // larger edge of a pixel
};

// Frame to measure with a ruler; with numbers if the size is known.
[[nodiscard]] std::vector<PictureVertex> frame_picture(const GlassSize& glass, bool known);

enum class MarkStyle : std::uint8_t { open, taken, outlier, current };
struct MarksPicture {
    bool marks = true;  // false: only the text and the progress
    std::array<MarkStyle, kMarks> look{};
    double progress = 0.0;  // of the current mark
    std::string text;       // instruction, for a user in front of the display
};
[[nodiscard]] std::vector<PictureVertex> marks_picture(const GlassSize& glass, const MarksPicture& marks);

// Grid of known spacing, a round circle, corners, a word for each eye, stairs from behind to in front of the glass,
// and a cross at the tool's tip.
struct TestPicture {
    std::size_t eye = 0;  // left, right: the intended eye
    std::optional<Eigen::Vector3d> tool_mm;
};
[[nodiscard]] std::vector<PictureVertex> test_picture(const GlassSize& glass, const TestPicture& what);
[[nodiscard]] double grid_spacing_mm(const GlassSize& glass);
// Distances of the five steps in front of the glass, from left to right.
[[nodiscard]] std::array<double, 5> stair_depths_mm(const GlassSize& glass);

}  // namespace tact
