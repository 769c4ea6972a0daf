// The paths of the display: their knobs, and what the visual process reports of each.
//
// Floor     the level at which a person still recognizes what is shown. The slew is the law's.
#pragma once

#include <array>

#include "ipc/topics/levels.hpp"
#include "rt/servo/servo_settings.hpp"

namespace tact {

// Triangles, of a surface or of contours.
inline constexpr std::array kMeshPaths{VisualPath{{.path = kMeshPath, .floor = 0.01F, .start = 1.0F},
                                                  &HousekeepingReport::gui_vertices_max,
                                                  &HousekeepingReport::gui_busy_s}};
// Rays through bone: with fewer, walls and openings cannot be told apart. A tenth of the dust and the water still shows
// where the burr cuts and what is hidden.
inline constexpr std::array kBonePaths{VisualPath{{.path = kVolumePath, .floor = 0.03F, .start = 1.0F},
                                                  &HousekeepingReport::gui_vertices_max,
                                                  &HousekeepingReport::gui_busy_s},
                                       VisualPath{{.path = kParticlesPath, .floor = 0.1F, .start = 1.0F},
                                                  &HousekeepingReport::gui_particles_max,
                                                  &HousekeepingReport::gui_particles_s}};
static_assert(kParticlesPathIndex == kForcePathIndex + 1);  // the second visual path

}  // namespace tact
