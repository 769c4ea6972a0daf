// What strokes of a mesh tool along its surface cost on this machine, tried before the loop starts.
//
// Trial    A copy of the tool is pressed onto the surface with kPressN and moved in circles at kStrokeM_s, at kPlaces places
//          and at each of kLevels: steps of the loop's period without a deadline
// Work     the time of a step's moves and queries by the constants of one core (TOOLS.md). Of each level that which one step
//          in kRare exceeds; between levels its logarithm is linear
// Speed    of this machine: measured time over work, the median of the steps with at least half of that work. Steps that
//          other programs held do not count
// Time     kMostS, or as long as the first place takes. A query of all triangles (mode off-brute) may take much longer: that mode
//          is not tried
// Thread   any but the servo: allocates. cost() is TACT_RT
#pragma once

#include <array>
#include <cstdint>

#include "ipc/base/clock.hpp"
#include "ipc/base/rt.hpp"
#include "rt/force/surface/tool_contact.hpp"

namespace tact {

struct SceneMeta;
struct SurfaceSettings;

// By the constants.
[[nodiscard]] double tool_work_us(double moves, double points, double looked, double asked) noexcept TACT_RT;

class ToolRehearsal {
public:
    static constexpr std::array<float, 6> kLevels{0.05F, 0.25F, 0.5F, 0.6F, 0.75F, 1.0F};
    static constexpr double kPressN = 2.0, kStrokeM_s = 0.1;
    static constexpr double kRare = 1000.0;
    static constexpr std::uint32_t kPlaces = 8, kSteps = 300;  // in contact, at each place
    static constexpr double kMostS = 2.0;

    // Work of each level in us; 0: not tried.
    std::array<double, kLevels.size()> work_us{};
    double speed = 1.0;

    [[nodiscard]] bool tried() const noexcept TACT_RT { return work_us.back() > 0.0; }
    // Of a step at a level that is exceeded once in kRare. Only if tried().
    [[nodiscard]] Duration cost(float level) const noexcept TACT_RT;
};

// step_s: period of the loop. Not tried: mode off-brute, or the surface is nowhere within reach. Fails by StartupError where
// the model would.
[[nodiscard]] ToolRehearsal rehearse_tool(const SceneMeta& meta, const SurfaceMesh& mesh,
                                          const TouchTool& tool, const SurfaceSettings& settings,
                                          double step_s, double most_s = ToolRehearsal::kMostS);

}  // namespace tact
