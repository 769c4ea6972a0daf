// The texts that tact-emu reads and writes: orders, fault files, requests, report lines, USB descriptors.
#include <gtest/gtest.h>

#include <fstream>

#include "ipc/base/error.hpp"
#include "tests/emu/part_requests.hpp"
#include "tests/emu/report.hpp"
#include "tests/emu/script.hpp"
#include "tests/emu/usb_descriptors.hpp"

namespace tact::emu::emu_script_test {
namespace {

using std::chrono::milliseconds;

std::string why_not(std::string_view line) {
    try {
        static_cast<void>(parse_order(line, "here"));
    } catch (const StartupError& e) {
        return e.what();
    }
    return "";
}

TEST(Orders, are_read_with_their_time_numbers_and_arm) {
    const auto order = [](std::optional<Duration> at, Action action, std::array<int, 3> numbers = {},
                          const char* arm = "") {
        return Order{at, action, numbers, arm};
    };
    EXPECT_EQ(parse_order("unplug", ""), order({}, Action::unplug));
    EXPECT_EQ(parse_order("at 3.2 s unplug right", ""),
              order(milliseconds(3200), Action::unplug, {}, "right"));
    EXPECT_EQ(parse_order("at 0.5s  plug\tRIGHT-2 # again", ""),
              order(milliseconds(500), Action::plug, {}, "RIGHT-2"));
    EXPECT_EQ(parse_order("at 4 corrupt 5\r", ""), order(milliseconds(4000), Action::corrupt, {5, 0}));
    EXPECT_EQ(parse_order("silence 20 ms L", ""), order({}, Action::silence, {20, 0}, "L"));
    EXPECT_EQ(parse_order("silence 20 L", ""), order({}, Action::silence, {20, 0}, "L"));
    EXPECT_EQ(parse_order("encoder jump 2 -5000", ""), order({}, Action::encoder_jump, {2, -5000}));
    EXPECT_EQ(parse_order("tracker out-of-range", ""), order({}, Action::tracker_out_of_range));
    EXPECT_EQ(parse_order("tracker hold -120 35 480", ""), order({}, Action::tracker_hold, {-120, 35, 480}));
    EXPECT_EQ(parse_order("hand hold 10 -20 30 LEFT", ""),
              order({}, Action::hand_hold, {10, -20, 30}, "LEFT"));
    EXPECT_EQ(parse_order("can bus-off", ""), order({}, Action::bus_off));
    EXPECT_FALSE(parse_order("", "").has_value());
    EXPECT_FALSE(parse_order("   # only a comment", "").has_value());
}

TEST(Orders, are_refused_with_place_reason_and_fix) {
    const auto says = [](std::string_view line, const char* a, const char* b) {
        const std::string text = why_not(line);
        EXPECT_NE(text.find("here"), std::string::npos) << line;
        EXPECT_NE(text.find(a), std::string::npos) << line << ": " << text;
        EXPECT_NE(text.find(b), std::string::npos) << line << ": " << text;
        EXPECT_NE(text.find("fix:"), std::string::npos) << line;
    };
    says("explode", "unknown order \"explode\"", "encoder jump ENCODER COUNTS [ARM]");
    says("corrupt", "N is \"\"", "1 to 100000");
    says("corrupt 0", "\"0\"", "1 to 100000");
    says("corrupt 99999999999999999999", "999", "1 to 100000");
    says("tracker hold 1 2", "Z_MM", "-5000 to 5000");
    says("hand hold 1 2 900", "Z_MM", "-500 to 500");
    says("encoder stuck 6", "ENCODER", "0 to 5");
    says("encoder jump 2 1e9", "COUNTS", "encoder jump");
    says("unplug left right", "too many words", "unplug [ARM]");
    says("unplug ../../etc", "cannot be the serial", "serial");
    says("can down left", "too many words", "can down");
    says("at noon unplug", "\"noon\"", "at 3.2 s");
    says("at nan unplug", "\"nan\"", "at 3.2 s");
    says("at -1 unplug", "\"-1\"", "at 3.2 s");
    says("at", "needs a time", "at 3.2 s");
    says(std::string(500, 'x'), "longer than 200", "one order per line");
    says("\x1b[2J\x07", "\"?[2J?\"", "orders:");
}

TEST(Orders, of_every_row_of_the_table_are_read_back) {
    for (const ActionRow& row : actions()) {
        Order wanted;
        wanted.action = row.action;
        std::string line = row.words;
        for (std::size_t i = 0; i < row.numbers.size(); ++i) {
            wanted.numbers.at(i) = row.numbers[i].high;
            line.append(" ").append(std::to_string(row.numbers[i].high));
        }
        if (row.part == Part::arm) line.append(" ").append(wanted.arm = "A_b-9");
        EXPECT_EQ(parse_order(line, "here"), wanted) << line;
        EXPECT_EQ(row_of(row.action).words, row.words);
    }
}

TEST(FaultFiles, come_in_the_order_of_their_times) {
    const auto script = parse_script("at 3 plug\n# then\n\nat 1 unplug\nhot\nat 1 well", "file");
    ASSERT_EQ(script.size(), 4U);
    EXPECT_EQ(script[0].action, Action::hot);
    EXPECT_EQ(script[1].action, Action::unplug);
    EXPECT_EQ(script[2].action, Action::well) << "of the same time: as written";
    EXPECT_EQ(script[3].action, Action::plug);
}

TEST(FaultFiles, name_the_line_that_is_wrong_and_are_bounded) {
    const auto why = [](const std::string& text) -> std::string {
        try {
            static_cast<void>(parse_script(text, "file"));
        } catch (const StartupError& e) {
            return e.what();
        }
        return "";
    };
    EXPECT_NE(why("plug\n\nexplode\n").find("file, line 3"), std::string::npos);
    std::string many;
    for (std::size_t i = 0; i <= kOrdersMax; ++i) many += "plug\n";
    EXPECT_NE(why(many).find("more than 10000 orders"), std::string::npos);
    EXPECT_THROW(static_cast<void>(read_script("/nowhere/at/all")), StartupError);
    const std::string path = testing::TempDir() + "tact_emu_faults";
    std::ofstream(path) << std::string(kScriptBytesMax + 1, '\n');
    EXPECT_THROW(static_cast<void>(read_script(path)), StartupError);
    std::ofstream(path) << "at 2 s stall LEFT\n";
    EXPECT_EQ(read_script(path).size(), 1U);
}

TEST(Requests, are_read_or_refused_with_their_form) {
    EXPECT_EQ(parse_arm("LEFT").serial, "LEFT");
    EXPECT_EQ(parse_arm("LEFT").metrics.model, "premium-1.5");
    EXPECT_EQ(parse_arm("R-2:premium-1.5").serial, "R-2");
    EXPECT_THROW(static_cast<void>(parse_arm("R:omni")), StartupError) << "its motors are unknown";
    for (const char* bad :
         {"", "a b", "../x", ":premium-1.5", "L:none", "L:premium-1.5:x", "12345678901234567"})
        EXPECT_THROW(static_cast<void>(parse_arm(bad)), StartupError) << bad;
    const TrackerRequest t = parse_tracker("vcan0:fd:240:4");
    EXPECT_EQ(t.interface, "vcan0");
    EXPECT_EQ(t.can.fix.format, CanFormat::fd);
    EXPECT_EQ(t.can.rate_hz, 240.0);
    EXPECT_EQ(t.can.fix.sensors, 4U);
    EXPECT_EQ(parse_tracker("can0").can.fix.format, CanFormat::classic);
    for (const char* bad :
         {"", ":fd", "c:can", "c:fd:9", "c:fd:240:5", "c:fd:240:4:1", "c:fd:x", "sixteenletters__"})
        EXPECT_THROW(static_cast<void>(parse_tracker(bad)), StartupError) << bad;
}

TEST(Report, is_a_line_for_people_or_one_json_object) {
    const ReportLine line{instant_from_ns(1'234'567'890'123), "arm", "LEFT", "amplifier", "on \"\\\n"};
    EXPECT_EQ(line_text(line, {}, false), "1234.567890 arm LEFT: amplifier on ???\n");
    EXPECT_EQ(line_text(line, {{"states", 7}, {"commands", 8}}, false),
              "1234.567890 arm LEFT: amplifier on ??? (states 7, commands 8)\n");
    EXPECT_EQ(line_text(line, {{"states", 7}}, true),
              "{\"t_ns\": 1234567890123, \"part\": \"arm\", \"name\": \"LEFT\", \"what\": \"amplifier\", "
              "\"detail\": \"on ???\", \"states\": 7}\n");
}

// Bytes written out by hand from the USB 2.0 specification, tables 9-12 and 9-13, and FunctionFS's header.
TEST(Descriptors, are_those_of_the_protocol) {
    const auto hex = [](const std::vector<std::byte>& bytes) {
        std::string text;
        for (const std::byte b : bytes) {
            constexpr const char* digits = "0123456789abcdef";
            text += digits[static_cast<unsigned>(b) >> 4];
            text += digits[static_cast<unsigned>(b) & 15U];
        }
        return text;
    };
    const auto of_speed = [](const std::string& interval) {
        return "090400"
               "00"
               "02"
               "ff5401"
               "01"
               "0705"
               "81"
               "03"
               "4000" +
               interval +
               "0705"
               "02"
               "03"
               "4000" +
               interval;
    };
    // Magic 3, 66 bytes, full and high speed, three descriptors each.
    EXPECT_EQ(hex(ffs_descriptors(1000)),
              "03000000"
              "42000000"
              "03000000"
              "03000000"
              "03000000" +
                  of_speed("01") + of_speed("04"));
    EXPECT_EQ(interval_of(100), 4);
    EXPECT_EQ(interval_of(2000), 3);
    EXPECT_EQ(interval_of(4000), 2);
    EXPECT_EQ(interval_of(8000), 1);
    // Magic 2, 27 bytes, one string of one language, English.
    EXPECT_EQ(hex(ffs_strings()),
              "02000000"
              "1b000000"
              "01000000"
              "01000000"
              "0904"
              "546163742061726d00");
}

}  // namespace
}  // namespace tact::emu::emu_script_test
