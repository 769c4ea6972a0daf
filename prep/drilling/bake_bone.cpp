#include "prep/drilling/bake_bone.hpp"

#include <algorithm>
#include <array>

#include "ipc/base/error.hpp"
#include "ipc/base/printed.hpp"
#include "prep/drilling/approach.hpp"
#include "prep/drilling/brick_rows.hpp"
#include "prep/drilling/distance.hpp"

namespace tact {
namespace {

struct BoneBox {
    std::array<std::uint32_t, 3> low{UINT32_MAX, UINT32_MAX, UINT32_MAX}, high{};
    std::uint64_t voxels = 0, sum = 0;
};

BoneBox measure(const BoneData& bone, BoneHeights& heights) {
    BoneBox box;
    const auto& n = bone.bricks.size;
    std::vector<std::uint8_t> row(brick_row_bytes(bone.bricks));
    for (std::uint32_t z = 0; z < n[2]; ++z) {
        for (std::uint32_t y = 0; y < n[1]; ++y) {
            brick_row(bone.bricks, bone.density, y, z, row);
            heights.add_row(y, z, row);
            for (std::uint32_t x = 0; x < n[0]; ++x) {
                const std::uint8_t d = row[x];
                if (d == 0) continue;
                ++box.voxels;
                box.sum += d;
                const std::array at{x, y, z};
                for (std::size_t a = 0; a < 3; ++a) {
                    box.low[a] = std::min(box.low[a], at[a]);
                    box.high[a] = std::max(box.high[a], at[a]);
                }
            }
        }
    }
    return box;
}

BoneHeights::Place place_hand(const BoneBricks& bricks, const BoneBox& box, const BoneHeights& heights,
                              SceneMeta& meta) {
    const Vec3 low = bricks.to_model(Vec3(box.low[0], box.low[1], box.low[2]));
    const Vec3 high = bricks.to_model(Vec3(box.high[0], box.high[1], box.high[2]));
    const BoneHeights::Place place = heights.place(0.5 * (low + high));
    meta.world_per_model = 1.0;
    meta.centre_model_m[0] = place.surface_m.x();
    meta.centre_model_m[1] = place.surface_m.y();
    meta.centre_model_m[2] = place.front_m + BoneInput::kInFrontM;
    return place;
}

}  // namespace

double bake_bytes(const BoneBricks& bricks, bool labelled, std::size_t fields) {
    // Densities or labels, their sections, and the bytes of the file; each distance field as section and in the file.
    const auto voxels = static_cast<double>(bricks.bytes());
    const double step = distance_step(bricks);
    constexpr double kProgramBytes = 2e7;
    return kProgramBytes +
           voxels * (labelled ? 5.0 + 4.0 * static_cast<double>(fields) / (step * step * step) : 3.0);
}

BakedBone bake_bone(BoneInput&& input, SceneWriter& out, const Progress& progress) {
    BakedBone baked;
    BoneData& bone = input.bone;
    const BoneBricks& b = bone.bricks;
    report(progress, 0.5, "finding the bone surface");
    BoneHeights heights(b);
    const BoneBox box = measure(bone, heights);
    if (box.voxels == 0)
        throw StartupError("bake a volume of bone", "no voxel is bone",
                           "give a lower --threshold-hu, or another part with --crop");
    baked.meta.kind = SceneKind::drilling;
    const BoneHeights::Place place = place_hand(b, box, heights, baked.meta);
    input.title.copy(baked.meta.title, sizeof baked.meta.title - 1);
    baked.bone_voxels = box.voxels;
    const double voxel_m3 = b.voxel_m * b.voxel_m * b.voxel_m;
    baked.bone_m3 = static_cast<double>(box.sum) / 255.0 * voxel_m3;
    for (const std::string& line : input.note) baked.note += line + '\n';
    baked.note +=
        printed("volume: %u x %u x %u voxels of %.4g mm\n", b.size[0], b.size[1], b.size[2], 1e3 * b.voxel_m);
    baked.note +=
        printed("bone: %.4g cm3, %.1f %% of the voxels are not empty\n", 1e6 * baked.bone_m3,
                100.0 * static_cast<double>(box.voxels) / (double{1} * b.size[0] * b.size[1] * b.size[2]));
    baked.note +=
        printed("hand: starts %.1f mm in front of the bone at (%.2f, %.2f, %.2f) mm in the model frame\n",
                1e3 * (baked.meta.centre_model_m[2] - place.surface_m.z()), 1e3 * place.surface_m.x(),
                1e3 * place.surface_m.y(), 1e3 * place.surface_m.z());
    if (bone.view().has_hu())
        baked.note += printed("density: 0 at %g HU and below, 255 at %g HU and above\n",
                              static_cast<double>(bone.hu_at_0), static_cast<double>(bone.hu_at_255));
    write_bone_volume(out, bone.view());
    if (bone.patient) write_patient_frame(out, *bone.patient);
    std::vector<std::uint8_t>().swap(bone.density);
    if (!bone.structure.empty()) {
        std::array<std::uint64_t, 256> count{};
        for (const std::uint8_t l : bone.label) ++count[l];
        std::vector<std::uint8_t> critical;
        for (std::size_t i = 0; i < bone.structure.size(); ++i)
            if (bone.structure[i].critical && count[i + 1] > 0)
                critical.push_back(static_cast<std::uint8_t>(i + 1));
        double error_m = 0.0, spacing_m = 0.0;
        for (std::size_t i = 0; i < critical.size(); ++i) {
            const double share = 0.48 / static_cast<double>(critical.size()),
                         from = 0.5 + share * static_cast<double>(i);
            const BuiltDistances built =
                build_distances(b, bone.label, critical[i], part(progress, from, from + share));
            write_distance_field(out, baked.distance_fields++, built.view());
            error_m = built.field.error_m;
            spacing_m = built.field.spacing_m;
        }
        for (std::size_t i = 0; i < bone.structure.size(); ++i)
            baked.note += printed("structure: %s, %.4g mm3%s\n", bone.structure[i].name.c_str(),
                                  1e9 * voxel_m3 * static_cast<double>(count[i + 1]),
                                  bone.structure[i].critical ? ", critical" : "");
        if (!critical.empty())
            baked.note +=
                printed("distances: every %.3g mm, error at most %.2g mm\n", 1e3 * spacing_m, 1e3 * error_m);
        write_bone_labels(out, b, {bone.structure, bone.label});
    }
    write_meta(out, baked.meta, baked.note);
    return baked;
}

}  // namespace tact
