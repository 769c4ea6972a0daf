// The threshold that tells bone from soft tissue, with and without a known unit.
#include <gtest/gtest.h>

#include <algorithm>
#include <numeric>

#include "ipc/base/error.hpp"
#include "ipc/base/random.hpp"
#include "prep/drilling/bone_threshold.hpp"
#include "prep/drilling/import_bone.hpp"
#include "tests/support/says.hpp"
#include "tests/unit/prep_scan_imports.hpp"

namespace tact::prep_bone_threshold_test {
namespace {

using sample::of;
using sample::refusal;
using sample::ScanFolder;

// A head of 8 bits: air, soft tissue of 90 +- 12 in half of the voxels, bone of 200 +- 15 in a twentieth, and a clip of metal.
TEST(BoneThreshold, of_a_body_lies_between_soft_tissue_and_bone) {
    for (const double scale : {1.0, 11.0}) {  // 8 bits, and other values
        Scan scan;
        scan.columns = scan.rows = 100;
        scan.slice.resize(10);
        scan.read = [scale](std::uint32_t slice, std::span<float> pixels) {
            SeededRandom random(slice + 1);
            for (float& v : pixels) {
                const double which = random.uniform(), wide = 2.0 * random.uniform() - 1.0;
                v = static_cast<float>(scale * (which < 0.45     ? 2.0
                                                : which < 0.95   ? 90.0 + 25.0 * wide
                                                : which < 0.9998 ? 200.0 + 30.0 * wide
                                                                 : 255.0 * scale));
            }
        };
        const std::optional<ScanHistogram> histogram = scan_histogram(scan);
        ASSERT_TRUE(histogram);
        EXPECT_EQ(std::accumulate(histogram->count.begin(), histogram->count.end(), 0.0), 1e5);
        EXPECT_NEAR(histogram->low, scale * 2.0, 1e-3);
        EXPECT_LT(histogram->high, scale * 240.0) << "without the metal";
        const std::optional<ProposedBone> bone = propose_bone(*histogram);
        EXPECT_GT(bone->threshold, scale * 113.0) << scale;
        EXPECT_LT(bone->threshold, scale * 172.0) << scale;
        EXPECT_NEAR(bone->share_above, 0.05, 0.004);
        EXPECT_GT(bone->solid, scale * 215.0);
        EXPECT_LT(bone->solid, scale * 240.0);
        scan.read = [](std::uint32_t, std::span<float> pixels) {
            std::fill(pixels.begin(), pixels.end(), 7.0F);
        };
        EXPECT_FALSE(scan_histogram(scan));
    }
}

TEST(BoneThreshold, of_8_bits_is_said_and_of_an_unknown_unit_is_part_of_the_refusal) {
    const ScanFolder f;
    std::string grey, wide;
    for (int i = 0; i < 6 * 5 * 40; ++i) {
        const int value = i % 20 < 9 ? 3 : i % 20 < 19 ? 90 + i % 7 : 200 + i % 5;
        grey += static_cast<char>(value);
        sample::put(wide, static_cast<std::int16_t>(10 * value));
    }
    const std::string head =
        "NRRD0004\ndimension: 3\nsizes: 6 5 40\nspacings: 1 1 1\nencoding: raw\nendian: little\n";
    BoneImport o = of(f.write("grey.nrrd", head + "type: uint8\n\n" + grey));
    std::string warned;
    o.warn = [&](const std::string& line) { warned += line; };
    const BoneInput input = import_bone(o);
    EXPECT_TRUE(says(warned, {"8-bit values have no unit", "5.0 % of the voxels", "--threshold-hu"}))
        << warned;
    const auto solid = static_cast<std::size_t>(std::count_if(
        input.bone.density.begin(), input.bone.density.end(), [](std::uint8_t d) { return d > 0; }));
    EXPECT_EQ(solid, 60U) << "a twentieth of 1200";
    EXPECT_TRUE(says(refusal(of(f.write("wide.nrrd", head + "type: int16\n\n" + wide))),
                     {"the unit of the values is unknown", "its histogram suggests --threshold-hu"}));
}

}  // namespace
}  // namespace tact::prep_bone_threshold_test
