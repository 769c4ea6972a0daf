#include "ipc/scene/bone/distance_field.hpp"

#include <algorithm>
#include <cmath>
#include <cstring>

#include "ipc/scene/bone/bone_volume.hpp"
#include "ipc/scene/file/bytes.hpp"

namespace tact {
namespace {

constexpr SectionTag kDistanceTag{'D', 'I', 'S', 'T'};
constexpr std::uint32_t kDistanceVersion = 1;

struct DistanceHeader {
    std::uint32_t label;
    std::uint32_t size[3];
    double spacing_m;
    double origin_m[3];
    double quantum_m, error_m;
};
static_assert(sizeof(DistanceHeader) == 64);

std::string distance_fault(const DistanceField& f, std::size_t structures) {
    if (f.label == 0 || f.label > structures)
        return "it is for label " + std::to_string(f.label) + ", but the scene has " +
               std::to_string(structures) + " structures";
    // A distance grid has the same bounds as a volume, since it is not larger.
    BoneBricks as_bone;
    as_bone.size = f.size;
    as_bone.voxel_m = f.spacing_m;
    as_bone.origin_m = f.origin_m;
    if (std::string fault = bone_bricks_fault(as_bone); !fault.empty()) return fault;
    if (!(f.quantum_m >= 1e-9 && f.quantum_m <= f.spacing_m))
        return "the quantization step of its distances is out of range";
    if (!(f.error_m >= 0.0 && f.error_m <= 2.0 * f.spacing_m)) return "its stated error is out of range";
    if (f.quanta.size() != f.points())
        return "it has " + std::to_string(f.quanta.size()) + " distances, its size requires " +
               std::to_string(f.points());
    return {};
}

}  // namespace

double DistanceField::distance_m(const Vec3& model_m) const noexcept {
    std::array<std::size_t, 3> low;
    std::array<double, 3> t;
    double beyond2 = 0.0;  // distance beyond the grid, squared
    for (int a = 0; a < 3; ++a) {
        const auto k = static_cast<std::size_t>(a);
        const double at = (model_m[a] - origin_m[a]) / spacing_m;
        const double last = size[k] - 1.0;
        const double inside = at > 0.0 ? std::min(at, last) : 0.0;  // 0 for NaN
        const double off_m = spacing_m * (at - inside);
        beyond2 += off_m * off_m;
        low[k] =
            std::min(static_cast<std::size_t>(inside), static_cast<std::size_t>(std::max(last - 1.0, 0.0)));
        t[k] = inside - static_cast<double>(low[k]);
    }
    const std::size_t row = size[0], plane = std::size_t{size[0]} * size[1];
    const std::size_t right = size[0] > 1 ? 1 : 0, up = size[1] > 1 ? row : 0, on = size[2] > 1 ? plane : 0;
    const std::int16_t* const p = quanta.data() + low[2] * plane + low[1] * row + low[0];
    const auto along_x = [&](std::size_t o) {
        return (1.0 - t[0]) * static_cast<double>(p[o]) + t[0] * static_cast<double>(p[o + right]);
    };
    const auto along_y = [&](std::size_t o) { return (1.0 - t[1]) * along_x(o) + t[1] * along_x(o + up); };
    const double d = quantum_m * ((1.0 - t[2]) * along_y(0) + t[2] * along_y(on));
    if (beyond2 == 0.0) return d;
    // The grid is convex and contains the structure: the angle at the nearest point of the grid is not acute.
    const double outside = std::max(d, 0.0);
    return std::sqrt(outside * outside + beyond2);
}

void write_distance_field(SceneWriter& out, std::uint32_t index, const DistanceField& field) {
    if (const std::string fault = distance_fault(field, kDistanceFieldsMax); !fault.empty())
        throw StartupError("write distances to a structure", fault, "use a smaller volume");
    const DistanceHeader header{field.label,     {field.size[0], field.size[1], field.size[2]},
                                field.spacing_m, {field.origin_m.x(), field.origin_m.y(), field.origin_m.z()},
                                field.quantum_m, field.error_m};
    std::vector<std::byte> bytes(sizeof header + field.quanta.size_bytes());
    std::memcpy(bytes.data(), &header, sizeof header);
    std::memcpy(bytes.data() + sizeof header, field.quanta.data(), field.quanta.size_bytes());
    out.add(kDistanceTag, kDistanceVersion, index, std::move(bytes));
}

std::vector<DistanceField> read_distance_fields(const SceneFile& file, std::size_t structures) {
    std::vector<DistanceField> fields;
    std::array<bool, kDistanceFieldsMax + 1> seen{};
    const std::uint32_t count = file.count(kDistanceTag);
    for (std::uint32_t i = 0; i < count; ++i) {
        const std::span<const std::byte> bytes = file.section(kDistanceTag, kDistanceVersion, i);
        BytesIn in(bytes, file.name() + ", section DIST " + std::to_string(i));
        if (count > kDistanceFieldsMax)
            in.fail("the scene has " + std::to_string(count) + " such sections, more than 255");
        const auto header = in.get<DistanceHeader>("header");
        DistanceField f;
        f.label = header.label;
        f.size = {header.size[0], header.size[1], header.size[2]};
        f.spacing_m = header.spacing_m;
        f.origin_m = Vec3(header.origin_m[0], header.origin_m[1], header.origin_m[2]);
        f.quantum_m = header.quantum_m;
        f.error_m = header.error_m;
        const std::span<const std::byte> rest = bytes.subspan(sizeof header);
        if (rest.size() % 2 != 0 ||
            reinterpret_cast<std::uintptr_t>(rest.data()) % alignof(std::int16_t) != 0)
            in.fail("its distances are not a whole number of aligned 16-bit integers");
        f.quanta = {reinterpret_cast<const std::int16_t*>(rest.data()), rest.size() / 2};
        if (const std::string fault =
                distance_fault(f, std::min<std::size_t>(structures, kDistanceFieldsMax));
            !fault.empty())
            in.fail(fault);
        if (seen[f.label]) in.fail("the scene has another field for label " + std::to_string(f.label));
        seen[f.label] = true;
        fields.push_back(f);
    }
    return fields;
}

}  // namespace tact
