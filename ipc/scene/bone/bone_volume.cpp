#include "ipc/scene/bone/bone_volume.hpp"

#include <algorithm>
#include <cstring>

#include "ipc/scene/file/bytes.hpp"

namespace tact {
namespace {

constexpr SectionTag kBoneTag{'B', 'O', 'N', 'E'};
constexpr std::uint32_t kBoneVersion = 1;

struct BoneHeader {
    std::uint32_t size[3];
    std::uint32_t edge;  // of a brick
    double voxel_m;
    double origin_m[3];
    float hu_at_0, hu_at_255;
    std::uint32_t reserved[2];  // zero
};
static_assert(sizeof(BoneHeader) == 64);

constexpr double kBoneVoxelMinM = 1e-6, kBoneVoxelMaxM = 0.1, kBoneOriginMaxM = 100.0;
constexpr float kBoneHuMax = 1e6F;

std::string bone_hu_fault(float at_0, float at_255) {
    if (std::isnan(at_0) && std::isnan(at_255)) return {};
    if (at_0 >= -kBoneHuMax && at_255 <= kBoneHuMax && at_0 < at_255) return {};
    return "its densities represent " + std::to_string(at_0) + " to " + std::to_string(at_255) +
           " Hounsfield units, an impossible range";
}

}  // namespace

std::string bone_bricks_fault(const BoneBricks& bricks) {
    for (const std::uint32_t n : bricks.size) {
        if (n == 0 || n > kBoneEdgeMax)
            return "it is " + std::to_string(bricks.size[0]) + " x " + std::to_string(bricks.size[1]) +
                   " x " + std::to_string(bricks.size[2]) + " voxels; allowed along each axis are 1 to " +
                   std::to_string(kBoneEdgeMax);
    }
    if (bricks.bytes() > kBoneBytesMax)
        return "it has " + std::to_string(bricks.bytes()) + " voxels, more than " +
               std::to_string(kBoneBytesMax);
    if (!(bricks.voxel_m >= kBoneVoxelMinM && bricks.voxel_m <= kBoneVoxelMaxM))
        return "its voxel is " + std::to_string(1e3 * bricks.voxel_m) +
               " mm wide; 0.001 to 100 mm are allowed";
    for (const double x : bricks.origin_m)
        if (!(std::abs(x) <= kBoneOriginMaxM))
            return "its origin is " + std::to_string(x) + " m away; up to 100 m are allowed";
    return {};
}

bool zero_beyond_size(const BoneBricks& bricks, std::span<const std::uint8_t> voxel) {
    constexpr std::uint32_t kEdge = BoneBricks::kEdge;
    const auto n = bricks.bricks();
    std::size_t brick = 0;
    for (std::uint32_t bz = 0; bz < n[2]; ++bz) {
        for (std::uint32_t by = 0; by < n[1]; ++by) {
            for (std::uint32_t bx = 0; bx < n[0]; ++bx, ++brick) {
                const std::uint32_t wide = std::min(kEdge, bricks.size[0] - bx * kEdge);
                const std::uint32_t high = std::min(kEdge, bricks.size[1] - by * kEdge);
                const std::uint32_t deep = std::min(kEdge, bricks.size[2] - bz * kEdge);
                if (wide == kEdge && high == kEdge && deep == kEdge) continue;
                const std::uint8_t* at = voxel.data() + brick * BoneBricks::kVoxels;
                for (std::uint32_t z = 0; z < kEdge; ++z)
                    for (std::uint32_t y = 0; y < kEdge; ++y)
                        for (std::uint32_t x = 0; x < kEdge; ++x, ++at)
                            if (*at != 0 && (x >= wide || y >= high || z >= deep)) return false;
            }
        }
    }
    return true;
}

void write_bone_volume(SceneWriter& out, const BoneVolumeView& volume) {
    std::string fault = bone_bricks_fault(volume.bricks);
    if (fault.empty()) fault = bone_hu_fault(volume.hu_at_0, volume.hu_at_255);
    if (fault.empty() && volume.density.size() != volume.bricks.bytes())
        fault = "it has " + std::to_string(volume.density.size()) + " densities instead of " +
                std::to_string(volume.bricks.bytes());
    if (!fault.empty())
        throw StartupError("write a volume of bone", fault,
                           "crop the volume, or resample it to another voxel size");
    const BoneBricks& b = volume.bricks;
    const BoneHeader header{{b.size[0], b.size[1], b.size[2]},
                            BoneBricks::kEdge,
                            b.voxel_m,
                            {b.origin_m.x(), b.origin_m.y(), b.origin_m.z()},
                            volume.hu_at_0,
                            volume.hu_at_255,
                            {}};
    std::vector<std::byte> bytes(sizeof header + volume.density.size());
    std::memcpy(bytes.data(), &header, sizeof header);
    std::memcpy(bytes.data() + sizeof header, volume.density.data(), volume.density.size());
    out.add(kBoneTag, kBoneVersion, 0, std::move(bytes));
}

BoneVolumeView read_bone_volume(const SceneFile& file) {
    const std::span<const std::byte> bytes = file.section(kBoneTag, kBoneVersion);
    BytesIn in(bytes, file.name() + ", section BONE");
    const auto header = in.get<BoneHeader>("header");
    BoneVolumeView volume;
    volume.bricks.size = {header.size[0], header.size[1], header.size[2]};
    volume.bricks.voxel_m = header.voxel_m;
    volume.bricks.origin_m = Vec3(header.origin_m[0], header.origin_m[1], header.origin_m[2]);
    volume.hu_at_0 = header.hu_at_0;
    volume.hu_at_255 = header.hu_at_255;
    if (header.edge != BoneBricks::kEdge)
        in.fail("its bricks are " + std::to_string(header.edge) + " voxels wide instead of " +
                std::to_string(BoneBricks::kEdge));
    if (header.reserved[0] != 0 || header.reserved[1] != 0) in.fail("a reserved field is not zero");
    for (const std::string& fault :
         {bone_bricks_fault(volume.bricks), bone_hu_fault(volume.hu_at_0, volume.hu_at_255)})
        if (!fault.empty()) in.fail(fault);
    const std::span<const std::byte> rest = bytes.subspan(sizeof header);
    if (rest.size() != volume.bricks.bytes())
        in.fail("it has " + std::to_string(rest.size()) + " densities, its size requires " +
                std::to_string(volume.bricks.bytes()));
    volume.density = {reinterpret_cast<const std::uint8_t*>(rest.data()), rest.size()};
    if (!zero_beyond_size(volume.bricks, volume.density))
        in.fail("a voxel beyond its size, in its last bricks, contains bone");
    return volume;
}

}  // namespace tact
