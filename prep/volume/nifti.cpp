// NIfTI-1 in one file (.nii, .nii.gz): https://nifti.nimh.nih.gov/nifti-1. NIfTI axes point right, front and up; scan
// axes point left, back and up.
//
// nifticlib interprets the header: orientation by matrix or quaternion, units, scale. It accepts any header, prints to
// standard error if it rejects one, and replaces invalid values (an axis of size 0 becomes 1), so size, axes, steps and
// datatype are checked here first. raw_scan.cpp reads the voxels and compares the declared size with the bytes in the
// file.
#include <nifti1_io.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>
#include <memory>
#include <optional>

#include "ipc/base/error.hpp"
#include "prep/volume/raw_scan.hpp"

namespace tact {
namespace {

std::optional<RawType> raw_type(int datatype) {
    switch (datatype) {
        case DT_UINT8:
            return RawType::u8;
        case DT_INT16:
            return RawType::i16;
        case DT_INT32:
            return RawType::i32;
        case DT_FLOAT32:
            return RawType::f32;
        case DT_FLOAT64:
            return RawType::f64;
        case DT_INT8:
            return RawType::i8;
        case DT_UINT16:
            return RawType::u16;
        case DT_UINT32:
            return RawType::u32;
        default:
            return std::nullopt;
    }
}

double nifti_unit_mm(int code, double otherwise) {
    switch (code) {
        case NIFTI_UNITS_METER:
            return 1000.0;
        case NIFTI_UNITS_MM:
            return 1.0;
        case NIFTI_UNITS_MICRON:
            return 1e-3;
        default:
            return otherwise;
    }
}

[[noreturn]] void fail(const std::string& attempt, const std::string& why) {
    throw StartupError(attempt, why, "export the scan again as NIfTI-1 in one file");
}

// Returns the header in native byte order. Checks it first, so that errors have our texts and not nifticlib's.
nifti_1_header checked_header(std::string_view bytes, const std::string& attempt, bool& swapped) {
    if (bytes.size() < 352)
        fail(attempt,
             "the file has " + std::to_string(bytes.size()) + " bytes, fewer than a NIfTI-1 header (352)");
    constexpr int kHeader = 348;
    nifti_1_header h{};
    static_assert(sizeof h == kHeader);
    std::memcpy(&h, bytes.data(), sizeof h);
    swapped = h.sizeof_hdr != kHeader;
    if (swapped) swap_nifti_header(&h, 1);
    if (h.sizeof_hdr != kHeader) fail(attempt, "the file does not begin with a NIfTI-1 header");
    if (std::memcmp(h.magic, "n+1", 4) != 0)
        fail(attempt, "header and voxels are separate files, or the format is older than NIfTI-1");
    const int axes = h.dim[0];
    for (int a = 4; a <= std::min(axes, 7); ++a)
        if (h.dim[a] > 1) fail(attempt, "the volume has more than three axes");
    if (axes < 3 || axes > 7) fail(attempt, "the volume has " + std::to_string(axes) + " axes instead of 3");
    if (!raw_type(h.datatype)) fail(attempt, "datatype " + std::to_string(h.datatype) + " is not supported");
    if (!(h.vox_offset >= 352.0F && h.vox_offset <= 1e9F))
        fail(attempt, "the voxel offset is " + std::to_string(static_cast<double>(h.vox_offset)) +
                          ", outside 352 to 1e9");
    const float orientation[] = {h.quatern_b, h.quatern_c, h.quatern_d,
                                 h.qoffset_x, h.qoffset_y, h.qoffset_z};
    if (h.qform_code > 0 && h.sform_code <= 0 &&
        !std::all_of(std::begin(orientation), std::end(orientation),
                     [](float x) { return std::isfinite(x); }))
        fail(attempt, "the orientation has a value that is not finite");
    return h;
}

void set_axes(const mat44& from, ScanAxes& axes) {
    for (int row = 0; row < 3; ++row) {
        for (int a = 0; a < 3; ++a)
            axes.step_mm[static_cast<std::size_t>(a)][row] = static_cast<double>(from.m[row][a]);
        axes.origin_mm[row] = static_cast<double>(from.m[row][3]);
    }
}

}  // namespace

RawHeader nifti_header(std::string_view bytes, const std::string& attempt, double unit_mm) {
    bool swapped = false;
    const nifti_1_header checked = checked_header(bytes, attempt, swapped);
    RawHeader h;
    bool steps_possible = true;
    for (int a = 0; a < 3; ++a) {
        h.axes.size[static_cast<std::size_t>(a)] =
            static_cast<std::uint64_t>(std::max<int>(0, checked.dim[a + 1]));
        const double step = std::abs(static_cast<double>(checked.pixdim[a + 1]));
        h.axes.step_mm[static_cast<std::size_t>(a)][a] = step;
        steps_possible = steps_possible && step > 0.0 && std::isfinite(step) && checked.dim[a + 1] > 0;
    }
    h.type = *raw_type(checked.datatype);
    h.big_endian = swapped == (std::endian::native == std::endian::little);
    h.offset = static_cast<std::uint64_t>(checked.vox_offset);
    // scan_of() rejects invalid sizes and steps. If the matrix gives the orientation, the steps do not matter.
    if (!steps_possible && !(checked.sform_code > 0 && checked.dim[1] > 0)) return h;
    const std::unique_ptr<nifti_image, void (*)(nifti_image*)> image(nifti_convert_nhdr2nim(checked, nullptr),
                                                                     &nifti_image_free);
    if (!image) fail(attempt, "nifticlib rejects the header");
    h.axes.oriented = image->sform_code > 0 || image->qform_code > 0;
    if (image->sform_code > 0)
        set_axes(image->sto_xyz, h.axes);
    else if (image->qform_code > 0)
        set_axes(image->qto_xyz, h.axes);
    const double unit = nifti_unit_mm(image->xyz_units, unit_mm);
    const Vec3 to_lps = h.axes.oriented ? Vec3(-unit, -unit, unit) : Vec3(unit, unit, unit);
    for (Vec3& s : h.axes.step_mm) s = s.cwiseProduct(to_lps);
    h.axes.origin_mm = h.axes.origin_mm.cwiseProduct(to_lps);
    if (image->scl_slope != 0.0F) {
        h.slope = static_cast<double>(image->scl_slope);
        h.intercept = static_cast<double>(image->scl_inter);
    }
    return h;
}

}  // namespace tact
