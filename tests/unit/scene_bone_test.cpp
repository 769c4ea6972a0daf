// The sections of a drilling scene (densities, labels, distances): data reads back unchanged, and invalid data is
// refused.
#include <gtest/gtest.h>

#include <cstring>

#include "ipc/scene/bone/bone_labels.hpp"
#include "ipc/scene/bone/bone_volume.hpp"
#include "ipc/scene/bone/distance_field.hpp"
#include "ipc/scene/file/scene_meta.hpp"
#include "tests/unit/scene_samples.hpp"

namespace tact::scene_bone_test {
namespace {

constexpr SectionTag kBone{'B', 'O', 'N', 'E'}, kLabl{'L', 'A', 'B', 'L'}, kDist{'D', 'I', 'S', 'T'};

struct Bone {
    BoneBricks bricks{{9, 8, 3}, 0.3e-3, Vec3(0.01, -0.02, 0.5)};  // two bricks, the second almost empty
    std::vector<std::uint8_t> density = std::vector<std::uint8_t>(bricks.bytes());
    std::vector<std::uint8_t> label = std::vector<std::uint8_t>(bricks.bytes());
    std::vector<std::int16_t> quanta = std::vector<std::int16_t>(3 * 2 * 2);
    BoneLabelsView labels;
    DistanceField field;
    Bone() {
        for (std::uint32_t z = 0; z < 3; ++z)
            for (std::uint32_t y = 0; y < 8; ++y)
                for (std::uint32_t x = 0; x < 9; ++x) {
                    density[bricks.voxel(x, y, z)] = static_cast<std::uint8_t>(1 + x + 9 * y + 72 * z);
                    label[bricks.voxel(x, y, z)] = static_cast<std::uint8_t>(x % 3);
                }
        labels.structure = {{"nervus facialis", {255, 220, 0, 255}, true}, {"incus", {9, 8, 7, 6}, false}};
        labels.label = label;
        for (std::size_t i = 0; i < quanta.size(); ++i)
            quanta[i] = static_cast<std::int16_t>(10 * (i % 3) - 5 * (i / 3 % 2) + 7 * (i / 6));
        field = {1, {3, 2, 2}, 1e-3, Vec3(0.0, 1.0, 2.0), 1e-5, 9e-4, quanta};
    }
    [[nodiscard]] BoneVolumeView view() const {
        BoneVolumeView v;
        v.bricks = bricks;
        v.hu_at_0 = 300.0F;
        v.hu_at_255 = 1800.0F;
        v.density = density;
        return v;
    }
    [[nodiscard]] std::vector<std::byte> scene() const {
        SceneWriter out;
        SceneMeta meta{};
        meta.kind = SceneKind::drilling;
        meta.world_per_model = 1.0;
        write_meta(out, meta, "made by: a test\n");
        write_bone_volume(out, view());
        write_bone_labels(out, bricks, labels);
        write_distance_field(out, 0, field);
        return out.to_bytes();
    }
};

// Returns the scene with one section changed and valid checksums, as an attacker would.
template <class Change>
std::vector<std::byte> changed(const std::vector<std::byte>& bytes, SectionTag tag, Change&& change) {
    const SceneFile file = SceneFile::from_bytes(bytes, "good");
    SceneWriter out;
    for (const SectionTag t : {kBone, kLabl, kDist}) {
        const auto s = file.section(t, 1);
        std::vector<std::byte> section(s.begin(), s.end());
        if (t == tag) change(section);
        out.add(t, 1, 0, std::move(section));
    }
    return out.to_bytes();
}
template <class T>
void poke(std::vector<std::byte>& bytes, std::size_t at, T value) {
    std::memcpy(bytes.data() + at, &value, sizeof value);
}

TEST(BoneVolume, reads_back_unchanged) {
    const Bone bone;
    const std::vector<std::byte> bytes = bone.scene();
    const SceneFile file = SceneFile::from_bytes(bytes, "bone");
    EXPECT_EQ(read_meta(file).kind, SceneKind::drilling);
    const BoneVolumeView v = read_bone_volume(file);
    EXPECT_EQ(v.bricks.size, bone.bricks.size);
    EXPECT_EQ(v.bricks.voxel_m, 0.3e-3);
    EXPECT_EQ(v.bricks.origin_m, bone.bricks.origin_m);
    EXPECT_EQ(v.hu_at_0, 300.0F);
    EXPECT_EQ(v.hu_at_255, 1800.0F);
    EXPECT_EQ(v.at(8, 7, 2), static_cast<std::uint8_t>(1 + 8 + 63 + 144));
    EXPECT_TRUE(std::equal(v.density.begin(), v.density.end(), bone.density.begin(), bone.density.end()));
    const BoneLabelsView l = read_bone_labels(file, v.bricks);
    ASSERT_EQ(l.structure.size(), 2U);
    EXPECT_EQ(l.structure[0].name, "nervus facialis");
    EXPECT_EQ(l.structure[1].rgba[3], 6);
    EXPECT_TRUE(l.critical(1));
    EXPECT_FALSE(l.critical(2) || l.critical(0));
    EXPECT_EQ(l.label[v.bricks.voxel(5, 1, 1)], 2);
    ASSERT_EQ(read_distance_fields(file, 2).size(), 1U);
}

TEST(BoneVolume, without_hounsfield_units_it_reports_none) {
    const Bone bone;
    BoneVolumeView v = bone.view();
    v.hu_at_0 = v.hu_at_255 = std::numeric_limits<float>::quiet_NaN();
    SceneWriter out;
    write_bone_volume(out, v);
    const std::vector<std::byte> bytes = out.to_bytes();
    EXPECT_FALSE(read_bone_volume(SceneFile::from_bytes(bytes, "bone")).has_hu());
    EXPECT_TRUE(bone.view().has_hu());
}

TEST(BoneVolume, invalid_sections_are_refused_by_name) {
    const std::vector<std::byte> bytes = Bone().scene();
    const auto refused = [&](SectionTag tag, const char* word, auto&& change) {
        SCOPED_TRACE(word);
        const std::vector<std::byte> bad = changed(bytes, tag, change);
        const std::string error = sample::error_of([&] {
            const SceneFile file = SceneFile::from_bytes(bad, "bad.tact");
            const BoneVolumeView v = read_bone_volume(file);
            (void)read_bone_labels(file, v.bricks);
            (void)read_distance_fields(file, 2);
        });
        EXPECT_NE(error.find(word), std::string::npos) << error;
        EXPECT_NE(error.find(std::string("section ") + std::string(tag.begin(), tag.end())),
                  std::string::npos)
            << error;
        EXPECT_NE(error.find("fix:"), std::string::npos);
    };
    using Bytes = std::vector<std::byte>;
    refused(kBone, "voxels", [](Bytes& b) { poke(b, 0, 0U); });
    refused(kBone, "voxels", [](Bytes& b) { poke(b, 0, 4000000000U); });
    refused(kBone, "voxels", [](Bytes& b) {
        for (int a = 0; a < 3; ++a) poke(b, 4U * a, 2048U);
    });
    refused(kBone, "densities", [](Bytes& b) { poke(b, 0, 20U); });
    refused(kBone, "beyond its size", [](Bytes& b) { poke(b, 4, 7U); });
    refused(kBone, "bricks", [](Bytes& b) { poke(b, 12, 16U); });
    refused(kBone, "voxel is", [](Bytes& b) { poke(b, 16, -1.0); });
    refused(kBone, "origin", [](Bytes& b) { poke(b, 32, std::nan("")); });
    refused(kBone, "Hounsfield", [](Bytes& b) { poke(b, 48, 5000.0F); });
    refused(kBone, "Hounsfield", [](Bytes& b) { poke(b, 48, std::nanf("")); });
    refused(kBone, "reserved", [](Bytes& b) { poke(b, 60, 1U); });
    refused(kBone, "header", [](Bytes& b) { b.resize(63); });
    refused(kLabl, "size", [](Bytes& b) { poke(b, 0, 8U); });
    refused(kLabl, "structures", [](Bytes& b) { poke(b, 12, 0U); });
    refused(kLabl, "structures", [](Bytes& b) { poke(b, 12, 255U); });
    refused(kLabl, "label 2, but the table has 1", [](Bytes& b) {
        poke(b, 12, 1U);
        b.erase(b.begin() + 128, b.begin() + 192);
    });
    refused(kLabl, "zero byte", [](Bytes& b) { std::memset(b.data() + 64, 'a', 48); });
    refused(kLabl, "control", [](Bytes& b) { poke(b, 64, '\033'); });
    refused(kLabl, "no name", [](Bytes& b) { poke(b, 64, '\0'); });
    refused(kLabl, "neither 0 nor 1", [](Bytes& b) { poke(b, 64 + 52, 2U); });
    refused(kLabl, "beyond the size", [](Bytes& b) { b.back() = std::byte{1}; });
    refused(kLabl, "labels", [](Bytes& b) { b.pop_back(); });
    refused(kDist, "label 3", [](Bytes& b) { poke(b, 0, 3U); });
    refused(kDist, "label 0", [](Bytes& b) { poke(b, 0, 0U); });
    refused(kDist, "distances", [](Bytes& b) { poke(b, 4, 5U); });
    refused(kDist, "16-bit", [](Bytes& b) { b.pop_back(); });
    refused(kDist, "step", [](Bytes& b) { poke(b, 48, 0.0); });
    refused(kDist, "error", [](Bytes& b) { poke(b, 56, 1.0); });
}

TEST(BoneVolume, nothing_unreadable_is_written) {
    Bone bone;
    SceneWriter out;
    BoneVolumeView v = bone.view();
    v.bricks.size[0] = 4000;
    EXPECT_THROW(write_bone_volume(out, v), StartupError);
    bone.labels.structure[0].name = std::string(48, 'n');
    EXPECT_THROW(write_bone_labels(out, bone.bricks, bone.labels), StartupError);
    bone.field.quanta = {};
    EXPECT_THROW(write_distance_field(out, 0, bone.field), StartupError);
}

TEST(DistanceField, is_linear_between_its_points_and_a_lower_bound_beyond_them) {
    const Bone bone;  // +10 quanta per step along x, -5 along y, +7 along z
    const DistanceField& f = bone.field;
    const auto at = [&](double x, double y, double z) {
        return f.distance_m(f.origin_m + 1e-3 * Vec3(x, y, z)) / f.quantum_m;
    };
    EXPECT_NEAR(at(0, 0, 0), 0.0, 1e-9);
    EXPECT_NEAR(at(2, 1, 1), 22.0, 1e-9);
    EXPECT_NEAR(at(1.25, 0.5, 0.75), 12.5 - 2.5 + 5.25, 1e-9);
    EXPECT_NEAR(at(5, 0, 0), std::hypot(20.0, 300.0), 1e-9);
    EXPECT_NEAR(at(0, 4, 0), 300.0, 1e-9)
        << "at the edge inside the structure only the lower bound 0 is known";
    EXPECT_TRUE(std::isfinite(at(0.5, 0.5, 0.5)));
    EXPECT_FALSE(std::isfinite(at(std::nan(""), 0, 0)));
    EXPECT_GT(at(1e300, -1e300, 0), 1e100);
}

}  // namespace
}  // namespace tact::scene_bone_test
