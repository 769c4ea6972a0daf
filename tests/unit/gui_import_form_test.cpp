// The dialog before an import: what it takes from a report, and the arguments that its answers become.
#include <gtest/gtest.h>

#include <cmath>

#include <nlohmann/json.hpp>

#include "gui/window/import_answers.hpp"
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

// What a scan asks: a spacing, a threshold in its own unit, and which series.
ImportForm scan_form() {
    auto form = read_import_form(
        R"({"lines":[],"numbers":[{"option":"--spacing-mm","low":0.001,"high":100},)"
        R"({"option":"--threshold-hu","low":-1e6,"high":1e6,"proposed":120,"of_file":true}],)"
        R"("choices":[{"option":"--series","chosen":0,"rows":[{"value":"1.2","text":"a"},{"value":"1.3","text":"b"}]}]})");
    return form.value_or(ImportForm{});
}

TEST(ImportAnswers, of_another_file_are_proposed_where_they_are_not_of_that_file_alone) {
    Recalled recalled{
        {{"--spacing-mm", "0.15"}, {"--threshold-hu", "300"}, {"--series", "1.3"}}, false, "head.nrrd"};
    ImportForm form = scan_form();
    EXPECT_TRUE(propose(recalled, true, form)) << "the files must be examined with the other series";
    EXPECT_EQ(form.choices[0].chosen, 1U);
    EXPECT_STREQ(form.numbers[0].typed.data(), "0.15");
    EXPECT_EQ(form.numbers[0].recalled_from, "As for head.nrrd.");
    EXPECT_STREQ(form.numbers[1].typed.data(), "120");
    EXPECT_FALSE(propose(recalled, false, form)) << "once";
    EXPECT_EQ(answers_of(form),
              (std::map<std::string, std::string>{{"--spacing-mm", "0.15"}, {"--series", "1.3"}}));
    recalled.same_file = true;
    static_cast<void>(propose(recalled, false, form));
    EXPECT_STREQ(form.numbers[1].typed.data(), "300");
}

TEST(ImportAnswers, that_do_not_fit_the_dialog_are_left_out) {
    for (const char* const wrong :
         {"", "0", "1e9", "-3", "x", "0.1 ", "nan", "0.15000000000000000000000000000001"}) {
        ImportForm form = scan_form();
        EXPECT_FALSE(
            propose({{{"--spacing-mm", wrong}, {"--series", "9"}, {"--other", "1"}}, true, "a"}, true, form));
        EXPECT_EQ(form.numbers[0].typed[0], 0) << wrong;
        EXPECT_TRUE(form.numbers[0].recalled.empty() && form.choices[0].recalled_from.empty());
    }
}

TEST(ImportAnswers, the_same_file_goes_before_the_newest_of_its_type_in_its_folder) {
    const ImportAnswers old{{"/d/a.nrrd", 5, 10, "drill"}, {{"--a", "1"}}},
        newer{{"/d/b.NRRD.gz", 6, 11, "drill"}, {{"--a", "2"}}},
        other_type{{"/d/c.nii", 6, 11, "drill"}, {{"--a", "3"}}},
        elsewhere{{"/e/d.nrrd", 6, 11, "drill"}, {{"--a", "4"}}};
    const auto all = with_answers(with_answers(with_answers({old}, newer), other_type), elsewhere);
    const auto value = [&](const ImportedFile& file) {
        const auto found = recall(all, file);
        return found ? found->answers.at("--a") + (found->same_file ? " same " : " as ") + found->name
                     : std::string();
    };
    EXPECT_EQ(value(old.file), "1 same a.nrrd");
    EXPECT_EQ(value({"/d/new.nrrd", 1, 1, "drill"}), "2 as b.NRRD.gz");
    EXPECT_EQ(value({"/d/a.nrrd", 5, 12, "drill"}), "2 as b.NRRD.gz") << "it has changed";
    EXPECT_EQ(value({"/d/new.mha", 1, 1, "drill"}), "");
    EXPECT_EQ(value({"/d/new.nrrd", 1, 1, "dock"}), "");
    std::vector<ImportAnswers> many;
    for (int i = 0; i < 100; ++i)
        many = with_answers(
            std::move(many),
            {{"/d/" + std::string(4000, 'x') + std::to_string(i), 1, 1, "drill"}, {{"--a", "1"}}});
    EXPECT_LE(many.size(), kImportsMost);
    EXPECT_EQ(read_answers_text(answers_text(many), "x"), many) << "what is written can be read";
}

}  // namespace
}  // namespace tact::gui_import_form_test
