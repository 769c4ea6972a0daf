// Readers of DICOM slices: order, units, series, gaps, and what is refused.
#include <gtest/gtest.h>

#include <algorithm>
#include <numeric>

#include "ipc/base/error.hpp"
#include "prep/drilling/import_bone.hpp"
#include "prep/volume/slice_gaps.hpp"
#include "tests/support/says.hpp"
#include "tests/unit/prep_scan_imports.hpp"

namespace tact::prep_dicom_test {
namespace {

using sample::expect_bone;
using sample::numbered;
using sample::of;
using sample::refusal;
using sample::ScanFolder;
using sample::told;

void write_series(const ScanFolder& f, std::initializer_list<int> slices, const std::string& name = "s") {
    for (const int u : slices)  // the order of names differs from that of positions
        f.write(numbered(name, 9 - u, ".dcm"), sample::dicom_bytes(sample::bone_slice(u)));
}

TEST(Dicom, slices_are_sorted_by_position_and_scaled_to_hounsfield_units) {
    const ScanFolder f;
    write_series(f, {0, 1, 2, 3});
    f.write("notes.txt", "not an image");
    std::string broken(200, '\0');
    std::memcpy(broken.data() + 128, "DICM", 4);
    f.write("broken.dcm", broken);
    const BoneInput input = import_bone(of(f.path));
    expect_bone(input.bone);
    EXPECT_EQ(input.bone.hu_at_0, 300.0F);
    expect_bone(import_bone(of(f.path / "s9.dcm")).bone);  // one file of the series selects the series
}

TEST(Dicom, personal_data_is_not_kept) {
    const ScanFolder f;
    write_series(f, {0, 1, 2, 3}, "Doe^Jane-");
    std::vector<std::string> warned;
    BoneImport o = of(f.path);
    o.warn = [&](const std::string& line) { warned.push_back(line); };
    BoneInput input = import_bone(o);
    SceneWriter out;
    (void)bake_bone(std::move(input), out);
    const std::vector<std::byte> bytes = out.to_bytes();
    const std::string all(reinterpret_cast<const char*>(bytes.data()), bytes.size());
    for (const char* secret : {"Doe", "Jane", "4711", "Secrets", "1971", "1950", "tact-scan"})
        EXPECT_EQ(all.find(secret), std::string::npos) << secret;
    EXPECT_TRUE(warned.empty());
}

TEST(Dicom, missing_duplicate_and_broken_slices_are_reported) {
    {
        const ScanFolder f;
        for (int u = 0; u < 8; ++u)
            if (u != 3 && u != 4) f.write(numbered("s", u), sample::dicom_bytes(sample::bone_slice(u)));
        EXPECT_TRUE(says(refusal(of(f.path)), {"2 slices are missing", "2.00 and 5.00 mm", "fix:"}));
    }
    {
        const ScanFolder f;
        write_series(f, {0, 1, 2});
        write_series(f, {1}, "again");
        EXPECT_TRUE(says(refusal(of(f.path)), {"s8.dcm", "again8.dcm", "same position"}));
    }
    {
        const ScanFolder f;
        write_series(f, {0, 1, 2, 3});
        const std::string whole = sample::dicom_bytes(sample::bone_slice(2));
        f.write("s7.dcm", whole.substr(0, whole.size() - 30));
        EXPECT_TRUE(says(refusal(of(f.path)), {"s7.dcm", "truncated"}));
    }
    const ScanFolder f;
    EXPECT_TRUE(says(refusal(of(f.path)), {"no DICOM image"}));
    write_series(f, {0});
    EXPECT_TRUE(says(refusal(of(f.path)), {"only one slice"}));
}

// A bone with density 20 + 2 z on slices of two spacings: all slices are there, and each is at its place.
TEST(Dicom, slices_of_two_spacings_are_resampled_by_their_positions) {
    const ScanFolder f;
    std::vector<double> at_mm;
    for (int i = 0; i < 8; ++i) at_mm.push_back(4.0 * i);
    for (int i = 0; i < 7; ++i) at_mm.push_back(35.0 + 7.0 * i);
    int number = 0;
    for (const double z : at_mm)
        f.write(numbered("s", number++),
                sample::dicom_bytes(sample::dicom_slice(z, [&](int, int) { return 20.0 + 2.0 * z; })));
    BoneImport o = of(f.path);
    o.voxel_mm = 1.0;
    std::string warned;
    o.warn = [&](const std::string& line) { warned += line; };
    const BoneData bone = import_bone(o).bone;
    EXPECT_TRUE(says(warned, {"several spacings", "4 mm from 0.0 to 28.0 mm", "7 mm from 28.0 to 77.0 mm"}))
        << warned;
    ASSERT_EQ(bone.bricks.size[1], 78U);
    for (std::uint32_t z = 0; z < 78; ++z)
        EXPECT_NEAR(bone.density[bone.bricks.voxel(2, z, 2)], 20.0 + 2.0 * z, 1.1) << z;
}

TEST(Dicom, a_slice_of_another_size_is_named_where_one_is_missing) {
    const ScanFolder f;
    for (int u = 0; u < 12; ++u) {
        sample::DicomSample s = sample::bone_slice(u);
        if (u == 5) s.columns = 5, s.rows = 6;
        f.write(numbered("s", u), sample::dicom_bytes(s));
    }
    EXPECT_TRUE(says(refusal(of(f.path)),
                     {"1 slice is missing", "4.00 and 6.00 mm", "s5 is there, but has 5 x 6 pixels"}));
}

TEST(SliceGaps, tells_missing_slices_from_another_spacing) {
    const auto of_gaps = [](const std::vector<double>& gaps) {
        std::vector<double> at{0.0};
        for (const double g : gaps) at.push_back(at.back() + g);
        return slice_gaps(at);
    };
    EXPECT_TRUE(of_gaps({1, 1, 1, 1, 1}).missing.empty());
    EXPECT_EQ(of_gaps({1, 1, 1, 1, 1}).parts.size(), 1U);
    const SliceGaps two = of_gaps({4, 4, 4, 4, 7, 7, 7, 7});
    EXPECT_TRUE(two.missing.empty());
    ASSERT_EQ(two.parts.size(), 2U);
    EXPECT_EQ(two.parts[1].first, 4U);
    EXPECT_DOUBLE_EQ(two.parts[1].spacing_mm, 7.0);
    // Both spacings, and a slice lost in each part.
    const SliceGaps lost = of_gaps({4, 4, 4, 4, 8, 4, 4, 4, 4, 7, 7, 7, 7, 21, 7, 7, 7, 7});
    ASSERT_EQ(lost.missing.size(), 2U);
    EXPECT_EQ(lost.missing[0].after, 4U);
    EXPECT_EQ(lost.missing[0].count, 1U);
    EXPECT_EQ(lost.missing[1].after, 13U);
    EXPECT_EQ(lost.missing[1].count, 2U);
    EXPECT_EQ(lost.parts.size(), 2U);
    // Three double distances are no spacing of their own.
    EXPECT_EQ(of_gaps({1, 1, 1, 1, 2, 2, 2, 1, 1, 1, 1}).missing.size(), 3U);
    EXPECT_TRUE(of_gaps({1, 1.2, 1, 0.8, 1}).missing.empty());
}

TEST(Dicom, one_of_several_series_is_chosen_or_all_are_listed) {
    const ScanFolder f;
    write_series(f, {0, 1, 2, 3});
    for (int u = 0; u < 3; ++u) {
        sample::DicomSample other = sample::bone_slice(u);
        other.series = 2;
        other.series_uid = "1.2.3.2";
        f.write(numbered("other", u), sample::dicom_bytes(other));
    }
    EXPECT_TRUE(
        says(refusal(of(f.path)), {"2 series", "1: CT, series number 1, 4 slices", "2: CT", "--series"}));
    BoneImport o = of(f.path);
    o.request.series = 1;
    expect_bone(import_bone(o).bone);
    o.request.series = 3;
    EXPECT_TRUE(says(refusal(o), {"series 3 is not in this list"}));
    // A planning view next to a volume requires no choice.
    const ScanFolder g;
    for (int u = 0; u < 9; ++u) g.write(numbered("v", u), sample::dicom_bytes(sample::bone_slice(u)));
    sample::DicomSample wide = sample::bone_slice(0);
    wide.columns = 5;
    wide.rows = 6;
    g.write("scout", sample::dicom_bytes(wide));
    const BoneInput chosen = import_bone(of(g.path));
    EXPECT_NE(
        std::find_if(chosen.note.begin(), chosen.note.end(),
                     [](const std::string& l) { return l.find("of 2, the only one") != std::string::npos; }),
        chosen.note.end());
}

TEST(Dicom, uneven_slices_and_a_tilted_gantry_are_reported_and_positioned_correctly) {
    // A bone with density 20 + 4 z + 6 y, independent of the slice positions.
    const auto at = [](double y, double z) { return 20.0 + 4.0 * z + 6.0 * y; };
    for (const bool tilted : {false, true}) {
        const ScanFolder f;
        int i = 0;
        for (const double z : {0.0, 1.0, 2.2, 3.2, 4.0, 5.0}) {
            const double place = tilted ? i : z, shift = tilted ? 0.2 * place : 0.0;
            sample::DicomSample s =
                sample::dicom_slice(place, [&](int, int b) { return at(b + shift, place); });
            s.position.y() += shift;
            f.write(numbered("s", i++), sample::dicom_bytes(s));
        }
        BoneImport o = of(f.path);
        o.voxel_mm = 1.0;
        std::string warned;
        o.warn = [&](const std::string& line) { warned += line; };
        const BoneData bone = import_bone(o).bone;
        EXPECT_TRUE(says(warned, {tilted ? "tilted by 11.3 degrees" : "0.8 to 1.2 mm apart"})) << warned;
        ASSERT_EQ(bone.bricks.size, (std::array<std::uint32_t, 3>{6, 6, tilted ? 6U : 5U}));
        const std::uint32_t front = bone.bricks.size[2] - 1;
        for (std::uint32_t z = 1; z < 5; ++z)
            for (std::uint32_t y = 1; y < 4; ++y)
                EXPECT_NEAR(bone.density[bone.bricks.voxel(2, z, front - y)], at(y, z), 1.1) << y << ' ' << z;
    }
}

TEST(Dicom, other_images_than_grey_scans_are_refused) {
    const auto with = [](const std::function<void(sample::DicomSample&)>& change) {
        const ScanFolder f;
        for (int u = 0; u < 4; ++u) {
            sample::DicomSample s = sample::bone_slice(u);
            change(s);
            f.write(numbered("s", u), sample::dicom_bytes(s));
        }
        std::string warned;
        BoneImport o = of(f.path);
        o.warn = [&](const std::string& line) { warned += line; };
        const std::string why = told([&] { (void)import_bone(o); });
        return why + warned;
    };
    EXPECT_TRUE(says(with([](sample::DicomSample& s) { s.photometric = "RGB"; }), {"RGB"}));
    EXPECT_TRUE(says(with([](sample::DicomSample& s) { s.photometric = "MONOCHROME1"; }), {"MONOCHROME1"}));
    EXPECT_TRUE(says(with([](sample::DicomSample& s) { s.slope = 0.0; }), {"slope"}));
    EXPECT_TRUE(says(with([](sample::DicomSample& s) {
                         s.rows = 65535;
                         s.columns = 65535;
                     }),
                     {"65535 x 65535"}));
    EXPECT_TRUE(says(with([](sample::DicomSample& s) {
                         s.rows = 4096;
                         s.columns = 4096;
                     }),
                     {"fix:"}));
    EXPECT_TRUE(says(with([](sample::DicomSample& s) { s.spacing = 0.0; }), {"mm"}));
    EXPECT_TRUE(
        says(with([](sample::DicomSample& s) { s.modality = "MR"; }), {"unit of the values is unknown"}));
    EXPECT_TRUE(
        says(with([](sample::DicomSample& s) { s.maker = "NewTom VGi"; }), {"no error", "cone-beam"}));
}

}  // namespace
}  // namespace tact::prep_dicom_test
