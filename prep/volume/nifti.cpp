// NIfTI-1 in one file (.nii, .nii.gz): https://nifti.nimh.nih.gov/nifti-1. Its axes point right, front and up; ours
// left, back and up.
//
// nifticlib interprets the header: orientation by matrix or quaternion, units, scale. It takes a header of any
// content, prints to standard error where it refuses one, and replaces what is not possible (an axis of size 0
// becomes 1), so the size, the axes, the steps and the datatype are checked here first. The voxels are read by
// raw_scan.cpp, which compares what a header declares with the bytes that are there.
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
    throw StartupError(attempt, why, "export it again as NIfTI-1, one file");
}

// The header in this machine's byte order, and what nifticlib would not refuse in our words.
nifti_1_header checked_header(std::string_view bytes, const std::string& attempt, bool& swapped) {
    if (bytes.size() < 352)
        fail(attempt, "it has " + std::to_string(bytes.size()) + " bytes, fewer than a header (352)");
    constexpr int kHeader = 348;
    nifti_1_header h{};
    static_assert(sizeof h == kHeader);
    std::memcpy(&h, bytes.data(), sizeof h);
    swapped = h.sizeof_hdr != kHeader;
    if (swapped) swap_nifti_header(&h, 1);
    if (h.sizeof_hdr != kHeader) fail(attempt, "it does not begin as a NIfTI-1 file does");
    if (std::memcmp(h.magic, "n+1", 4) != 0)
        fail(attempt, "its header and its voxels are two files, or it is older");
    const int axes = h.dim[0];
    for (int a = 4; a <= std::min(axes, 7); ++a)
        if (h.dim[a] > 1) fail(attempt, "it has more than three axes");
    if (axes < 3 || axes > 7) fail(attempt, "it has " + std::to_string(axes) + " axes instead of 3");
    if (!raw_type(h.datatype))
        fail(attempt, "its datatype is " + std::to_string(h.datatype) + ", which is not read");
    if (!(h.vox_offset >= 352.0F && h.vox_offset <= 1e9F))
        fail(attempt, "its voxels begin at byte " + std::to_string(static_cast<double>(h.vox_offset)));
    const float orientation[] = {h.quatern_b, h.quatern_c, h.quatern_d,
                                 h.qoffset_x, h.qoffset_y, h.qoffset_z};
    if (h.qform_code > 0 && h.sform_code <= 0 &&
        !std::all_of(std::begin(orientation), std::end(orientation),
                     [](float x) { return std::isfinite(x); }))
        fail(attempt, "its orientation is not made of numbers");
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
    // Impossible sizes and steps are refused by scan_of(); by the matrix, steps do not count.
    if (!steps_possible && !(checked.sform_code > 0 && checked.dim[1] > 0)) return h;
    const std::unique_ptr<nifti_image, void (*)(nifti_image*)> image(nifti_convert_nhdr2nim(checked, nullptr),
                                                                     &nifti_image_free);
    if (!image) fail(attempt, "nifticlib does not read its header");
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
