// Maps: every mode, axis order and byte order against a file with known voxels; errors for invalid files.
#include <gtest/gtest.h>
#include <zlib.h>

#include <cmath>
#include <fstream>
#include <limits>

#include "prep/map/import_map.hpp"
#include "tests/unit/prep_samples.hpp"

namespace tact::prep_map_test {
namespace {

namespace fs = std::filesystem;
using sample::Mrc;

ImportedMap read(const Mrc& mrc) { return import_map_bytes(mrc.bytes(), "test.mrc", ".mrc"); }

void expect_values(const ImportedMap& map, const Mrc& mrc) {
    ASSERT_EQ(map.grid.values.size(), static_cast<std::size_t>(mrc.size[0] * mrc.size[1] * mrc.size[2]));
    for (int z = 0; z < mrc.size[2]; ++z) {
        for (int y = 0; y < mrc.size[1]; ++y) {
            for (int x = 0; x < mrc.size[0]; ++x) {
                ASSERT_EQ(map.grid.at(static_cast<std::uint32_t>(x), static_cast<std::uint32_t>(y),
                                      static_cast<std::uint32_t>(z)),
                          mrc.stored(x, y, z))
                    << x << " " << y << " " << z;
            }
        }
    }
}

TEST(MrcMap, every_mode_axis_order_and_byte_order_gives_the_same_voxels) {
    const std::array<int, 3> orders[] = {{1, 2, 3}, {1, 3, 2}, {2, 1, 3}, {2, 3, 1}, {3, 1, 2}, {3, 2, 1}};
    for (const int mode : {0, 1, 2, 6, 12}) {
        for (const auto& axes : orders) {
            for (const bool big : {false, true}) {
                SCOPED_TRACE(testing::Message() << "mode " << mode << " axes " << axes[0] << axes[1]
                                                << axes[2] << " big endian " << big);
                Mrc mrc;
                mrc.mode = mode;
                mrc.axes = axes;
                mrc.big_endian = big;
                mrc.start = {-2, 3, 5};
                const ImportedMap map = read(mrc);
                EXPECT_EQ(map.grid.size, (std::array<std::uint32_t, 3>{6, 5, 4}));
                EXPECT_NEAR((map.grid.spacing_m - Vec3(2e-10, 3e-10, 4e-10)).norm(), 0.0, 1e-17);
                EXPECT_NEAR((map.grid.origin_m - Vec3(-4e-10, 9e-10, 20e-10)).norm(), 0.0, 1e-16);
                EXPECT_NE(map.format.find("mode " + std::to_string(mode)), std::string::npos);
                EXPECT_NE(map.format.find(big ? "big" : "little"), std::string::npos);
                expect_values(map, mrc);
            }
        }
    }
}

TEST(MrcMap, machine_stamp_magic_and_extended_header_do_not_matter) {
    for (const std::uint32_t stamp : {0U, 0x00004144U, 0x00001111U, 0x11110000U, 0xffffffffU}) {
        for (const bool big : {false, true}) {
            for (const int extended : {0, 160, 7}) {
                Mrc mrc;
                mrc.stamp = stamp;
                mrc.big_endian = big;
                mrc.extended = extended;
                mrc.magic = "junk";
                expect_values(read(mrc), mrc);
            }
        }
    }
}

TEST(MrcMap, origin_words_override_start_and_the_rule_is_reported) {
    Mrc mrc;
    mrc.start = {1, 1, 1};
    mrc.origin = {-17.5F, 0.0F, 40.25F};
    const ImportedMap map = read(mrc);
    EXPECT_NEAR((map.grid.origin_m - Vec3(-17.5e-10, 0.0, 40.25e-10)).norm(), 0.0, 1e-16);
    EXPECT_NE(map.origin_rule.find("ORIGIN words 50-52 (-17.5, 0, 40.25) A"), std::string::npos)
        << map.origin_rule;
    EXPECT_NE(map.origin_rule.find("NSTART (1, 1, 1) x voxel differs and is ignored"), std::string::npos)
        << map.origin_rule;
    mrc.origin = {0.0F, 0.0F, 0.0F};
    EXPECT_NE(read(mrc).origin_rule.find("NSTART words 5-7 (1, 1, 1) x voxel"), std::string::npos);
}

TEST(MrcMap, voxel_is_cell_over_intervals_not_over_size) {
    Mrc mrc;
    mrc.intervals = {5, 10, 16};
    const ImportedMap map = read(mrc);
    EXPECT_NEAR((map.grid.spacing_m - Vec3(2.4e-10, 1.5e-10, 1e-10)).norm(), 0.0, 1e-17);
}

TEST(MrcMap, zero_intervals_and_zero_axes_are_fixed_and_reported) {
    Mrc mrc;
    mrc.intervals = {0, 5, 4};
    ImportedMap map = read(mrc);
    EXPECT_NEAR(map.grid.spacing_m.x(), 2e-10, 1e-18);
    ASSERT_EQ(map.notes.size(), 1U);
    EXPECT_NE(map.notes[0].find("word 8"), std::string::npos);
    std::vector<char> bytes = Mrc().bytes();
    std::memset(bytes.data() + 64, 0, 12);
    map = import_map_bytes(bytes, "test.mrc", ".mrc");
    expect_values(map, Mrc());
    EXPECT_NE(map.notes.at(0).find("axis words"), std::string::npos);
}

// Trilinear resampling keeps a linear field exactly, so each voxel inside has a known value.
TEST(MrcMap, skew_cells_are_resampled_to_the_right_positions) {
    Mrc mrc;
    mrc.size = mrc.intervals = {12, 10, 8};
    mrc.cell = {24.0F, 30.0F, 32.0F};
    mrc.angles = {90.0F, 70.0F, 90.0F};
    mrc.start = {2, 0, 0};
    const ImportedMap map = read(mrc);
    ASSERT_EQ(map.notes.size(), 1U);
    EXPECT_NE(map.notes[0].find("resampled"), std::string::npos);
    const DensityGrid& g = map.grid;
    EXPECT_NEAR((g.spacing_m - Vec3::Constant(2e-10)).norm(), 0.0, 1e-16);
    // Crystal axes: a along x; c at 70 degrees to a; b perpendicular to both.
    const double beta = 70.0 * M_PI / 180.0;
    int inside = 0;
    for (std::uint32_t z = 0; z < g.size[2]; ++z) {
        for (std::uint32_t y = 0; y < g.size[1]; ++y) {
            for (std::uint32_t x = 0; x < g.size[0]; ++x) {
                const Vec3 p_a = (g.origin_m + g.spacing_m.cwiseProduct(Vec3(x, y, z))) * 1e10;
                const double k = p_a.z() / (4.0 * std::sin(beta)), j = p_a.y() / 3.0,
                             i = (p_a.x() - 4.0 * k * std::cos(beta)) / 2.0 - 2.0;
                if (i < 0.0 || i > 11.0 || j > 9.0 || k > 7.0) continue;
                ++inside;
                ASSERT_NEAR(g.at(x, y, z), 0.25 * (i + 10.0 * j + 30.0 * k - 40.0), 1e-3);
            }
        }
    }
    EXPECT_GT(inside, 500);
}

TEST(SitusMap, round_trips_through_text) {
    const std::string text = "  2.500000 -49.5 0.25 3e1 4 5 4\n\n" + [] {
        std::string v;
        for (int i = 0; i < 80; ++i) v += std::to_string(i * 0.5) + (i % 10 == 9 ? "\n" : " ");
        return v;
    }();
    const ImportedMap map = import_map_bytes({text.begin(), text.end()}, "a.sit", ".sit");
    EXPECT_EQ(map.grid.size, (std::array<std::uint32_t, 3>{4, 5, 4}));
    EXPECT_NEAR((map.grid.origin_m - Vec3(-49.5e-10, 0.25e-10, 30e-10)).norm(), 0.0, 1e-17);
    EXPECT_NEAR(map.grid.spacing_m.z(), 2.5e-10, 1e-18);
    EXPECT_EQ(map.grid.at(1, 2, 3), 0.5F * (1 + 4 * 2 + 20 * 3));
    EXPECT_NE(map.origin_rule.find("Situs header"), std::string::npos);
}

// The error contains file name, place, reason and fix.
void expect_refused(const std::vector<char>& bytes, const char* ending, const char* place,
                    const char* reason) {
    const std::string name = std::string("bad") + ending;
    const std::string error = sample::error_of([&] { (void)import_map_bytes(bytes, name, ending); });
    EXPECT_NE(error.find("read map " + name), std::string::npos) << reason << ": " << error;
    EXPECT_NE(error.find(place), std::string::npos) << place << ": " << error;
    EXPECT_NE(error.find(reason), std::string::npos) << error;
    EXPECT_NE(error.find("\n  fix: "), std::string::npos) << error;
}

std::vector<char> with_word(int word, std::uint32_t value, Mrc mrc = {}) {
    std::vector<char> bytes = mrc.bytes();
    std::memcpy(bytes.data() + 4 * (word - 1), &value, 4);
    return bytes;
}
std::vector<char> with_float(int word, float value) {
    return with_word(word, std::bit_cast<std::uint32_t>(value));
}
constexpr float kNan = std::numeric_limits<float>::quiet_NaN();

TEST(MrcMap, bad_headers_are_refused_with_place_and_reason) {
    expect_refused({}, ".mrc", "0 bytes", "header");
    expect_refused(std::vector<char>(1023, '\0'), ".mrc", "1023 bytes", "header");
    expect_refused(std::vector<char>(5000, '\0'), ".mrc", "invalid in both byte orders", "sizes 0, 0, 0");
    expect_refused(std::vector<char>(5000, 'x'), ".mrc", "invalid in both byte orders", "sizes");
    expect_refused(with_word(4, 12), ".mrc", "mode 12", "(oversized)");
    expect_refused(with_word(4, 3), ".mrc", "word 4", "Fourier transform");
    expect_refused(with_word(4, 4), ".mrc", "word 4", "Fourier transform");
    expect_refused(with_word(4, 5), ".mrc", "word 4", "mode 5");
    expect_refused(with_word(17, 2), ".mrc", "invalid in both byte orders", "axes 2, 2, 3");
    expect_refused(with_word(1, 1), ".mrc", "word 1", "1 voxels along an axis");
    expect_refused(with_word(3, 60000), ".mrc", "word 3", "60000 voxels");
    expect_refused(with_word(11, 0), ".mrc", "word 11", "cell edge");
    expect_refused(with_float(12, kNan), ".mrc", "word 12", "cell edge");
    expect_refused(with_float(13, -5.0F), ".mrc", "word 13", "cell edge");
    expect_refused(with_word(9, 0x80000000U), ".mrc", "word 9", "intervals");
    expect_refused(with_word(6, 0x80000000U), ".mrc", "word 6", "start");
    expect_refused(with_float(14, kNan), ".mrc", "word 14", "angle");
    expect_refused(with_float(15, 179.0F), ".mrc", "word 15", "angle");
    expect_refused(with_float(51, kNan), ".mrc", "word 51", "origin");
    expect_refused(with_float(52, 1e9F), ".mrc", "origin", "million");
    expect_refused(with_word(24, 0xffffff00U), ".mrc", "word 24", "extended header");
    Mrc flat;
    flat.angles = {150.0F, 150.0F, 150.0F};
    expect_refused(flat.bytes(), ".mrc", "words 14-16", "no cell has these angles");
    Mrc thin;
    thin.angles = {90.0F, 70.0F, 90.0F};
    thin.cell = {12.0F, 15.0F, 0.1F};
    expect_refused(thin.bytes(), ".mrc", "skew cell", "voxels on axes at right angles");
}

TEST(MrcMap, declared_sizes_are_refused_before_memory_is_taken) {
    std::vector<char> bytes = Mrc().bytes();
    for (int w = 1; w <= 3; ++w) {
        const std::uint32_t n = 16000;
        std::memcpy(bytes.data() + 4 * (w - 1), &n, 4);
    }
    expect_refused(bytes, ".mrc", "words 1-3", "16000 x 16000 x 16000 voxels");
}

TEST(MrcMap, truncated_and_oversized_files_are_refused) {
    const std::vector<char> whole = Mrc().bytes();
    for (const std::size_t n : {std::size_t{1024}, std::size_t{1500}, whole.size() - 1}) {
        expect_refused({whole.begin(), whole.begin() + static_cast<std::ptrdiff_t>(n)}, ".mrc", "6 x 5 x 4",
                       "(truncated)");
    }
    std::vector<char> longer = whole;
    longer.push_back('x');
    expect_refused(longer, ".mrc", "6 x 5 x 4", "(oversized)");
    // Read as bytes, the file is four times too long.
    expect_refused(with_word(4, 0), ".mrc", "mode 0", "(oversized)");
}

TEST(MrcMap, non_finite_voxels_are_counted) {
    std::vector<char> bytes = Mrc().bytes();
    const float inf = std::numeric_limits<float>::infinity();
    std::memcpy(bytes.data() + 1024 + 4 * (2 + 6 * (1 + 5 * 3)), &kNan, 4);
    std::memcpy(bytes.data() + bytes.size() - 4, &inf, 4);
    expect_refused(bytes, ".mrc", "the first at voxel (2, 1, 3)", "2 of 120 voxels are not finite");
    for (std::size_t i = 1024; i < bytes.size(); i += 4) std::memcpy(bytes.data() + i, &kNan, 4);
    expect_refused(bytes, ".mrc", "voxel (0, 0, 0)", "120 of 120");
    std::fill(bytes.begin() + 1024, bytes.end(), '\0');
    expect_refused(bytes, ".mrc", "all voxels", "same value");
}

TEST(SitusMap, bad_text_is_refused_with_the_line) {
    const auto refused = [](const std::string& text, const char* place, const char* reason) {
        expect_refused({text.begin(), text.end()}, ".situs", place, reason);
    };
    refused("", "line 1", "ends before the voxel size");
    refused("hello world", "line 1", "'hello' is not a number");
    refused("2.0 0 0", "line 1", "ends before the origin");
    refused("0 0 0 0 4 4 4\n", "line 1", "voxel size 0");
    refused("nan 0 0 0 4 4 4\n", "line 1", "voxel size nan");
    refused("1 0 inf 0 4 4 4\n", "line 1", "origin");
    refused("1 0 0 0 4 4 -4\n", "line 1", "-4 voxels");
    refused("1 0 0 0 4 4.5 4\n", "line 1", "'4.5' is not a number");
    refused("1 0 0 0 16000 16000 16000\n", "line 1", "more than");
    refused("1 0 0 0 500 500 500\n1 2 3\n", "line 1", "truncated");
    std::string values;
    for (int i = 0; i < 63; ++i) values += "0.5\n";
    refused("1 0 0 0 4 4 4\n\n" + values, "line 66", "ends before a voxel");
    refused("1 0 0 0 4 4 4\n\n" + values + "1 2", "line 66", "oversized");
    refused("1 0 0 0 4 4 4\n\n" + values + "1e", "line 66", "'1e' is not a number");
    refused("1 0 0 0 4 4 4\n\n" + values + "\x1b[2J", "line 66", "'?[2J' is not a number");
    refused("1 0 0 0 4 4 4\n\n" + values + "nan", "voxel (3, 3, 3)", "1 of 64");
    refused("1 0 0 0 4 4 4\n\n" + values + "0.5", "all voxels", "same value");
}

class MapFiles : public ::testing::Test {
protected:
    MapFiles() {
        std::string name = (fs::temp_directory_path() / "tact-map-XXXXXX").string();
        folder_ = ::mkdtemp(name.data());
    }
    ~MapFiles() override { fs::remove_all(folder_); }
    fs::path write(const char* name, const std::vector<char>& bytes) const {
        std::ofstream(folder_ / name, std::ios::binary)
            .write(bytes.data(), static_cast<std::streamsize>(bytes.size()));
        return folder_ / name;
    }
    fs::path write_gz(const char* name, const std::vector<char>& bytes) const {
        const gzFile file = gzopen((folder_ / name).c_str(), "wb");
        gzwrite(file, bytes.data(), static_cast<unsigned>(bytes.size()));
        gzclose(file);
        return folder_ / name;
    }
    fs::path folder_;
};

TEST_F(MapFiles, packed_and_plain_files_are_the_same) {
    expect_values(import_map(write("a.map", Mrc().bytes())), Mrc());
    expect_values(import_map(write_gz("a.CCP4.gz", Mrc().bytes())), Mrc());
}

TEST_F(MapFiles, bad_files_are_refused_by_name) {
    const auto error = [](const fs::path& path) { return sample::error_of([&] { (void)import_map(path); }); };
    EXPECT_NE(error(folder_ / "absent.mrc").find("absent.mrc: No such file"), std::string::npos);
    EXPECT_NE(error(write("empty.mrc", {})).find("empty.mrc: the file is empty"), std::string::npos);
    EXPECT_NE(error(write("a.txt", {'x'})).find("'.txt' is not that of a map"), std::string::npos);
    fs::create_directory(folder_ / "folder.mrc");
    EXPECT_NE(error(folder_ / "folder.mrc").find("not a regular file"), std::string::npos);
    const fs::path packed = write_gz("cut.mrc.gz", Mrc().bytes());
    fs::resize_file(packed, fs::file_size(packed) / 2);
    EXPECT_NE(error(packed).find("gzip stream is damaged or ends early"), std::string::npos) << error(packed);
}

// Found by tests/fuzz/map_fuzz.cpp: 120 voxels that required 67 million.
TEST(MrcMap, a_small_skew_file_does_not_grow_into_a_huge_grid) {
    Mrc mrc;
    mrc.angles = {90.0F, 90.0F, 120.0F};
    mrc.cell = {12000.0F, 15000.0F, 16.0F};
    expect_refused(mrc.bytes(), ".mrc", "skew cell", "more than 7680");
}

}  // namespace
}  // namespace tact::prep_map_test
