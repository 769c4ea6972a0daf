// Names of structures: a person's table, known palettes, where the table lies; imported scans have them.
#include <gtest/gtest.h>
#include <unistd.h>

#include <algorithm>
#include <filesystem>
#include <fstream>

#include "ipc/base/error.hpp"
#include "ipc/image/png.hpp"
#include "ipc/scene/bone/structure_table.hpp"
#include "prep/drilling/import_bone.hpp"
#include "prep/drilling/structure_names.hpp"

namespace tact::prep_structures_test {
namespace {

namespace fs = std::filesystem;

struct Folder {
    fs::path path = fs::temp_directory_path() / ("tact-structures-" + std::to_string(::getpid()));
    Folder() {
        fs::remove_all(path);
        fs::create_directories(path);
    }
    ~Folder() { fs::remove_all(path); }
    Folder(const Folder&) = delete;
    Folder& operator=(const Folder&) = delete;
};

std::string why(const std::string& text) {
    try {
        static_cast<void>(parse_structure_table(text, "read it"));
    } catch (const StartupError& e) {
        return e.what();
    }
    return "nothing was wrong";
}

TEST(StructureTable, holds_labels_colours_names_and_what_is_critical) {
    const auto rows = parse_structure_table(R"(
[[structure]]
label = 7
name = "Nerf \"VII\" é"
critical = true
[[structure]]
colour = "#0aFf10"
name = "a"
[[structure]]
colour = [1, 2, 3]
label = 9
name = "b"
critical = false
)",
                                            "read");
    ASSERT_EQ(rows.size(), 3U);
    EXPECT_EQ(rows[0].value, 7);
    EXPECT_EQ(rows[0].name, "Nerf \"VII\" é");
    EXPECT_EQ(rows[0].critical, true);
    EXPECT_EQ(rows[0].rgba[3], 0);  // none
    EXPECT_EQ(rows[1].rgba, (std::array<std::uint8_t, 4>{10, 255, 16, 255}));
    EXPECT_EQ(rows[1].value, 0);
    EXPECT_FALSE(rows[1].critical.has_value());
    EXPECT_EQ(rows[2].rgba, (std::array<std::uint8_t, 4>{1, 2, 3, 255}));
    EXPECT_EQ(rows[2].critical, false);
    EXPECT_TRUE(parse_structure_table("", "read").empty());
}

TEST(StructureTable, a_wrong_one_is_refused_with_its_line) {
    const struct {
        const char *text, *says;
    } rows[] = {
        {"[[structure]]\nname = 'a'\n", "needs a label or a colour"},
        {"[[structure]]\nlabel = 1\n", "'name' is missing"},
        {"[[structure]]\nlabel = 1\nname = ''\n", "line 3"},
        {"[[structure]]\nlabel = 0\nname = 'a'\n", "from 1 to 255"},
        {"[[structure]]\nlabel = 256\nname = 'a'\n", "from 1 to 255"},
        {"[[structure]]\nlabel = 1.5\nname = 'a'\n", "whole number"},
        {"[[structure]]\ncolour = '#12345'\nname = 'a'\n", "#RRGGBB"},
        {"[[structure]]\ncolour = '#12345G'\nname = 'a'\n", "#RRGGBB"},
        {"[[structure]]\ncolour = [1,2]\nname = 'a'\n", "#RRGGBB"},
        {"[[structure]]\ncolour = [1,2,-3]\nname = 'a'\n", "from 0 to 255"},
        {"[[structure]]\nlabel = 1\nname = 'a'\ncritical = 'yes'\n", "true or false"},
        {"[[structure]]\nlabel = 1\nname = 'a'\ncolor = '#123456'\n", "unknown key 'color'"},
        {"[structure]\nlabel = 1\n", "[[structure]]"},
        {"x = 1\n", "unknown part 'x'"},
        {"[[structure]\n", "line 1"},
    };
    for (const auto& row : rows)
        EXPECT_NE(why(row.text).find(row.says), std::string::npos) << row.text << why(row.text);
}

TEST(StructureTable, what_is_written_is_read_again) {
    const std::vector<ScanLabel> rows{{3, "a \"quoted\" \\ name\n", {1, 2, 3, 255}, true},
                                      {0, "é", {255, 0, 128, 255}, false}};
    const auto read = parse_structure_table(structure_table_text(rows, {5, 6}), "read");
    ASSERT_EQ(read.size(), 2U);
    EXPECT_EQ(read[0].value, 3);
    EXPECT_EQ(read[0].name, "a \"quoted\" \\ name");  // without the line break
    EXPECT_EQ(read[0].critical, true);
    EXPECT_EQ(read[1].value, 0);
    EXPECT_EQ(read[1].rgba, rows[1].rgba);
    EXPECT_EQ(read[1].critical, false);
}

TEST(StructureTable, lies_beside_its_scan) {
    const Folder f;
    fs::create_directories(f.path / "slices");
    EXPECT_TRUE(structure_table_beside(f.path / "slices").empty());
    for (const char* const name :
         {"slices/structures.toml", "ear.structures.toml", "slices/0.dcm", "ear.nii.gz", "nose.nrrd"})
        std::ofstream(f.path / name) << "";
    EXPECT_EQ(structure_table_beside(f.path / "slices"), f.path / "slices/structures.toml");
    EXPECT_EQ(structure_table_beside(f.path / "ear.nii.gz"), f.path / "ear.structures.toml");
    EXPECT_EQ(structure_table_beside(f.path / "ear.nrrd"), f.path / "ear.structures.toml");
    EXPECT_TRUE(structure_table_beside(f.path / "nose.nrrd").empty());
    EXPECT_TRUE(structure_table_beside("").empty());
}

TEST(CriticalNames, abbreviations_count_as_whole_words) {
    for (const char* const name :
         {"ICA", "left ica", "CN VII", "FN_right", "IAC", "facial nerve", "sigmoid sinus and dura",
          "Carotide (carotid)", "internal auditory canal", "malleus", "Incus", "stapes"})
        EXPECT_TRUE(critical_name(name, {})) << name;
    for (const char* const name : {"topical", "medical record", "fnord", "bone", "tympanic membrane",
                                   "external auditory canal", "viiith"})
        EXPECT_FALSE(critical_name(name, {})) << name;
    EXPECT_TRUE(critical_name("Tympanic membrane", {"TYMP"}));
}

// Slices of 12 x 10 pixels: bone, with a block of each colour.
void write_stack(const fs::path& folder, const std::vector<std::array<std::uint8_t, 3>>& colours) {
    fs::create_directories(folder);
    for (int z = 0; z < 6; ++z) {
        std::vector<std::uint8_t> rgba(std::size_t{12} * 10 * 4, 0);
        for (std::size_t y = 1; y < 9; ++y)
            for (std::size_t x = 1; x < 11; ++x) {
                std::array<std::uint8_t, 3> c{255, 249, 219};
                if (z > 1 && z < 4 && y > 3 && y < 6 && x - 2 < colours.size()) c = colours[x - 2];
                const std::size_t at = 4 * (12 * y + x);
                std::copy(c.begin(), c.end(), rgba.begin() + static_cast<std::ptrdiff_t>(at));
                rgba[at + 3] = 255;
            }
        write_png(folder / ("plane" + std::to_string(z) + ".png"), 12, 10, rgba, PngFormat::rgba);
    }
}
BoneInput imported(const fs::path& folder) {
    BoneImport o;
    o.scan = folder;
    o.request.spacing_mm = Vec3::Constant(0.5);
    return import_bone(o);
}
const BoneStructure& named(const BoneInput& input, const std::string& name) {
    static const BoneStructure kNone;
    for (const BoneStructure& s : input.bone.structure)
        if (s.name == name) return s;
    ADD_FAILURE() << name;
    return kNone;
}

TEST(Palette, the_colours_of_a_known_one_have_names_and_others_keep_theirs) {
    const Folder f;
    write_stack(f.path / "ear", {{244, 214, 49}, {110, 184, 209}, {233, 0, 255}, {216, 100, 79}, {7, 8, 9}});
    const BoneInput ear = imported(f.path / "ear");
    ASSERT_EQ(ear.bone.structure.size(), 5U);
    EXPECT_TRUE(named(ear, "facial nerve").critical);
    EXPECT_TRUE(named(ear, "sigmoid sinus and dura").critical);
    EXPECT_TRUE(named(ear, "internal carotid artery").critical);
    EXPECT_TRUE(named(ear, "malleus").critical);
    EXPECT_FALSE(named(ear, "#070809").critical);
    EXPECT_TRUE(std::any_of(ear.note.begin(), ear.note.end(), [](const std::string& n) {
        return n.find("named by their colours") != std::string::npos;
    }));
    // Three of its colours are chance.
    write_stack(f.path / "other", {{244, 214, 49}, {110, 184, 209}, {233, 0, 255}, {1, 1, 1}});
    const BoneInput other = imported(f.path / "other");
    EXPECT_FALSE(named(other, "#F4D631").critical);
}

TEST(Palette, a_table_beside_the_scan_takes_precedence) {
    const Folder f;
    write_stack(f.path / "ear", {{244, 214, 49}, {110, 184, 209}, {233, 0, 255}, {216, 100, 79}, {7, 8, 9}});
    const BoneInput first = imported(f.path / "ear");
    // As it is written, edited by a person.
    std::string text = structure_table_text(first.table, first.table_voxels);
    const auto edit = [&text](const std::string& from, const std::string& to) {
        const auto at = text.find(from);
        ASSERT_NE(at, std::string::npos) << text;
        text.replace(at, from.size(), to);
    };
    edit("\"#070809\"\nname = \"#070809\"\ncritical = false",
         "\"#070809\"\nname = \"my place\"\ncritical = true");
    edit("name = \"malleus\"\ncritical = true", "name = \"hammer\"\ncritical = false");
    std::ofstream(f.path / "ear/structures.toml") << text;
    const BoneInput edited = imported(f.path / "ear");
    EXPECT_FALSE(named(edited, "hammer").critical);
    EXPECT_TRUE(named(edited, "my place").critical);  // the table says so, whatever the name
    EXPECT_TRUE(named(edited, "facial nerve").critical);
    EXPECT_EQ(edited.bone.label, first.bone.label);
    EXPECT_EQ(first.table_voxels, edited.table_voxels);
    // Each colour's block has 2 x 2 x 1 voxels.
    for (const std::uint64_t n : first.table_voxels) EXPECT_EQ(n, 4U);
    std::ofstream(f.path / "ear/structures.toml") << "[[structure]]\ncolour = 'red'\nname = 'x'\n";
    EXPECT_THROW(imported(f.path / "ear"), StartupError);
}

}  // namespace
}  // namespace tact::prep_structures_test
