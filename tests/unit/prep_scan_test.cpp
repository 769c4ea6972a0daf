// Readers of scans: every format and axis order gives the same bone, and errors are reported.
#include <gtest/gtest.h>
#include <zlib.h>

#include <algorithm>

#include "ipc/base/error.hpp"
#include "ipc/image/png.hpp"
#include "prep/drilling/import_bone.hpp"
#include "prep/volume/png_stack.hpp"
#include "tests/support/says.hpp"
#include "tests/unit/prep_scan_imports.hpp"

namespace tact::prep_scan_test {
namespace {

namespace fs = std::filesystem;
using sample::ScanFolder;

using sample::expect_bone;
using sample::hu;
using sample::numbered;
using sample::of;
using sample::refusal;
using sample::told;

std::string gzip(const std::string& plain) {
    std::string out(plain.size() + 200, '\0');
    z_stream z{};
    deflateInit2(&z, 6, Z_DEFLATED, 15 + 16, 8, Z_DEFAULT_STRATEGY);
    z.next_in = reinterpret_cast<Bytef*>(const_cast<char*>(plain.data()));
    z.avail_in = static_cast<uInt>(plain.size());
    z.next_out = reinterpret_cast<Bytef*>(out.data());
    z.avail_out = static_cast<uInt>(out.size());
    deflate(&z, Z_FINISH);
    out.resize(z.total_out);
    deflateEnd(&z);
    return out;
}

const std::string kNrrd = "NRRD0004\n# a remark\ntype: short\ndimension: 3\nendian: little\n";

TEST(Scans, nrrd_in_any_axis_order_gives_the_same_bone) {
    const ScanFolder f;
    expect_bone(import_bone(hu(of(f.write("a.nrrd", kNrrd +
                                                        "sizes: 6 5 4\nspace: left-posterior-superior\n"
                                                        "space directions: (1,0,0) (0,1,0) (0,0,1)\n"
                                                        "space origin: (1,2,3)\nencoding: raw\n\n" +
                                                        sample::bone_numbers({0, 1, 2})))))
                    .bone);
    // Axes in the order up, right, front, compressed: all axes permuted, two reversed.
    expect_bone(import_bone(hu(of(f.write("b.nrrd", kNrrd +
                                                        "sizes: 4 6 5\nspace: RAS\n"
                                                        "space directions: (0,0,1) (1,0,0) (0,1,0)\n"
                                                        "encoding: gzip\n\n" +
                                                        gzip(sample::bone_numbers({2, 3, 4}))))))
                    .bone);
    f.write("c.raw", "skip" + sample::bone_numbers({0, 4, 5}));
    expect_bone(
        import_bone(hu(of(f.write("c.nhdr", kNrrd + "sizes: 6 5 4\nspace: lps\n"
                                                    "space directions: (1,0,0) (0,-1,0) (0,0,-1)\n"
                                                    "encoding: raw\nbyte skip: 4\ndata file: c.raw\n\n"))))
            .bone);
    expect_bone(
        import_bone(hu(of(f.write("d.nhdr", kNrrd + "sizes: 6 5 4\nspace: lps\n"
                                                    "space directions: (1,0,0) (0,-1,0) (0,0,-1)\n"
                                                    "encoding: raw\nbyte skip: 4\ndata file: ./c.raw\n\n"))))
            .bone);
}

TEST(Scans, meta_image_plain_compressed_and_big_endian) {
    const ScanFolder f;
    const std::string head =
        "ObjectType = Image\nNDims = 3\nBinaryData = True\nDimSize = 6 5 4\n"
        "ElementSpacing = 1 1 1\nElementType = MET_SHORT\n";
    expect_bone(import_bone(hu(of(f.write("a.mha", head + "ElementDataFile = LOCAL\n" +
                                                       sample::bone_numbers({0, 1, 2})))))
                    .bone);
    expect_bone(import_bone(hu(of(f.write("b.mha",
                                          head +
                                              "CompressedData = True\nTransformMatrix = -1 0 0 0 1 0 0 0 -1\n"
                                              "Offset = 5 0 3\nElementDataFile = LOCAL\n" +
                                              gzip(sample::bone_numbers({3, 1, 5}))))))
                    .bone);
    f.write("c.raw", sample::bone_numbers({0, 1, 2}, true));
    expect_bone(import_bone(hu(of(f.write(
                                "c.mhd", head + "BinaryDataByteOrderMSB = True\nElementDataFile = c.raw\n"))))
                    .bone);
}

std::string nifti(bool big, bool sform, const std::string& numbers) {
    std::string h(352, '\0');
    const auto at = [&](std::size_t offset, auto value) {
        std::string raw;
        sample::put(raw, value, big);
        std::memcpy(h.data() + offset, raw.data(), raw.size());
    };
    at(0, std::int32_t{348});
    const std::int16_t dim[] = {3, 6, 5, 4, 1, 1, 1, 1};
    for (std::size_t i = 0; i < 8; ++i) at(40 + 2 * i, dim[i]);
    at(70, std::int16_t{4});
    at(72, std::int16_t{16});
    for (std::size_t i = 0; i < 4; ++i) at(76 + 4 * i, 1.0F);
    at(108, 352.0F);
    h[123] = 2;
    if (sform) {  // columns to the right, rows to the front, slices up
        at(254, std::int16_t{1});
        for (std::size_t i = 0; i < 3; ++i) at(280 + 20 * i, 1.0F);
    } else {  // rotated by 180 degrees about the up axis: left, back, up
        at(252, std::int16_t{1});
        at(264, 1.0F);
    }
    std::memcpy(h.data() + 344, "n+1", 4);
    return h + numbers;
}

TEST(Scans, nifti_by_matrix_and_by_quaternion) {
    const ScanFolder f;
    expect_bone(
        import_bone(hu(of(f.write("a.nii", nifti(false, true, sample::bone_numbers({3, 4, 2})))))).bone);
    expect_bone(import_bone(hu(of(f.write("b.nii.gz",
                                          gzip(nifti(true, false, sample::bone_numbers({0, 1, 2}, true)))))))
                    .bone);
}

// By the definition of NIfTI-1: with no rotation and qfac -1 the third axis runs down. Read as if it ran up, an ear would be mirrored.
TEST(Scans, nifti_with_a_negative_qfac_is_not_mirrored) {
    const ScanFolder f;
    std::string bytes = nifti(false, false, sample::bone_numbers({3, 4, 5}));
    const float qfac = -1.0F, none = 0.0F;
    std::memcpy(bytes.data() + 76, &qfac, 4);
    std::memcpy(bytes.data() + 264, &none, 4);  // columns to the right, rows to the front
    expect_bone(import_bone(hu(of(f.write("a.nii", bytes)))).bone);
}

TEST(Scans, declared_sizes_are_compared_with_the_file) {
    const ScanFolder f;
    const auto nrrd = [&](const std::string& fields) {
        return refusal(hu(of(f.write("x.nrrd", kNrrd + fields + "\n\nabc"))));
    };
    const std::string unit = "\nspacings: 1 1 1\nencoding: raw";
    EXPECT_TRUE(says(nrrd("sizes: 6 5 4" + unit), {"declares 240 bytes", "the file has 3", "fix:"}));
    EXPECT_TRUE(says(nrrd("sizes: 8000 8000 60" + unit), {"bytes", "fix: crop"}));
    EXPECT_TRUE(says(nrrd("sizes: 99999 5 4" + unit), {"99999 x 5 x 4", "8192"}));
    EXPECT_TRUE(says(nrrd("sizes: 1000 1000 1000\nspacings: 1 1 1\nencoding: gzip"),
                     {"than 3 compressed bytes can hold"}));
    EXPECT_TRUE(says(nrrd("sizes: 18446744073709551616 5 4" + unit), {"not a whole number"}));
    EXPECT_TRUE(says(nrrd("sizes: 6 5" + unit), {"axes"}));
    EXPECT_TRUE(says(nrrd("sizes: 6 5 4\nencoding: raw"), {"the header has no voxel spacing"}));
    EXPECT_TRUE(says(nrrd("sizes: 6 5 4\nspacings: 1 nan 1\nencoding: raw"), {"not a number"}));
    EXPECT_TRUE(says(nrrd("sizes: 6 5 4\nspacings: 1 0 1\nencoding: raw"), {"axis 1", "--unit"}));
    EXPECT_TRUE(
        says(nrrd("sizes: 6 5 4\nencoding: raw\nspace: lps\nspace directions: (1,0,0) (1,1,0) (0,0,1)"),
             {"right angles"}));
    EXPECT_TRUE(says(nrrd("sizes: 6 5 4\nspacings: 1 1 1\nencoding: bzip2"), {"bzip2"}));
    EXPECT_TRUE(says(nrrd("sizes: 6 5 4\nspacings: 1 1 1\nencoding: raw\ndata file: ../../etc/passwd"),
                     {"one file"}));
    EXPECT_TRUE(says(refusal(of(f.write("y.mha", "NDims = 3\nDimSize = 6 5 4\nElementDataFile = LOCAL\n"))),
                     {"ElementSpacing"}));
    EXPECT_TRUE(says(refusal(of(f.write("z.nii", std::string(400, 'x')))), {"NIfTI-1"}));
    EXPECT_TRUE(says(refusal(of(f.write("z.txt", "hello"))), {"the format is unknown", ".nrrd"}));
    EXPECT_TRUE(says(refusal(of(f.path / "absent.nrrd")), {"does not exist"}));
}

TEST(Scans, an_unknown_unit_is_not_guessed) {
    const ScanFolder f;
    const fs::path file = f.write("a.nrrd", kNrrd + "sizes: 6 5 4\nspacings: 1 1 1\nencoding: raw\n\n" +
                                                sample::bone_numbers({0, 1, 2}));
    EXPECT_TRUE(says(refusal(of(file)), {"unit of the values is unknown", "--threshold-hu"}));
    BoneImport o = hu(of(file));
    EXPECT_TRUE(std::isnan(import_bone(o).bone.hu_at_0));
    o.solid = 200.0;
    EXPECT_TRUE(says(refusal(o), {"threshold 300"}));
}

TEST(Scans, crop_voxel_size_and_memory_limits_are_applied) {
    const ScanFolder f;
    BoneImport o = hu(of(f.write("a.nrrd", kNrrd + "sizes: 6 5 4\nspacings: 1 1 1\nencoding: raw\n\n" +
                                               sample::bone_numbers({0, 1, 2}))));
    double voxels = 0.0, bytes = 0.0;
    o.announce = [&](double v, double b) {
        voxels = v;
        bytes = b;
    };
    o.crop = ScanCrop{{1, 2, 1}, {4, 5, 3}};
    const BoneData cropped = import_bone(o).bone;
    ASSERT_EQ(cropped.bricks.size, (std::array<std::uint32_t, 3>{3, 2, 3}));
    EXPECT_EQ(cropped.density[cropped.bricks.voxel(0, 0, 2)], sample::bone_density(1, 2, 1));
    EXPECT_EQ(voxels, 512.0);
    EXPECT_GE(bytes, 1024.0);
    o.crop = ScanCrop{{1, 2, 1}, {4, 6, 3}};
    EXPECT_TRUE(says(refusal(o), {"rows 2:6", "0:5"}));
    o.crop.reset();
    o.voxel_mm = 0.5;
    const BoneData fine =
        import_bone(o).bone;  // densities are linear along each axis, so interpolation is exact
    ASSERT_EQ(fine.bricks.size, (std::array<std::uint32_t, 3>{11, 7, 9}));
    EXPECT_NEAR(fine.density[fine.bricks.voxel(3, 5, 8 - 3)], 1 + 1.5 + 6 * 1.5 + 30 * 2.5, 1.0);
    o.voxel_mm = 2.0;
    const BoneData coarse = import_bone(o).bone;
    ASSERT_EQ(coarse.bricks.size, (std::array<std::uint32_t, 3>{3, 2, 3}));
    EXPECT_NEAR(coarse.density[coarse.bricks.voxel(1, 1, 2 - 1)], sample::bone_density(2, 2, 2), 9.0);
    o.voxel_mm = 0.001;
    EXPECT_TRUE(says(refusal(o), {"voxels long", "--voxel-mm", "--crop"}));
    o.voxel_mm = 0.0;
    EXPECT_THROW((void)import_bone(o, [](double, const char*) { return false; }), Cancelled);
}

TEST(Labels, names_are_from_the_file_or_a_list_and_critical_labels_are_made_dense) {
    const ScanFolder f;
    std::string numbers;
    for (int i = 0; i < 120; ++i) numbers += static_cast<char>(i < 6 ? 7 : i < 12 ? 3 : 0);
    BoneImport o = hu(of(f.write("a.nrrd", kNrrd + "sizes: 6 5 4\nspacings: 1 1 1\nencoding: raw\n\n" +
                                               sample::bone_numbers({0, 1, 2}))));
    const std::string head =
        "NRRD0004\ntype: uchar\ndimension: 3\nsizes: 6 5 4\nspacings: 1 1 1\nencoding: raw\n";
    o.labels = f.write("l.seg.nrrd", head +
                                         "Segment0_Name:=Facial nerve\nSegment0_LabelValue:=7\n"
                                         "Segment0_Color:=1 0.5 0\n\n" +
                                         numbers);
    BoneData bone = import_bone(o).bone;
    ASSERT_EQ(bone.structure.size(), 2U);
    EXPECT_EQ(bone.structure[0].name, "label 3");
    EXPECT_EQ(bone.structure[1].name, "Facial nerve");
    EXPECT_EQ(bone.structure[1].rgba[1], 127);
    EXPECT_TRUE(bone.structure[1].critical && !bone.structure[0].critical);
    const std::size_t nerve = bone.bricks.voxel(2, 0, 4), other = bone.bricks.voxel(2, 0, 3);
    EXPECT_EQ(bone.label[nerve], 2);
    EXPECT_EQ(bone.label[other], 1);
    EXPECT_EQ(bone.density[nerve], kLabelDensity);
    EXPECT_EQ(bone.density[other], sample::bone_density(2, 1, 0));
    o.label_names =
        f.write("names.txt", "# remark\n0 0 0 0 0 0 0 \"Clear Label\"\n3 255 0 9 1 1 1 \"my bone\"\n");
    o.critical = {"BONE"};
    bone = import_bone(o).bone;
    EXPECT_EQ(bone.structure[0].name, "my bone");
    EXPECT_TRUE(bone.structure[0].critical);
    EXPECT_EQ(bone.structure[1].name, "label 7");
    o.label_names = f.write("names.txt", "3 255 0 \"my bone\"\n");
    EXPECT_TRUE(says(refusal(o), {"ITK-SNAP"}));
    o.label_names.clear();
    o.labels = o.scan;
    EXPECT_TRUE(says(refusal(o), {"not a whole number from 0 to 255"}));
    o.labels = f.write("small.nrrd",
                       "NRRD0004\ntype: uchar\ndimension: 3\nsizes: 6 5 2\nspacings: 1 1 1\n"
                       "encoding: raw\n\n" +
                           numbers);
    EXPECT_TRUE(says(refusal(o), {"6 x 5 x 2", "6 x 5 x 4"}));
    o.labels = f.write("none.nrrd", head + "\n" + std::string(120, '\0'));
    EXPECT_TRUE(says(refusal(o), {"no label lies in the volume"}));
}

void write_rgba(const fs::path& path, std::uint32_t wide,
                const std::vector<std::array<std::uint8_t, 4>>& pixels) {
    write_png(path, wide, static_cast<std::uint32_t>(pixels.size()) / wide,
              std::span(pixels.data()->data(), 4 * pixels.size()), PngFormat::rgba);
}

TEST(Pictures, are_ordered_by_number_without_gaps) {
    EXPECT_EQ(stack_order({"a10.png", "a9.png", "readme.txt", "a008.png"}, "t"),
              (std::vector<std::string>{"a008.png", "a9.png", "a10.png"}));
    EXPECT_EQ(stack_order({"plane000.png", "plane0010.png", "plane001.png", "plane002.png", "plane003.png",
                           "plane004.png", "plane005.png", "plane006.png", "plane007.png", "plane008.png",
                           "plane009.png"},
                          "t")
                  .back(),
              "plane0010.png");
    const auto why = [](std::vector<std::string> names) {
        return told([&] { (void)stack_order(std::move(names), "read"); });
    };
    EXPECT_TRUE(says(why({"a1.png", "a2.png", "a5.png"}), {"number 2 is followed by 5"}));
    EXPECT_TRUE(says(why({"a1.png", "a01.png"}), {"same number"}));
    EXPECT_TRUE(says(why({"a1.png", "b2.png"}), {"two names"}));
    EXPECT_TRUE(says(why({"a.png"}), {"no number"}));
    EXPECT_TRUE(says(why({"a99999999999999999999.png"}), {"more than 9 digits"}));
    EXPECT_TRUE(says(why({}), {"no .png"}));
}

TEST(Pictures, colours_are_structures_and_one_of_them_is_bone) {
    const ScanFolder f;
    const std::array<std::uint8_t, 4> bone{255, 249, 219, 255}, nerve{9, 8, 7, 255}, empty{1, 2, 3, 0};
    for (int k = 0; k < 3; ++k)
        write_rgba(f.path / numbered("p", k, ".png"), 3, {nerve, bone, empty, bone, nerve, empty});
    BoneImport o = of(f.path);
    EXPECT_TRUE(says(refusal(o), {"--spacing-mm"}));
    o.request.spacing_mm = Vec3(0.2, 0.2, 0.2);
    o.label_names = f.write("names.txt", "1 9 8 7 1 1 1 \"nerve\"\n");
    const BoneData b = import_bone(o).bone;
    ASSERT_EQ(b.structure.size(), 1U);
    EXPECT_EQ(b.structure[0].name, "nerve");
    ASSERT_EQ(b.bricks.size, (std::array<std::uint32_t, 3>{3, 3, 2}));
    EXPECT_EQ(b.density[b.bricks.voxel(1, 0, 1)], 255);
    EXPECT_EQ(b.label[b.bricks.voxel(1, 0, 1)], 0);
    EXPECT_EQ(b.label[b.bricks.voxel(0, 2, 1)], 1);
    EXPECT_EQ(b.density[b.bricks.voxel(0, 2, 1)], kLabelDensity);
    EXPECT_EQ(b.density[b.bricks.voxel(2, 2, 1)], 0);
    EXPECT_TRUE(zero_beyond_size(b.bricks, b.density) && zero_beyond_size(b.bricks, b.label));
    o.bone_colour = {1, 1, 1};
    EXPECT_TRUE(says(refusal(o), {"1,1,1", "--bone-colour"}));
    write_rgba(f.path / "p2.png", 2, {bone, bone, bone, bone});
    EXPECT_TRUE(says(refusal(o), {"p2.png is 2 x 2", "3 x 2"}));
    f.write("p2.png", "not an image");
    EXPECT_TRUE(says(refusal(o), {"p2.png"}));
}

TEST(RealScans, all_real_scans_are_read) {
    const char* const shared = std::getenv("TACT_SHARED");
    const fs::path ct = fs::path(shared != nullptr ? shared : "../shared") / "data" / "ct";
    if (!fs::is_directory(ct)) GTEST_SKIP() << "the folder of real data is absent (set TACT_SHARED)";
    const auto share = [&](const char* name, double threshold, double solid, double voxel_mm) {
        BoneImport o = of(ct / name);
        o.voxel_mm = voxel_mm;
        o.request.spacing_mm = Vec3(0.4, 0.4, 0.4);
        if (solid > 0.0) {
            o.threshold = threshold;
            o.solid = solid;
        }
        const BoneInput in = import_bone(o);
        const auto& n = in.bone.bricks.size;
        return static_cast<double>(std::count_if(in.bone.density.begin(), in.bone.density.end(),
                                                 [](std::uint8_t d) { return d > 0; })) /
               (double{1} * n[0] * n[1] * n[2]);
    };
    EXPECT_NEAR(share("head_phantom_bone_crop.nrrd", 0, 0, 0.9), 0.111, 0.01);  // value from its description
    EXPECT_NEAR(share("head_ct_example.nii.gz", 0, 0, 2.5), 0.05, 0.02);
    EXPECT_NEAR(share("headsq_quarter.mhd", 1150, 2600, 3.2), share("headsq_quarter.nhdr", 1150, 2600, 3.2),
                1e-12);
    EXPECT_NEAR(share("engine.nii.gz", 100, 255, 2.0), 0.1, 0.1);
    EXPECT_GT(share("hand_lowres", 80, 255, 1.6), 0.01);
    // All non-empty voxels: 10444030 of 256 x 256 x 253 are empty.
    EXPECT_NEAR(share("temporal_bone_ear3_256", 0, 0, 0.8), 1.0 - 10444030.0 / (256.0 * 256.0 * 253.0), 0.02);
}

}  // namespace
}  // namespace tact::prep_scan_test
