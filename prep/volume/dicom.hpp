// DICOM slices: what each file says of itself, and which of them make one scan.
//
// Personal  of the files' elements only those below are looked at; no name, date or number of a patient is read.
// Memory    some hundred bytes a file; a slice at a time when the scan is read.
// Fails by  StartupError: no DICOM, several series, mixed sizes, missing or doubled slices, packing that is not read.
#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "ipc/base/progress.hpp"
#include "prep/volume/scan.hpp"

namespace tact {

struct DicomSlice {
    std::filesystem::path path;
    std::string series_uid, modality, maker, rescale_type, photometric;
    int series_number = 0;
    std::uint32_t columns = 0, rows = 0, frames = 1, samples = 1;
    bool placed = false;  // the next three are there
    Vec3 position_mm = Vec3::Zero(), along_row = Vec3::Zero(), down_rows = Vec3::Zero();
    double column_mm = 0.0, row_mm = 0.0;
    double slope = 1.0, intercept = 0.0;
};

// All DICOM pictures in a folder and its folders; or of the folder that one file is in.
std::vector<DicomSlice> list_dicom(const std::filesystem::path& folder, const Progress& progress);
bool is_dicom(const std::filesystem::path& file);

// Pure: groups by series, size and direction, chooses (number from 1 in the order that the error lists; 0: the only
// one that is a volume), sorts by position, checks gaps.
Scan dicom_stack(std::vector<DicomSlice> slices, unsigned series, const std::string& attempt);

// Pixels in the scan's unit. In the one file that knows the DICOM library.
void read_dicom_pixels(const DicomSlice& slice, std::span<float> pixels);

}  // namespace tact
