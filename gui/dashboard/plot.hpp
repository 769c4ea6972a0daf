// A plot over time, drawn with ImGui draw lists: axes with units, and a min-max band per bin. A linear axis ends where most
// values do (axis_top()); what is above it has a mark at the upper edge, and the largest value is written there.
#pragma once

#include <imgui.h>

#include <span>
#include <string>
#include <vector>

#include "gui/dashboard/plot_axis.hpp"
#include "gui/dashboard/plot_series.hpp"
#include "gui/dashboard/theme.hpp"

namespace tact {

struct PlotLine {
    const PlotSeries* series;
    ImU32 colour;
    const char* name;
};

struct PlotSpec {
    const char* title;
    const char* unit;
    std::span<const PlotLine> lines;
    double now_s = 0.0;
    double span_s = 60.0;
    double scale = 1.0;  // stored value -> shown value
    bool logarithmic = false;
    double least_top = 0.0;  // the vertical axis reaches at least this far (shown unit)
    double fixed_top = 0.0;  // > 0: exactly this far
    double goal = 0.0;       // > 0: a dashed line (shown unit)
    bool steps = false;      // a value holds until the next one
    // Replaces the legend's values, one line for each of `lines`; clipped if too long.
    std::span<const std::string> text = {};
};

// Mouse position in the plot, for a caller that shows a tooltip about that time.
struct PlotHover {
    bool inside = false;
    double t_s = 0.0;
};
PlotHover draw_plot(const Theme& theme, const PlotSpec& spec, ImVec2 size);

}  // namespace tact
