// The export of the traces: a complete file or none, and a message about the result.
#include "gui/dashboard/trace_export.hpp"

#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <regex>

#include "ipc/base/error.hpp"
#include "tests/unit/gui_wait.hpp"

namespace tact::gui_trace_export_test {
namespace {

class Export : public testing::Test {
protected:
    void SetUp() override {
        char name[] = "/tmp/tact-export-XXXXXX";
        folder_ = mkdtemp(name);
        setenv("TACT_OUTPUT", (folder_ / "made").c_str(), 1);
        for (std::int64_t i = 1; i <= 3000; ++i) {
            TraceTopic t{};
            t.taken_at_ns = 1'000'000'000 + 1'000'000 * i;
            t.cycle = static_cast<std::uint64_t>(i);
            t.cost_ns = 50'000;
            traces_.scope.add(t, 1'000'000);
        }
        traces_.scope.hold();
    }
    void TearDown() override {
        unsetenv("TACT_OUTPUT");
        std::filesystem::remove_all(folder_);
    }
    bool message() {
        return test::wait_for([this] {
            out_.follow(traces_);
            return traces_.message_grade != Grade::unknown;
        });
    }

    std::filesystem::path folder_;
    TracesState traces_;
    TraceExport out_;
};

TEST_F(Export, writes_the_visible_span_and_reports_the_file) {
    traces_.scope.set_span(0.5);
    traces_.scope.zoom(0.5, traces_.scope.end_ns());
    traces_.export_wanted = true;
    out_.follow(traces_);
    EXPECT_FALSE(traces_.export_wanted);
    ASSERT_TRUE(message());
    EXPECT_EQ(traces_.message_grade, Grade::good) << traces_.message;
    std::vector<std::filesystem::path> files;
    for (const auto& entry : std::filesystem::directory_iterator(folder_ / "made"))
        files.push_back(entry.path());
    ASSERT_EQ(files.size(), 1U);  // no partial file beside it
    EXPECT_TRUE(std::regex_match(files[0].filename().string(),
                                 std::regex("[0-9]{4}-[0-9]{2}-[0-9]{2}_[0-9]{6}_traces[.]csv")))
        << files[0];
    EXPECT_NE(traces_.message.find(files[0].string()), std::string::npos) << traces_.message;
    std::ifstream in(files[0]);
    std::string line, last;
    std::size_t lines = 0;
    std::getline(in, line);
    EXPECT_EQ(line, "time_s,taken_at_ns,cycle,state,force_n,position_y_m,lateness_s,cost_s");
    for (; std::getline(in, line); ++lines) last = line;
    EXPECT_EQ(lines, 251U);  // a quarter of a second, with both ends
    EXPECT_NE(last.find(",3000,"), std::string::npos) << last;
}

TEST_F(Export, an_impossible_folder_is_reported_with_a_fix) {
    setenv("TACT_OUTPUT", "/proc/none", 1);
    traces_.export_wanted = true;
    out_.follow(traces_);
    ASSERT_TRUE(message());
    EXPECT_EQ(traces_.message_grade, Grade::bad);
    EXPECT_NE(traces_.message.find("fix:"), std::string::npos) << traces_.message;
}

TEST_F(Export, a_failed_write_leaves_no_partial_file) {
    EXPECT_THROW(write_whole_file((folder_ / "none" / "such.csv").string(), "x"), StartupError);
    std::filesystem::create_directory(folder_ / "taken.csv");
    EXPECT_THROW(write_whole_file((folder_ / "taken.csv").string(), "x"), StartupError);
    for (const auto& entry : std::filesystem::directory_iterator(folder_))
        EXPECT_EQ(entry.path().filename(), "taken.csv");
}

}  // namespace
}  // namespace tact::gui_trace_export_test
