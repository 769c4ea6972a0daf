#include "rt/force/drilling/burr_shapes.hpp"

#include <algorithm>
#include <cmath>
#include <string>

#include "ipc/base/error.hpp"
#include "ipc/base/random.hpp"

namespace tact {
namespace {

void check(double value_m, double least_m, double most_m, const std::string& name) {
    if (std::isfinite(value_m) && value_m >= least_m && value_m <= most_m) return;
    throw StartupError(
        "making a drill", name + " is " + std::to_string(1e3 * value_m) + " mm",
        "choose from " + std::to_string(1e3 * least_m) + " to " + std::to_string(1e3 * most_m) + " mm");
}

[[noreturn]] void fail_too_long() {
    throw StartupError("making a drill",
                       "its shape needs more than " + std::to_string(DrillTool::kMax) + " balls",
                       "make head or shaft shorter, or thicker");
}

void add(DrillTool& tool, double z_m, double radius_m, bool cuts) {
    if (tool.count == DrillTool::kMax) fail_too_long();
    tool.ball[tool.count++] = {Vec3(0.0, 0.0, z_m), radius_m, 1.0, cuts};
}

// Balls along the axis between two of them, at most half a radius apart: the waist between is 3 % thinner.
void add_row(DrillTool& tool, double from_m, double from_radius_m, double to_m, double to_radius_m,
             bool cuts) {
    const double step_m = 0.5 * std::min(from_radius_m, to_radius_m);
    const double steps = std::max(1.0, std::ceil((to_m - from_m) / step_m - 1e-9));
    if (!(steps <= DrillTool::kMax)) fail_too_long();
    for (int i = 0; i <= static_cast<int>(steps); ++i) {
        const double s = i / steps;
        add(tool, std::lerp(from_m, to_m, s), std::lerp(from_radius_m, to_radius_m, s), cuts);
    }
}

// Each ball's share of the union: of points in it, one over the number of balls that they are in.
void weigh(DrillTool& tool) {
    constexpr int kPoints = 4096;
    std::array<double, DrillTool::kMax> share{};
    for (std::uint32_t i = 0; i < tool.count; ++i) {
        SeededRandom random(i + 1);
        for (int k = 0; k < kPoints; ++k) {
            const Vec3 way = random.direction();
            const Vec3 point =
                tool.ball[i].centre_tool_m + tool.ball[i].radius_m * std::cbrt(random.uniform()) * way;
            int in = 1;
            for (std::uint32_t other = 0; other < tool.count; ++other) {
                const ToolBall& b = tool.ball[other];
                if (other != i && (point - b.centre_tool_m).norm() < b.radius_m) ++in;
            }
            share[i] += 1.0 / in;
        }
    }
    for (std::uint32_t i = 0; i < tool.count; ++i) tool.ball[i].weight = share[i] / kPoints;
}

}  // namespace

DrillTool make_drill_tool(const DrillToolSettings& s) {
    check(s.radius_m, 1e-4, 0.05, "the head's radius");
    DrillTool tool;
    if (s.shape == BurrShape::sphere) {
        add(tool, 0.0, s.radius_m, s.cuts);
    } else {
        const double tip_m = s.shape == BurrShape::cone ? s.tip_radius_m : s.radius_m;
        check(tip_m, 1e-4, s.radius_m, "the tip's radius");
        check(s.length_m, tip_m + s.radius_m, 0.1, "the head's length");
        const double half_m = 0.5 * s.length_m;
        add_row(tool, tip_m - half_m, tip_m, half_m - s.radius_m, s.radius_m, s.cuts);
    }
    if (s.shaft_radius_m > 0.0) {
        check(s.shaft_radius_m, 1e-4, s.radius_m, "the shaft's radius");
        check(s.shaft_length_m, s.radius_m + s.length_m, 0.2, "the shaft's length");
        // From where it leaves the head. A shaft is met from the side: balls a radius apart do.
        const ToolBall& last = tool.ball[tool.count - 1];
        const double from_m = last.centre_tool_m.z() + last.radius_m + s.shaft_radius_m;
        const double steps = std::ceil((s.shaft_length_m - from_m) / (2.0 * s.shaft_radius_m));
        for (int i = 0; i <= static_cast<int>(std::min(steps, 1000.0)); ++i)
            add(tool, from_m + 2.0 * s.shaft_radius_m * i, s.shaft_radius_m, false);
    }
    weigh(tool);
    return tool;
}

}  // namespace tact
