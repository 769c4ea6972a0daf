#include "ipc/scene/bone/patient_frame.hpp"

#include <Eigen/LU>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <vector>

#include "ipc/base/error.hpp"
#include "ipc/scene/file/bytes.hpp"

namespace tact {
namespace {

constexpr SectionTag kPatientTag{'P', 'A', 'T', 'I'};
constexpr std::uint32_t kPatientVersion = 1;
using Numbers = std::array<double, 12>;

std::string patient_fault(const PatientFrame& f) {
    if (!f.axes.allFinite() || !f.origin_mm.allFinite()) return "a number is not finite";
    if ((f.axes.transpose() * f.axes - Eigen::Matrix3d::Identity()).cwiseAbs().maxCoeff() > 1e-6)
        return "its axes are not at right angles or not of length 1";
    if (f.axes.determinant() < 0.0) return "its axes are mirrored";
    if (f.origin_mm.cwiseAbs().maxCoeff() > PatientFrame::kFarMm)
        return "its origin is farther than 100 m from the scan's";
    return {};
}

}  // namespace

std::string patient_letters(const Vec3& direction) {
    constexpr const char* kBelow = "RAF";
    constexpr const char* kAbove = "LPH";
    std::array<int, 3> order{0, 1, 2};
    std::sort(order.begin(), order.end(),
              [&](int a, int b) { return std::abs(direction[a]) > std::abs(direction[b]); });
    std::string letters;
    for (const int a : order)
        if (std::abs(direction[a]) > 0.1 * std::abs(direction[order[0]]))
            letters += (direction[a] < 0.0 ? kBelow : kAbove)[a];
    return letters;
}

void write_patient_frame(SceneWriter& out, const PatientFrame& frame) {
    if (const std::string fault = patient_fault(frame); !fault.empty())
        throw StartupError("write where the bone lies in the patient", fault, "give a scan with right axes");
    Numbers numbers{};
    std::copy_n(frame.axes.data(), 9, numbers.begin());  // column by column
    std::copy_n(frame.origin_mm.data(), 3, numbers.begin() + 9);
    std::vector<std::byte> bytes(sizeof numbers);
    std::memcpy(bytes.data(), numbers.data(), sizeof numbers);
    out.add(kPatientTag, kPatientVersion, 0, std::move(bytes));
}

std::optional<PatientFrame> read_patient_frame(const SceneFile& file) {
    if (file.count(kPatientTag) == 0) return std::nullopt;
    const std::span<const std::byte> bytes = file.section(kPatientTag, kPatientVersion);
    BytesIn in(bytes, file.name() + ", section PATI");
    const auto numbers = in.get<Numbers>("axes and origin");
    if (bytes.size() != sizeof numbers) in.fail("it is longer than its 12 numbers");
    PatientFrame frame;
    std::copy_n(numbers.begin(), 9, frame.axes.data());
    std::copy_n(numbers.begin() + 9, 3, frame.origin_mm.data());
    if (const std::string fault = patient_fault(frame); !fault.empty()) in.fail(fault);
    return frame;
}

}  // namespace tact
