// A scan as stored in its file: parallel slices, read one at a time.
//
// Frame     patient, mm: x to the left, y to the back, z up (LPS), if the file states the orientation; otherwise
//           `oriented` is false and columns, rows and slices are used as these three axes.
// Memory    one slice at a time; the header of a reader states its own memory.
// Fails by  StartupError, from the reader and from `read`.
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
    number,  // of unknown meaning
    label    // whole numbers from 0 to 255
};

struct ScanLabel {
    std::uint8_t value = 0;
    std::string name;
    std::array<std::uint8_t, 4> rgba{};
    std::optional<bool> critical{};  // as a person says; none: the name decides
};

// Centre of a slice's first pixel: mm along the columns' and rows' direction and the normal, from the origin.
struct ScanSlice {
    double u_mm = 0.0, v_mm = 0.0, s_mm = 0.0;
};

struct Scan {
    static constexpr std::uint32_t kEdgeMax = 8192;

    std::string format;
    ScanValues values = ScanValues::number;
    std::uint32_t columns = 0, rows = 0;
    double column_mm = 0.0, row_mm = 0.0;  // distance between pixels in a row; distance between rows
    Eigen::Matrix3d axes = Eigen::Matrix3d::
        Identity();  // columns: along a row, down the rows, normal; right-handed, orthonormal
    Vec3 origin_mm = Vec3::Zero();
    bool oriented = false;
    std::vector<ScanSlice> slice;  // in order of increasing s_mm
    std::vector<ScanLabel> label;  // labels named by the file
    std::vector<std::string> note, warning;
    std::function<void(std::uint32_t slice, std::span<float> pixels)> read;  // rows x columns

    [[nodiscard]] std::size_t pixels() const { return std::size_t{columns} * rows; }
};

// A part of a scan: first and one past the last column, row and slice.
struct ScanCrop {
    std::array<std::uint32_t, 3> low{}, high{};
};
void crop_scan(Scan& scan, const ScanCrop& crop);

// For readers of files with three axes: size and step along each, in mm. scan_of() sorts the slices by position and
// throws StartupError if sizes or steps are invalid or the first two axes are not at right angles.
struct ScanAxes {
    std::array<std::uint64_t, 3> size{};
    std::array<Vec3, 3> step_mm{Vec3::Zero(), Vec3::Zero(), Vec3::Zero()};
    Vec3 origin_mm = Vec3::Zero();
    bool oriented = false;
};
// `order`: the index of the file's slice at each position.
Scan scan_of(const ScanAxes& axes, const std::string& attempt, std::vector<std::uint32_t>& order);

}  // namespace tact
