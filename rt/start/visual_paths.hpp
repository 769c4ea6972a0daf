// The fidelity paths of the display: their knobs, and the load that the visual process reports for each.
//
// Floor     the lowest level at which a person recognizes the scene. The law sets the slew.
#pragma once

#include <array>

#include "ipc/topics/levels.hpp"
#include "rt/servo/servo_settings.hpp"

namespace tact {

// Triangles of a surface or of contours. The weights of loss are relative to these: half of the vertices of a fine surface can hardly be
// told from all of them.
inline constexpr VisualPath kSurfaceDetail{{.path = kMeshPath, .floor = 0.01F, .start = 1.0F},
                                           &HousekeepingReport::gui_vertices_max,
                                           &HousekeepingReport::gui_vertices,
                                           &HousekeepingReport::gui_mesh_s};
// Triangles of the structures. At the floor, a tube still follows its chain, and pictures at 1 and at 0.25
// can hardly be told apart at the distance from which a whole complex is seen.
inline constexpr VisualPath kMoleculeDetail{
    {.path = kMoleculesPath, .floor = 0.17F, .start = 1.0F, .loss = 0.3F},
    &HousekeepingReport::gui_molecules_max,
    &HousekeepingReport::gui_molecules,
    &HousekeepingReport::gui_molecules_s};
// Pixels of the 3D view; the floor is half of them along each axis. The most loss: everything in the view blurs at once.
inline constexpr VisualPath kViewResolution{
    {.path = kResolutionPath, .floor = 0.25F, .start = 1.0F, .loss = 4.0F},
    &HousekeepingReport::gui_pixels_max,
    &HousekeepingReport::gui_pixels,
    &HousekeepingReport::gui_resolution_s};
inline constexpr std::array kMeshPaths{kSurfaceDetail};  // of a loop without a scene, in tests
inline constexpr std::array kSurfacePaths{kSurfaceDetail, kViewResolution};
inline constexpr std::array kDockingPaths{kSurfaceDetail, kMoleculeDetail, kViewResolution};
// Rays through bone: below the floor, walls and openings look alike. A tenth of the dust and water particles still shows
// where the burr cuts and what they hide. Fewer rays blur the bone as fewer pixels do, so there is no second path for these, and its
// loss is greater than that of particles, which only become fewer.
inline constexpr std::array kBonePaths{
    VisualPath{{.path = kVolumePath, .floor = 0.03F, .start = 1.0F, .loss = 2.0F},
               &HousekeepingReport::gui_vertices_max,
               &HousekeepingReport::gui_vertices,
               &HousekeepingReport::gui_volume_s},
    VisualPath{{.path = kParticlesPath, .floor = 0.1F, .start = 1.0F},
               &HousekeepingReport::gui_particles_max,
               &HousekeepingReport::gui_particles,
               &HousekeepingReport::gui_particles_s}};
static_assert(kParticlesPathIndex == kForcePathIndex + 1);  // the second visual path

}  // namespace tact
