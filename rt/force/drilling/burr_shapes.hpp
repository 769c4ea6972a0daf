// The parts of a tool that meet bone, as a union of balls: the burr's head cuts, its shaft is only felt.
//
// Frame    tool: the head's centre is its origin, the shaft runs from there along +z, about which it turns. World metres.
// Weights  a place in several balls counts once: each ball's mass, force and cutting is weighted with its share of
//          the union, so that force and rate do not depend on how many balls make up a shape.
// Thread   any, at start-up; may throw StartupError
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "ipc/base/pose.hpp"

namespace tact {

struct ToolBall {
    Vec3 centre_tool_m = Vec3::Zero();
    double radius_m = 0.0;
    double weight = 1.0;  // above 0, at most 1
    bool cuts = false;
};

struct DrillTool {
    static constexpr std::size_t kMax = 32;
    std::array<ToolBall, kMax> ball{};
    std::uint32_t count = 0;
};

enum class BurrShape : std::uint8_t { sphere, cylinder, cone };
inline constexpr std::array kBurrShapeNames{"sphere", "cylinder", "cone"};
enum class BurrGrit : std::uint8_t { cutting, diamond };  // flutes, or grains of diamond
inline constexpr std::array kBurrGritNames{"cutting", "diamond"};

struct DrillToolSettings {
    BurrShape shape = BurrShape::sphere;
    double radius_m = 3e-3;         // of the head; of a cone, where it is widest
    double length_m = 8e-3;         // of the head of a cylinder or cone, round ends included
    double tip_radius_m = 1e-3;     // of a cone
    double shaft_radius_m = 1e-3;   // 0: none
    double shaft_length_m = 25e-3;  // that is felt
    bool cuts = true;               // false: a suction tube, say
};

// Weights included. Fails by StartupError where a size is out of range or the shape needs more than kMax balls.
[[nodiscard]] DrillTool make_drill_tool(const DrillToolSettings& settings);

}  // namespace tact
