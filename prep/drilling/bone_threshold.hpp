// Values of a scan for no bone and for solid bone, proposed from its histogram where the file says nothing about their unit.
//
// Threshold   between soft tissue and bone: the upper one of the two that separate three classes (air, soft tissue, bone) with the
//             largest variance between them (Otsu 1979, multilevel). Two classes would separate the patient from the air
// Solid       below it lie 98 % of the voxels above the threshold
// A proposal  is no measurement: a scan of another object than a body has other classes
// Thread      reads all slices twice; about a second for 512 x 512 x 200
#pragma once

#include <optional>

#include "ipc/base/progress.hpp"
#include "prep/volume/scan.hpp"

namespace tact {

struct ProposedBone {
    double threshold = 0.0, solid = 0.0;  // in the scan's values
    double share_above = 0.0;             // of the voxels, above the threshold
};

// None: all voxels have the same value.
[[nodiscard]] std::optional<ProposedBone> propose_bone(const Scan& scan, const Progress& progress = {});

}  // namespace tact
