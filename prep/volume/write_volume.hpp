// Writes a volume for other programs: NRRD (packed by gzip) or NIfTI (.nii, .nii.gz), by the ending of the name.
//
// Frame    LPS, millimetres, in NRRD; NIfTI has RAS. Without an orientation, the axes are those of the voxels.
// File     whole or absent: written beside the target and renamed
// Errors   StartupError
#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "ipc/base/pose.hpp"

namespace tact {

struct VolumeFile {
    std::array<std::uint32_t, 3> size{};  // x fastest
    std::array<Vec3, 3> step_mm;          // from voxel to voxel along each axis
    Vec3 origin_mm = Vec3::Zero();        // of the first voxel's centre
    bool oriented = false;                // steps and origin are in the patient's axes
    std::string content;                  // one line that says what the values are
    std::vector<std::int16_t> value;
};

// Fails for another ending, before long work.
void check_volume_name(const std::filesystem::path& path);
// The first 352 bytes of a NIfTI file.
[[nodiscard]] std::string nifti_file_header(const VolumeFile& volume);
void write_volume(const std::filesystem::path& path, const VolumeFile& volume);

}  // namespace tact
