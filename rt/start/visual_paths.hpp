// The fidelity paths of the display: their knobs, and the load that the visual process reports for each.
//
// Floor     the lowest level at which a person recognizes the scene. The law sets the slew.
#pragma once

#include <array>

#include "ipc/topics/levels.hpp"
#include "rt/servo/servo_settings.hpp"

namespace tact {

// Triangles of a surface or of contours.
inline constexpr std::array kMeshPaths{VisualPath{{.path = kMeshPath, .floor = 0.01F, .start = 1.0F},
                                                  &HousekeepingReport::gui_vertices_max,
                                                  &HousekeepingReport::gui_busy_s}};
// Rays through bone: below the floor, walls and openings look alike. A tenth of the dust and water particles still shows
// where the burr cuts and what they hide.
inline constexpr std::array kBonePaths{VisualPath{{.path = kVolumePath, .floor = 0.03F, .start = 1.0F},
                                                  &HousekeepingReport::gui_vertices_max,
                                                  &HousekeepingReport::gui_busy_s},
                                       VisualPath{{.path = kParticlesPath, .floor = 0.1F, .start = 1.0F},
                                                  &HousekeepingReport::gui_particles_max,
                                                  &HousekeepingReport::gui_particles_s}};
static_assert(kParticlesPathIndex == kForcePathIndex + 1);  // the second visual path

}  // namespace tact
