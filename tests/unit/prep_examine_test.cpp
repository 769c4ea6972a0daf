// What tact-prep examine says of scans and maps.
#include <gtest/gtest.h>

#include <algorithm>
#include <nlohmann/json.hpp>

#include "ipc/base/error.hpp"
#include "ipc/image/png.hpp"
#include "prep/drilling/examine_scan.hpp"
#include "tests/unit/prep_scan_samples.hpp"

namespace tact::prep_examine_test {
namespace {

using sample::ScanFolder;

std::string value_of(const ImportReport& report, const std::string& label) {
    for (const auto& line : report.lines)
        if (line.label == label) return line.value;
    return {};
}

void write_slices(const ScanFolder& f, int count, int series, const std::string& name, double from_mm = 0.0) {
    for (int u = 0; u < count; ++u) {
        sample::DicomSample s = sample::bone_slice(u % sample::kUp);
        s.position.z() = from_mm + u;
        s.series = series;
        s.series_uid = "1.2.3." + std::to_string(series);
        f.write(name + std::to_string(u) + ".dcm", sample::dicom_bytes(s));
    }
}

TEST(ExamineScan, of_hounsfield_units_proposes_the_usual_values_and_counts_every_voxel) {
    const ScanFolder f;
    write_slices(f, 4, 1, "s");
    const ImportReport r = examine_scan(f.path, {});
    EXPECT_EQ(value_of(r, "Format"), "DICOM");
    EXPECT_EQ(value_of(r, "Voxels"), "6 x 5 x 4 of 1 x 1 mm, slices 1 mm apart");
    EXPECT_EQ(value_of(r, "Patient"), "columns to L, rows to P, slices to H");
    ASSERT_EQ(r.numbers.size(), 2U);
    EXPECT_EQ(r.numbers[0].option, "--threshold-hu");
    EXPECT_EQ(r.numbers[0].proposed, 300.0);
    EXPECT_EQ(r.numbers[0].unit, "HU");
    EXPECT_EQ(r.numbers[1].proposed, 1800.0);
    ASSERT_TRUE(r.histogram);
    double sum = 0.0;
    for (const double n : r.histogram->count) sum += n;
    EXPECT_EQ(sum, 6.0 * 5.0 * 4.0);
    EXPECT_EQ(r.histogram->low, sample::bone_hu(1));
    EXPECT_TRUE(r.choices.empty());
}

TEST(ExamineScan, of_several_series_examines_the_largest_and_offers_all) {
    const ScanFolder f;
    write_slices(f, 9, 3, "a");
    write_slices(f, 12, 5, "b");
    write_slices(f, 3, 7, "scout", 100.0);
    EXPECT_THROW((void)open_scan(f.path, {}, {}), StartupError) << "the import itself must be told";
    ImportReport r = examine_scan(f.path, {});
    ASSERT_EQ(r.choices.size(), 1U);
    EXPECT_EQ(r.choices[0].option, "--series");
    ASSERT_EQ(r.choices[0].rows.size(), 3U);
    EXPECT_EQ(r.choices[0].rows[1].value, "2");
    EXPECT_NE(r.choices[0].rows[1].text.find("series number 5, 12 slices"), std::string::npos)
        << r.choices[0].rows[1].text;
    EXPECT_EQ(r.choices[0].chosen, 1U);
    EXPECT_EQ(value_of(r, "Voxels").substr(0, 10), "6 x 5 x 12");
    r = examine_scan(f.path, {.series = 1});
    EXPECT_EQ(r.choices[0].chosen, 0U);
    EXPECT_EQ(value_of(r, "Voxels").substr(0, 9), "6 x 5 x 9");
    for (const auto& line : r.lines) EXPECT_EQ(line.value.find("Doe"), std::string::npos);
    // The examined series is the one that is imported.
    EXPECT_EQ(open_scan(f.path, {.series = 2}, {}).scan.slice.size(), 12U);
}

TEST(ExamineScan, of_8_bits_proposes_from_the_histogram_and_warns) {
    const ScanFolder f;
    std::string grey =
        "NRRD0004\ndimension: 3\nsizes: 6 5 40\nspacings: 1 1 1\nencoding: raw\ntype: uint8\n\n";
    for (int i = 0; i < 6 * 5 * 40; ++i)
        grey += static_cast<char>(i % 20 < 9 ? 3 : i % 20 < 19 ? 90 + i % 7 : 200 + i % 5);
    const ImportReport r = examine_scan(f.write("grey.nrrd", grey), {});
    ASSERT_EQ(r.numbers.size(), 2U);
    EXPECT_EQ(r.numbers[0].unit, "");
    EXPECT_GT(r.numbers[0].proposed.value_or(0.0), 96.0);
    EXPECT_LT(r.numbers[0].proposed.value_or(0.0), 200.0);
    EXPECT_TRUE(std::any_of(r.warnings.begin(), r.warnings.end(), [](const std::string& w) {
        return w.find("no known unit") != std::string::npos;
    }));
    EXPECT_NE(value_of(r, "Patient").find("mirrored"), std::string::npos);
}

TEST(ExamineScan, of_coloured_images_lists_the_structures_with_the_names_of_the_table) {
    const ScanFolder f;
    // Bone, and two structures: of 4 and of 2 pixels in each of two slices.
    for (int k = 0; k < 2; ++k) {
        std::vector<std::uint8_t> rgb;
        for (int i = 0; i < 12; ++i) {
            const std::array<std::uint8_t, 3> c = i < 6    ? std::array<std::uint8_t, 3>{255, 249, 219}
                                                  : i < 10 ? std::array<std::uint8_t, 3>{10, 20, 30}
                                                           : std::array<std::uint8_t, 3>{244, 214, 49};
            rgb.insert(rgb.end(), c.begin(), c.end());
        }
        write_png(f.path / ("plane" + std::to_string(k) + ".png"), 4, 3, rgb);
    }
    f.write("structures.toml",
            "[[structure]]\ncolour = \"#0A141E\"\nname = \"round window\"\ncritical = true\n");
    ImportReport r = examine_scan(f.path, {});
    ASSERT_EQ(r.numbers.size(), 1U);
    EXPECT_EQ(r.numbers[0].option, "--spacing-mm");
    EXPECT_FALSE(r.numbers[0].proposed);
    ASSERT_EQ(r.structures.size(), 2U);
    EXPECT_EQ(r.structures[0].name, "round window");
    EXPECT_EQ(r.structures[0].colour, "#0A141E");
    EXPECT_TRUE(r.structures[0].critical);
    EXPECT_EQ(r.structures[0].voxels, 8U);
    EXPECT_EQ(r.structures[1].name, "#F4D631") << "no name in the table";
    EXPECT_EQ(r.structures[1].voxels, 4U);
    EXPECT_EQ(r.structure_table, (f.path / "structures.toml").string());
    r = examine_scan(f.path, {.spacing_mm = Vec3::Constant(0.2)});
    EXPECT_TRUE(r.numbers.empty());
    EXPECT_EQ(value_of(r, "Voxels").substr(0, 9), "4 x 3 x 2");
}

TEST(ExamineScan, what_the_import_refuses_is_refused_here) {
    const ScanFolder f;
    EXPECT_THROW((void)examine_scan(f.path / "none.nrrd", {}), StartupError);
    EXPECT_THROW((void)examine_scan(f.write("x.nrrd", "NRRD0004\n"), {}), StartupError);
    EXPECT_THROW((void)examine_scan(f.path, {}), StartupError) << "a folder without a scan";
}

TEST(ImportReport, is_one_line_of_json) {
    ImportReport r;
    r.lines.push_back({"File", "a\"b\nc"});
    r.numbers.push_back({"--n", "N", "Å", "help", 0.5, 200.0, std::nullopt, false});
    const std::string text = import_report_json(r).dump();
    EXPECT_EQ(text.find('\n'), std::string::npos);
    const auto j = nlohmann::json::parse(text);
    EXPECT_TRUE(j["numbers"][0]["proposed"].is_null());
    EXPECT_EQ(j["numbers"][0]["high"], 200.0);
}

}  // namespace
}  // namespace tact::prep_examine_test
