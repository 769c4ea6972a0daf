// Values of a scan for no bone and for solid bone, proposed from its histogram where the file says nothing about their unit.
//
// Threshold   between soft tissue and bone: the upper one of the two that separate three classes (air, soft tissue, bone) with the
//             largest variance between them (Otsu 1979, multilevel). Two classes would separate the patient from the air
// Solid       below it lie 98 % of the voxels above the threshold
// A proposal  is no measurement: a scan of another object than a body has other classes
// Unit        Hounsfield if the file says so, or if its values are numbers that reach down to air
#pragma once

#include <optional>
#include <vector>

#include "ipc/base/progress.hpp"
#include "prep/volume/scan.hpp"

namespace tact {

inline constexpr double kBoneFromHu = 300.0, kBoneSolidHu = 1800.0, kAirHu = -500.0;

struct ScanHistogram {
    double low = 0.0, most = 0.0;  // all values
    // Of the bins, all of one width; the last one also has the few values above, such as those of metal.
    double high = 0.0;
    std::vector<double> count;
};
// Reads all slices twice; about a second for 512 x 512 x 200. None: all voxels have the same value.
[[nodiscard]] std::optional<ScanHistogram> scan_histogram(const Scan& scan, const Progress& progress = {});

// low: the least of all values.
[[nodiscard]] bool in_hounsfield(const Scan& scan, double low);

struct ProposedBone {
    double threshold = 0.0, solid = 0.0;  // in the scan's values
    double share_above = 0.0;             // of the voxels, above the threshold
};

[[nodiscard]] ProposedBone propose_bone(const ScanHistogram& histogram);

}  // namespace tact
