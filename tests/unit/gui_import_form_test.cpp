// The dialog before an import: what it takes from a report, and the arguments that its answers become.
#include <gtest/gtest.h>

#include <cmath>

#include <nlohmann/json.hpp>

#include "gui/window/import_form.hpp"

namespace tact::gui_import_form_test {
namespace {

using nlohmann::json;
using Words = std::vector<std::string>;

json scan_report() {
    return {{"lines", {{{"label", "Format"}, {"value", "DICOM"}}}},
            {"histogram", {{"low", -1000}, {"high", 3000}, {"count", {100, 0, 10, 1}}}},
            {"numbers",
             {{{"option", "--threshold-hu"},
               {"label", "Bone above"},
               {"unit", "HU"},
               {"help", "h"},
               {"low", -1e6},
               {"high", 1e6},
               {"proposed", 300},
               {"in_histogram", true}},
              {{"option", "--solid-hu"},
               {"label", "Solid"},
               {"unit", "HU"},
               {"help", "h"},
               {"low", -1e6},
               {"high", 1e6},
               {"proposed", 1800},
               {"in_histogram", true}},
              {{"option", "--spacing-mm"},
               {"label", "Spacing"},
               {"unit", "mm"},
               {"help", "h"},
               {"low", 0.001},
               {"high", 100},
               {"proposed", nullptr},
               {"in_histogram", false}}}},
            {"choices",
             {{{"option", "--series"},
               {"label", "Series"},
               {"chosen", 1},
               {"rows", {{{"value", "1"}, {"text", "scout"}}, {{"value", "2"}, {"text", "volume"}}}}}}},
            {"warnings", {"look at it"}}};
}

TEST(ImportForm, shows_what_the_report_says) {
    const auto form = read_import_form(scan_report().dump());
    ASSERT_TRUE(form);
    ASSERT_EQ(form->lines.size(), 1U);
    EXPECT_EQ(form->lines[0].value, "DICOM");
    EXPECT_EQ(form->low, -1000.0);
    EXPECT_EQ(form->high, 3000.0);
    ASSERT_EQ(form->bins.size(), 4U);
    EXPECT_EQ(form->bins[0], 1.0F);
    EXPECT_EQ(form->bins[1], 0.0F);
    EXPECT_NEAR(form->bins[2], std::log(11.0) / std::log(101.0), 1e-6);
    EXPECT_EQ(form->numbers.at(1).value(), 1800.0);
    EXPECT_EQ(form->choices.at(0).chosen, 1U);
    EXPECT_EQ(form->warnings, Words{"look at it"});
}

TEST(ImportForm, what_is_left_as_proposed_is_no_argument_and_what_must_be_answered_is_waited_for) {
    auto form = read_import_form(scan_report().dump());
    ASSERT_TRUE(form);
    EXPECT_FALSE(form->complete()) << "the spacing is not proposed";
    form->numbers[2].set(0.5);
    EXPECT_TRUE(form->complete());
    EXPECT_EQ(form->arguments(), (Words{"--series", "2", "--spacing-mm", "0.5"}));
    form->numbers[0].set(450.0);
    EXPECT_EQ(form->arguments(),
              (Words{"--series", "2", "--threshold-hu", "450", "--solid-hu", "1800", "--spacing-mm", "0.5"}))
        << "both values of the scan, so that they belong together";
    form->choices[0].chosen = 0;
    EXPECT_EQ(form->choice_arguments(), (Words{"--series", "1"}));
    for (const char* const wrong : {"", "x", "0.5 mm", "0", "101", "nan"}) {
        std::snprintf(form->numbers[2].typed.data(), form->numbers[2].typed.size(), "%s", wrong);
        EXPECT_FALSE(form->complete()) << wrong;
    }
}

TEST(ImportForm, names_of_structures_are_edited_in_the_table_beside_the_files) {
    json j = scan_report();
    j["structure_table"] = "/data/ear/structures.toml";
    j["structures"] = {
        {{"label", 0}, {"colour", "#F4D631"}, {"name", "facial nerve"}, {"critical", true}, {"voxels", 120}},
        {{"label", 0}, {"colour", "#010203"}, {"name", "#010203"}, {"critical", false}, {"voxels", 9}},
        {{"label", 300}, {"colour", "#010204"}, {"name", "no"}, {"critical", false}, {"voxels", 9}},
        {{"label", 0}, {"colour", "red"}, {"name", "no"}, {"critical", false}, {"voxels", 9}}};
    auto form = read_import_form(j.dump());
    ASSERT_TRUE(form);
    ASSERT_EQ(form->structures.size(), 2U);
    EXPECT_EQ(form->edited_table(), "") << "nothing was changed: nothing is written";
    std::snprintf(form->structures[1].name.data(), form->structures[1].name.size(), "%s", "round \"window\"");
    form->structures[1].critical = true;
    const std::string table = form->edited_table();
    EXPECT_NE(table.find("colour = \"#F4D631\"\nname = \"facial nerve\"\ncritical = true"), std::string::npos)
        << table;
    EXPECT_NE(table.find("colour = \"#010203\"\nname = \"round \\\"window\\\"\"\ncritical = true"),
              std::string::npos);
    form->numbers[2].set(1.0);
    EXPECT_TRUE(form->complete());
    form->structures[0].name[0] = 0;
    EXPECT_FALSE(form->complete()) << "a structure without a name";
    // Only a table of structures is ever written.
    for (const char* const elsewhere : {"/home/a/.bashrc", "structures.toml", ""}) {
        j["structure_table"] = elsewhere;
        EXPECT_TRUE(read_import_form(j.dump())->structures.empty()) << elsewhere;
    }
}

TEST(ImportForm, a_report_that_is_none_or_hostile_gives_no_arguments) {
    for (const char* const wrong : {"", "{", "[]", "7", "{}", "tact-prep: no such file"})
        EXPECT_FALSE(read_import_form(wrong)) << wrong;
    json j = scan_report();
    j["numbers"][0]["option"] = "-o";
    j["numbers"][1]["option"] = "--solid-hu /etc";
    j["numbers"][2]["low"] = "none";
    j["choices"][0]["rows"][0]["value"] = "--output";
    j["histogram"]["high"] = -2000;
    auto form = read_import_form(j.dump());
    ASSERT_TRUE(form);
    EXPECT_TRUE(form->numbers.empty());
    EXPECT_TRUE(form->choices.empty());
    EXPECT_TRUE(form->bins.empty());
    EXPECT_TRUE(form->arguments().empty());
    j = scan_report();
    j["choices"][0]["chosen"] = 7;
    for (int i = 0; i < 1000; ++i) {
        j["lines"].push_back({{"label", std::string(5000, 'a')}, {"value", 7}});
        j["warnings"].push_back(std::string(5000, 'b'));
        j["numbers"].push_back(j["numbers"][0]);
    }
    form = read_import_form(j.dump());
    ASSERT_TRUE(form);
    EXPECT_EQ(form->lines.size(), ImportForm::kLinesMost);
    EXPECT_EQ(form->warnings.size(), ImportForm::kLinesMost);
    EXPECT_EQ(form->numbers.size(), ImportForm::kNumbersMost);
    EXPECT_LE(form->warnings.back().size(), ImportForm::kTextMost + 3);
    EXPECT_TRUE(form->choices.empty());
}

}  // namespace
}  // namespace tact::gui_import_form_test
