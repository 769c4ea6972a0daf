// Curves over one common axis as a picture: data in, image out, nothing remembered.
//
// Panels     stacked over each other, each with its own vertical axis and label with unit
// Colours    of Okabe and Ito, told apart by everybody; in the order of the curves, or chosen by number
// Long runs  curves are reduced to the smallest and largest value of each pixel column, so no spike is lost
// Hostile    what is not a number breaks a curve; empty and constant data get axes all the same
// Errors     a missing font or a folder that cannot be written: StartupError
#pragma once

#include <filesystem>
#include <limits>
#include <string>
#include <vector>

#include "tests/reproduce/plot_canvas.hpp"
#include "tests/reproduce/plot_scale.hpp"

namespace tact::plot {

struct Curve {
    std::string name{};  // for the legend; empty: not in it
    std::vector<Point> points{};
    int colour = -1;  // 0..6, see okabe_ito(); -1: by its place in the panel
    bool dashed = false;
};

struct Goal {  // a horizontal line that curves are to be seen against
    double y = 0.0;
    std::string name{};
};

struct Span {  // a part of the common axis that is marked
    double x_from = 0.0, x_to = 0.0;
    std::string name{};
    // -1: all of the panel is shaded there. 0..6: a strip at its head in okabe_ito(), for what is said of one
    // curve; each colour has a row of its own, so that none hides another or the curves.
    int colour = -1;
};

struct Panel {
    std::string y_label{};  // with its unit: "force rate, Hz"
    std::vector<Curve> curves{};
    std::vector<Goal> goals{};
    std::vector<Span> spans{};
    // Not a number: from the data, and zero is in.
    double y_min = std::numeric_limits<double>::quiet_NaN();
    double y_max = std::numeric_limits<double>::quiet_NaN();
};

struct Plot {
    std::string title{};
    std::string remark{};   // a smaller line under the title
    std::string x_label{};  // with its unit: "time, s"
    std::vector<Panel> panels{};
    int width_px = 1400;
    int panel_height_px = 460;
};

[[nodiscard]] Image draw(const Plot& plot, const Font& font);
// The same into a file, with the font of the system.
void save(const Plot& plot, const std::filesystem::path& path);

[[nodiscard]] Colour okabe_ito(int number);

}  // namespace tact::plot
