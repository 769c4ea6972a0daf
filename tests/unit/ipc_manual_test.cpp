// Manual pages and completion of a small program whose help texts contain the special characters of roff and bash.
#include <gtest/gtest.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <map>

#include "ipc/manual/command.hpp"
#include "ipc/manual/completion.hpp"
#include "ipc/manual/manual.hpp"
#include "ipc/manual/page.hpp"
#include "ipc/manual/roff.hpp"

namespace tact::manual::ipc_manual_test {
namespace {

enum class Style { trace, tube };

struct Small {
    CLI::App app{"Small: measures a thing. Second sentence"};
    std::string text, secret;
    double number = 2.0;
    std::vector<std::string> many;
    Style style = Style::tube;
    bool flag = false;

    Small() {
        app.set_version_flag("--version", "small 9.8.7");
        app.footer("Exit codes: 0 as asked; 1 error");
        auto* const sub = app.add_subcommand("work", ".leading dot and 'quote' and \\ and \t tab");
        sub->add_option("--seconds", number, "end after this time")
            ->check(CLI::Range(0.0, 1e7))
            ->capture_default_str();
        sub->add_option("--kind", text, "kind of work")->check(CLI::IsMember({"slow", "fast"}))->required();
        sub->add_option("--style", style, "style of drawing")
            ->transform(CLI::CheckedTransformer(
                std::map<std::string, Style>{{"trace", Style::trace}, {"tube", Style::tube}}));
        sub->add_option("--law", text, "law of the governor")->type_name("elastic|fixed");
        sub->add_option("--secret", secret, "for tests")->group("");
        auto* const flag_option = sub->add_flag("-f,--flag", flag, "a flag");
        sub->add_option("scene", many, "scenes")->required()->needs(flag_option);
        sub->add_option_group("Window", "options of the window")
            ->add_option("--size", secret, "size in \xC3\x85");
    }
    Command read() { return read_command(app, {"small"}); }
};

std::string page_of(const std::string& name) {
    Small small;
    for (const Page& p : pages(small.read(), {}))
        if (p.name == name) return p.text;
    return {};
}

bool holds(const std::string& text, const std::string& part) { return text.find(part) != std::string::npos; }

TEST(Manual, text_is_escaped_for_roff) {
    EXPECT_EQ(roff("a-b"), "a\\-b");
    EXPECT_EQ(roff("C:\\n"), "C:\\en");
    EXPECT_EQ(roff(".TH"), "\\&.TH");
    EXPECT_EQ(roff("1.5\n.5\n 'x'"), "1.5\n\\&.5\n\\(aqx\\(aq");
    EXPECT_EQ(roff("\"~^`"), "\\(dq\\(ti\\(ha\\(ga");
    EXPECT_EQ(roff("a\tb\x01"), "a b");
    EXPECT_EQ(roff("12 \xC3\x85"), "12 \\[u00C5]");
    EXPECT_EQ(roff("\xE2\x82\xAC \xF0\x9F\x98\x80"), "\\[u20AC] \\[u1F600]");
    EXPECT_EQ(roff("\xC3"), "\\[uFFFD]");
}

TEST(Manual, no_line_of_a_help_text_is_a_roff_request) {
    const std::string text = page_of("small-work");
    EXPECT_TRUE(holds(text, "\\&.leading dot and \\(aqquote\\(aq and \\e and"));
    EXPECT_FALSE(holds(text, "\t"));
    EXPECT_TRUE(std::all_of(text.begin(), text.end(), [](unsigned char c) { return c < 0x7F; }));
}

TEST(Manual, a_page_names_type_range_default_and_conditions) {
    const std::string text = page_of("small-work");
    EXPECT_TRUE(holds(text,
                      ".TP\n\\fB\\-\\-seconds\\fR \\fIX\\fR\n"
                      "End after this time. Range: 0 to 10000000. Default: 2.\n"));
    EXPECT_TRUE(holds(text, "Kind of work. Required.\n"));
    EXPECT_TRUE(holds(text, "Scenes. May be repeated. Needs \\fB\\-\\-flag\\fR.\n"));
    EXPECT_TRUE(holds(text, ".TP\n\\fB\\-f\\fR, \\fB\\-\\-flag\\fR\nA flag.\n"));
    EXPECT_TRUE(holds(text, ".SS \"Window\"\nOptions of the window.\n"));
}

TEST(Manual, choices_are_shown_as_a_user_types_them) {
    const std::string text = page_of("small-work");
    EXPECT_TRUE(holds(text, "\\fB\\-\\-kind\\fR \\fBslow|\\:fast\\fR\n"));
    EXPECT_TRUE(holds(text, "\\fB\\-\\-style\\fR \\fBtrace|\\:tube\\fR\n"));
    EXPECT_TRUE(holds(text, "\\fB\\-\\-law\\fR \\fBelastic|\\:fixed\\fR\n"));
}

TEST(Manual, the_synopsis_shows_what_is_required) {
    EXPECT_TRUE(holds(page_of("small-work"),
                      ".SH SYNOPSIS\n\\fBsmall work\\fR \\fB\\-\\-kind\\fR \\fIslow|\\:fast\\fR "
                      "[\\fIOPTION\\fR]... \\fISCENE\\fR...\n"));
}

TEST(Manual, hidden_options_stay_hidden) {
    EXPECT_FALSE(holds(page_of("small-work"), "secret"));
    Small small;
    EXPECT_FALSE(holds(completion(small.read()), "secret"));
}

TEST(Manual, the_title_has_the_version_and_no_date_of_the_build) {
    ::unsetenv("SOURCE_DATE_EPOCH");
    EXPECT_EQ(page_of("small").find(".TH SMALL 1 \"\" \"Tact 9.8.7\" \"Tact manual\"\n"), 0U);
    ::setenv("SOURCE_DATE_EPOCH", "86400", 1);
    EXPECT_EQ(page_of("small").find(".TH SMALL 1 \"1970-01-02\""), 0U);
    ::unsetenv("SOURCE_DATE_EPOCH");
}

TEST(Manual, name_and_exit_status_are_from_description_and_footer) {
    const std::string text = page_of("small");
    EXPECT_TRUE(holds(text, ".SH NAME\nsmall \\- measures a thing\n"));
    EXPECT_TRUE(holds(text, ".SH DESCRIPTION\nMeasures a thing. Second sentence.\n"));
    EXPECT_TRUE(holds(text, ".TP\n\\fB0\\fR\nAs asked.\n.TP\n\\fB1\\fR\nError.\n"));
}

TEST(Manual, completion_offers_choices_numbers_and_files) {
    Small small;
    const std::string data = completion(small.read());
    EXPECT_TRUE(holds(data, "_tact_commands['small']='work'\n"));
    EXPECT_TRUE(holds(data, "_tact_values['small work --kind']='words slow fast'\n"));
    EXPECT_TRUE(holds(data, "_tact_values['small work --style']='words trace tube'\n"));
    EXPECT_TRUE(holds(data, "_tact_values['small work --law']='words elastic fixed'\n"));
    EXPECT_TRUE(holds(data, "_tact_values['small work --seconds']='none'\n"));
    EXPECT_TRUE(holds(data, "_tact_values['small work 1']='files tact'\n"));
    EXPECT_TRUE(holds(data, "_tact_values['small work *']='files tact'\n"));
    EXPECT_FALSE(holds(data, "_tact_values['small work --flag']"));
}

TEST(Manual, other_command_lines_are_passed_to_the_parser) {
    Small small;
    for (const std::vector<const char*>& argv : std::vector<std::vector<const char*>>{
             {"small"}, {"small", "--help"}, {"small", "--manual"}, {"small", "work", "--completion"}})
        EXPECT_FALSE(answer(small.app, "small", static_cast<int>(argv.size()), argv.data()).has_value());
}

TEST(Manual, pages_that_cannot_be_written_are_an_error) {
    Small small;
    const char* const argv[] = {"small", "--manual", "/dev/null/folder"};
    EXPECT_EQ(answer(small.app, "small", 3, argv), 1);
}

}  // namespace
}  // namespace tact::manual::ipc_manual_test
