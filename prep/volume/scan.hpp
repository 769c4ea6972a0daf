// A scan as its file tells it: slices one above the other, read one at a time.
//
// Frame     patient, mm: x to the left, y to the back, z up (LPS), where the file says how the patient lay; `oriented`
//           is false where it does not, and columns, rows and slices are then taken as these three axes.
// Memory    a slice at a time; what a reader keeps of its own is in its header.
// Fails by  StartupError, from the reader that made it and from `read`.
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include <Eigen/Core>

#include "ipc/base/pose.hpp"

namespace tact {

enum class ScanValues : std::uint8_t {
    hounsfield,
    grey,    // 8 bits
    number,  // of an unknown meaning
    label    // whole numbers from 0 to 255
};

struct ScanLabel {
    std::uint8_t value = 0;
    std::string name;
    std::array<std::uint8_t, 4> rgba{};
};

// Where a slice's first pixel is centred: mm along columns' and rows' direction and the normal, from the origin.
struct ScanSlice {
    double u_mm = 0.0, v_mm = 0.0, s_mm = 0.0;
};

struct Scan {
    static constexpr std::uint32_t kEdgeMax = 8192;

    std::string format;
    ScanValues values = ScanValues::number;
    std::uint32_t columns = 0, rows = 0;
    double column_mm = 0.0, row_mm = 0.0;  // from a pixel to the next in a row; to the next row
    Eigen::Matrix3d axes = Eigen::Matrix3d::
        Identity();  // columns: along a row, down the rows, normal; right-handed, orthonormal
    Vec3 origin_mm = Vec3::Zero();
    bool oriented = false;
    std::vector<ScanSlice> slice;  // s_mm rises
    std::vector<ScanLabel> label;  // what the file calls its labels
    std::vector<std::string> note, warning;
    std::function<void(std::uint32_t slice, std::span<float> pixels)> read;  // rows x columns

    [[nodiscard]] std::size_t pixels() const { return std::size_t{columns} * rows; }
};

// Part of it: first and one past the last column, row and slice.
struct ScanCrop {
    std::array<std::uint32_t, 3> low{}, high{};
};
void crop_scan(Scan& scan, const ScanCrop& crop);

// For readers of files with three axes: sizes and steps along each, in mm. Sorts the slices by position.
// Throws StartupError where sizes or steps cannot be, or the first two axes are not at right angles.
struct ScanAxes {
    std::array<std::uint64_t, 3> size{};
    std::array<Vec3, 3> step_mm{Vec3::Zero(), Vec3::Zero(), Vec3::Zero()};
    Vec3 origin_mm = Vec3::Zero();
    bool oriented = false;
};
// `order`: which of the file's slices is at each place.
Scan scan_of(const ScanAxes& axes, const std::string& attempt, std::vector<std::uint32_t>& order);

}  // namespace tact
