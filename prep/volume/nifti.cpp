// NIfTI-1 in one file (.nii, .nii.gz): https://nifti.nimh.nih.gov/nifti-1. Its axes point right, front and up; ours
// left, back and up.
#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstring>

#include "ipc/base/error.hpp"
#include "prep/volume/raw_scan.hpp"

namespace tact {
namespace {

class NiftiBytes {
public:
    NiftiBytes(std::string_view bytes, bool swap) : bytes_(bytes), swap_(swap) {}
    template <class T>
    [[nodiscard]] T at(std::size_t offset) const {
        std::array<char, sizeof(T)> raw;
        std::memcpy(raw.data(), bytes_.data() + offset, sizeof(T));
        if (swap_) std::reverse(raw.begin(), raw.end());
        T value;
        std::memcpy(&value, raw.data(), sizeof(T));
        return value;
    }
    [[nodiscard]] double number(std::size_t offset) const { return static_cast<double>(at<float>(offset)); }

private:
    std::string_view bytes_;
    bool swap_;
};

// From the quaternion (method 2 of the format's text).
void by_quaternion(const NiftiBytes& in, const std::array<double, 3>& step, ScanAxes& axes) {
    const double b = in.number(256), c = in.number(260), d = in.number(264);
    const double a = std::sqrt(std::max(0.0, 1.0 - b * b - c * c - d * d));
    const double side = in.number(76) < 0.0 ? -1.0 : 1.0;
    axes.step_mm[0] = step[0] * Vec3(a * a + b * b - c * c - d * d, 2 * (b * c + a * d), 2 * (b * d - a * c));
    axes.step_mm[1] = step[1] * Vec3(2 * (b * c - a * d), a * a + c * c - b * b - d * d, 2 * (c * d + a * b));
    axes.step_mm[2] =
        side * step[2] * Vec3(2 * (b * d + a * c), 2 * (c * d - a * b), a * a + d * d - b * b - c * c);
    axes.origin_mm = Vec3(in.number(268), in.number(272), in.number(276));
}

double nifti_unit_mm(int code, double otherwise) {
    switch (code & 7) {
        case 1:
            return 1000.0;
        case 2:
            return 1.0;
        case 3:
            return 1e-3;
        default:
            return otherwise;
    }
}

}  // namespace

RawHeader nifti_header(std::string_view bytes, const std::string& attempt, double unit_mm) {
    const auto fail = [&](const std::string& why, const char* fix = "export it again as NIfTI-1, one file") {
        throw StartupError(attempt, why, fix);
    };
    if (bytes.size() < 352)
        fail("it has " + std::to_string(bytes.size()) + " bytes, fewer than a header (352)");
    std::int32_t first = 0;
    std::memcpy(&first, bytes.data(), sizeof first);
    constexpr std::int32_t kHeader = 348;
    const bool swap = first != kHeader;
    const NiftiBytes in(bytes, swap);
    if (in.at<std::int32_t>(0) != kHeader) fail("it does not begin as a NIfTI-1 file does");
    if (std::memcmp(bytes.data() + 344, "n+1", 4) != 0)
        fail("its header and its voxels are two files, or it is older");
    RawHeader h;
    h.big_endian = swap == (std::endian::native == std::endian::little);
    const int axes = in.at<std::int16_t>(40);
    for (int a = 4; a <= std::min(axes, 7); ++a)
        if (in.at<std::int16_t>(40 + 2 * static_cast<std::size_t>(a)) > 1)
            fail("it has more than three axes");
    if (axes < 3 || axes > 7) fail("it has " + std::to_string(axes) + " axes instead of 3");
    const double unit = nifti_unit_mm(bytes[123], unit_mm);
    std::array<double, 3> step{};
    for (std::size_t a = 0; a < 3; ++a) {
        h.axes.size[a] = static_cast<std::uint64_t>(std::max<int>(0, in.at<std::int16_t>(42 + 2 * a)));
        step[a] = std::abs(in.number(80 + 4 * a));
    }
    const int qform = in.at<std::int16_t>(252), sform = in.at<std::int16_t>(254);
    h.axes.oriented = sform > 0 || qform > 0;
    if (sform > 0) {
        for (int row = 0; row < 3; ++row) {
            const std::size_t at = 280 + 16 * static_cast<std::size_t>(row);
            for (std::size_t a = 0; a < 3; ++a) h.axes.step_mm[a][row] = in.number(at + 4 * a);
            h.axes.origin_mm[row] = in.number(at + 12);
        }
    } else if (qform > 0) {
        by_quaternion(in, step, h.axes);
    } else {
        for (std::size_t a = 0; a < 3; ++a) h.axes.step_mm[a][static_cast<int>(a)] = step[a];
    }
    const Vec3 to_lps = h.axes.oriented ? Vec3(-unit, -unit, unit) : Vec3(unit, unit, unit);
    for (Vec3& s : h.axes.step_mm) s = s.cwiseProduct(to_lps);
    h.axes.origin_mm = h.axes.origin_mm.cwiseProduct(to_lps);
    switch (in.at<std::int16_t>(70)) {
        case 2:
            h.type = RawType::u8;
            break;
        case 4:
            h.type = RawType::i16;
            break;
        case 8:
            h.type = RawType::i32;
            break;
        case 16:
            h.type = RawType::f32;
            break;
        case 64:
            h.type = RawType::f64;
            break;
        case 256:
            h.type = RawType::i8;
            break;
        case 512:
            h.type = RawType::u16;
            break;
        case 768:
            h.type = RawType::u32;
            break;
        default:
            fail("its datatype is " + std::to_string(in.at<std::int16_t>(70)) + ", which is not read");
    }
    const double offset = in.number(108);
    if (!(offset >= 352.0 && offset <= 1e9)) fail("its voxels begin at byte " + std::to_string(offset));
    h.offset = static_cast<std::uint64_t>(offset);
    const double slope = in.number(112);
    if (slope != 0.0) {
        h.slope = slope;
        h.intercept = in.number(116);
    }
    return h;
}

}  // namespace tact
