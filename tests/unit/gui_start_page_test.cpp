// What the start page says of computer and device, from the output of tact doctor and tact probe.
#include <gtest/gtest.h>

#include "gui/window/demo_pictures.hpp"
#include "gui/window/start_controller.hpp"
#include "ipc/image/png.hpp"

namespace tact::gui_start_page_test {
namespace {

std::string findings(const std::string& rows) { return "{\"findings\": [" + rows + "], \"ok\": true}"; }

constexpr const char* kFine = R"({"name": "cache", "level": "ok", "says": "cache is there", "fix": ""})";
constexpr const char* kWarn =
    R"({"name": "kernel", "level": "warn", "says": "no real-time kernel", "fix": "install one"})";
constexpr const char* kFail =
    R"({"name": "opengl", "level": "fail", "says": "no OpenGL 3.3", "fix": "install a driver"})";

TEST(StartPage, a_computer_is_ready_or_works_or_says_what_fails_first) {
    EXPECT_EQ(computer_finding(findings(kFine)).status.grade, Grade::good);
    const StartFinding warned =
        computer_finding("a line before\n" + findings(std::string(kFine) + "," + kWarn));
    EXPECT_EQ(warned.status.grade, Grade::watch);
    EXPECT_NE(warned.status.text.find("1 change"), std::string::npos) << warned.status.text;
    EXPECT_EQ(warned.detail, "no real-time kernel\n    fix: install one");
    const StartFinding failed = computer_finding(findings(std::string(kWarn) + "," + kFail));
    EXPECT_EQ(failed.status.grade, Grade::bad);
    EXPECT_EQ(failed.status.text, "no OpenGL 3.3 (and 1 more: tact doctor)");
    EXPECT_TRUE(failed.detail.starts_with("no OpenGL 3.3\n    fix: install a driver\nno real-time"));
}

TEST(StartPage, a_device_is_what_probe_says_of_it) {
    const StartFinding there = device_finding(
        findings(std::string(kWarn) + R"(,{"name": "device", "level": "ok", "says": "an arm", "fix": ""})"));
    EXPECT_EQ(there.status.grade, Grade::good);
    EXPECT_EQ(there.status.text, "an arm");
    EXPECT_TRUE(there.detail.empty());
    const StartFinding gone = device_finding(
        findings(R"({"name": "device", "level": "fail", "says": "not found", "fix": "plug it in"})"));
    EXPECT_EQ(gone.status.grade, Grade::bad);
    EXPECT_EQ(gone.detail, "not found\n    fix: plug it in");
}

TEST(StartPage, output_that_is_no_report_is_said_to_be_none) {
    for (const std::string& bad : {std::string(), std::string("killed"), std::string("{"), std::string("{}"),
                                   std::string("{\"findings\": 3}"), findings("3"), findings("[]")})
        for (const StartFinding& found : {computer_finding(bad), device_finding(bad)}) {
            EXPECT_EQ(found.status.grade, Grade::watch) << bad;
            EXPECT_NE(found.status.text.find("no answer"), std::string::npos) << bad;
        }
    EXPECT_LT(computer_finding(
                  findings(R"({"name": "x", "level": "fail", "says": ")" + std::string(5000, 'y') + "\"}"))
                  .status.text.size(),
              500U);
}

TEST(StartPage, every_demo_with_a_description_has_a_picture_that_can_be_read) {
    std::size_t pictures = 0;
    for (const DemoCard& demo : demo_cards()) {
        const auto content = demo_picture(demo.name);
        EXPECT_EQ(content.empty(), demo.what[0] == '\0') << demo.name;
        if (content.empty()) continue;
        PngReader png(content);
        EXPECT_EQ(png.width_px(), 560U);
        EXPECT_EQ(png.height_px(), 350U);
        EXPECT_EQ(png.read(PngFormat::rgb).size(), 3U * 560U * 350U);
        ++pictures;
    }
    EXPECT_EQ(pictures, 3U);
}

}  // namespace
}  // namespace tact::gui_start_page_test
