// DICOM slices: reads the headers of files and selects the files that form one scan.
//
// Personal  only the elements below are read from a file; no name, date or number of a patient.
// Memory    a few hundred bytes per file; one slice at a time when the scan is read.
// Fails by  StartupError: no DICOM, several series, mixed sizes, missing or duplicate slices, unsupported compression.
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
    bool placed = false;  // the next three lines are valid
    Vec3 position_mm = Vec3::Zero(), along_row = Vec3::Zero(), down_rows = Vec3::Zero();
    double column_mm = 0.0, row_mm = 0.0;
    double slope = 1.0, intercept = 0.0;
};

// All DICOM images in a folder and its subfolders.
std::vector<DicomSlice> list_dicom(const std::filesystem::path& folder, const Progress& progress);
bool is_dicom(const std::filesystem::path& file);

struct DicomSeries {
    std::string text;  // for a list
    std::size_t slices = 0;
    bool is_volume = false;
};
// The groups from which dicom_stack() selects, in its order.
std::vector<DicomSeries> dicom_series(std::vector<DicomSlice> slices);

// No file access: groups by series, size and direction, selects one (`series` counts from 1 in the order that the error
// lists; 0: the only group that is a volume), sorts by position and checks for gaps.
Scan dicom_stack(std::vector<DicomSlice> slices, unsigned series, const std::string& attempt);

// Pixels in the scan's unit. Implemented in the only file that includes the DICOM library.
void read_dicom_pixels(const DicomSlice& slice, std::span<float> pixels);

}  // namespace tact
