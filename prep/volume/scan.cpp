#include "prep/volume/scan.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "ipc/base/error.hpp"

namespace tact {
namespace {

constexpr double kStepMinMm = 1e-3, kStepMaxMm = 100.0, kFarMm = 1e5;
constexpr std::uint64_t kVoxelsMax = std::uint64_t{1} << 32;

}  // namespace

void crop_scan(Scan& scan, const ScanCrop& crop) {
    const std::array<std::uint32_t, 3> size{scan.columns, scan.rows,
                                            static_cast<std::uint32_t>(scan.slice.size())};
    constexpr std::array<const char*, 3> kNames{"columns", "rows", "slices"};
    for (std::size_t a = 0; a < 3; ++a) {
        if (crop.low[a] < crop.high[a] && crop.high[a] <= size[a]) continue;
        throw StartupError("crop the scan",
                           std::string(kNames[a]) + " " + std::to_string(crop.low[a]) + ":" +
                               std::to_string(crop.high[a]) + " are outside 0:" + std::to_string(size[a]),
                           "give first:end of columns, rows and slices, as in --crop 0:256,0:256,10:90");
    }
    const std::uint32_t all_columns = scan.columns, first_slice = crop.low[2];
    const std::size_t all_pixels = scan.pixels();
    scan.slice.erase(scan.slice.begin() + crop.high[2], scan.slice.end());
    scan.slice.erase(scan.slice.begin(), scan.slice.begin() + first_slice);
    for (ScanSlice& s : scan.slice) {
        s.u_mm += crop.low[0] * scan.column_mm;
        s.v_mm += crop.low[1] * scan.row_mm;
    }
    scan.columns = crop.high[0] - crop.low[0];
    scan.rows = crop.high[1] - crop.low[1];
    scan.read = [read = std::move(scan.read), crop, all_columns, all_pixels, whole = std::vector<float>()](
                    std::uint32_t slice, std::span<float> pixels) mutable {
        whole.resize(all_pixels);
        read(slice + crop.low[2], whole);
        const std::size_t wide = crop.high[0] - crop.low[0];
        for (std::uint32_t y = crop.low[1]; y < crop.high[1]; ++y) {
            const float* const from = whole.data() + std::size_t{y} * all_columns + crop.low[0];
            std::copy(from, from + wide,
                      pixels.begin() + static_cast<std::ptrdiff_t>((y - crop.low[1]) * wide));
        }
    };
}

Scan scan_of(const ScanAxes& axes, const std::string& attempt, std::vector<std::uint32_t>& order) {
    const auto fail = [&](const std::string& why, const char* fix) { throw StartupError(attempt, why, fix); };
    std::uint64_t voxels = 1;
    for (std::size_t a = 0; a < 3; ++a) {
        const std::uint64_t n = axes.size[a];
        if (n == 0 || n > Scan::kEdgeMax)
            fail("the file declares " + std::to_string(axes.size[0]) + " x " + std::to_string(axes.size[1]) +
                     " x " + std::to_string(axes.size[2]) + " voxels, outside 1 to " +
                     std::to_string(Scan::kEdgeMax) + " along an axis",
                 "crop the scan, or check the file");
        voxels *= n;
        const double step = axes.step_mm[a].norm();
        if (!(step >= kStepMinMm && step <= kStepMaxMm))
            fail("the voxel spacing along axis " + std::to_string(a) + " is " + std::to_string(step) +
                     " mm, outside 0.001 to 100",
                 "give --unit, or fix the spacing in the file");
        if (!(std::abs(axes.origin_mm[static_cast<int>(a)]) <= kFarMm))
            fail("the origin is " + std::to_string(axes.origin_mm[static_cast<int>(a)]) +
                     " mm away along an axis",
                 "fix the origin in the file");
    }
    if (voxels > kVoxelsMax)
        fail("the file declares " + std::to_string(voxels) + " voxels, more than " +
                 std::to_string(kVoxelsMax),
             "crop the scan");
    const Vec3 u = axes.step_mm[0].normalized(), v = axes.step_mm[1].normalized(), n = u.cross(v);
    if (std::abs(u.dot(v)) > 1e-3)
        fail("rows and columns are not at right angles",
             "resample the scan in the program that wrote the file");
    const double rise = axes.step_mm[2].dot(n);
    if (std::abs(rise) < 0.5 * axes.step_mm[2].norm())
        fail("the slices are shifted against each other by more than their spacing",
             "resample the scan in the program that wrote the file");
    Scan scan;
    scan.columns = static_cast<std::uint32_t>(axes.size[0]);
    scan.rows = static_cast<std::uint32_t>(axes.size[1]);
    scan.column_mm = axes.step_mm[0].norm();
    scan.row_mm = axes.step_mm[1].norm();
    scan.axes.col(0) = u;
    scan.axes.col(1) = (v - u.dot(v) * u).normalized();
    scan.axes.col(2) = scan.axes.col(0).cross(scan.axes.col(1));
    scan.origin_mm = axes.origin_mm;
    scan.oriented = axes.oriented;
    order.resize(static_cast<std::size_t>(axes.size[2]));
    std::iota(order.begin(), order.end(), 0U);
    if (rise < 0.0) std::reverse(order.begin(), order.end());
    for (const std::uint32_t k : order) {
        const Vec3 at = scan.axes.transpose() * (k * axes.step_mm[2]);
        scan.slice.push_back({at.x(), at.y(), at.z()});
    }
    return scan;
}

}  // namespace tact
