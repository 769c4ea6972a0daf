// The emulated CP2112 without a kernel: reports about its pins.
#include "tests/emu/cp2112.hpp"

#include <gtest/gtest.h>

namespace tact::emu::emu_cp2112_test {
namespace {

constexpr std::uint8_t kConfig = 2, kGet = 3, kSet = 4;
using Bytes = std::vector<std::uint8_t>;

void send(Cp2112& chip, const Bytes& bytes) { chip.set_report(bytes); }

TEST(Cp2112, inputs_read_the_wires_and_outputs_the_masked_writes) {
    Cp2112 chip;
    chip.set(0, true);
    chip.set(7, true);
    EXPECT_EQ(chip.get_report(kGet), (Bytes{kGet, 0x81}));
    send(chip, {kConfig, 0x70, 0xFF, 0, 0});
    EXPECT_EQ(chip.get_report(kConfig)[1], 0x70);
    send(chip, {kSet, 0xFF, 0x10});
    EXPECT_EQ(chip.get_report(kGet), (Bytes{kGet, 0x91}));
    EXPECT_TRUE(chip.level(4));
    EXPECT_FALSE(chip.level(5));
    send(chip, {kSet, 0x00, 0x10});
    EXPECT_FALSE(chip.level(4));
    EXPECT_EQ(chip.edges(4), 2U);
    EXPECT_EQ(chip.edges(5), 0U);
}

TEST(Cp2112, an_input_wired_to_an_output_follows_it_and_an_undriven_wire_is_low) {
    Cp2112 chip;
    chip.follow(3, 4);
    chip.set(3, true);
    EXPECT_FALSE(chip.level(3));
    send(chip, {kConfig, 0x10, 0xFF, 0, 0});
    send(chip, {kSet, 0x10, 0x10});
    EXPECT_TRUE(chip.level(3));
    send(chip, {kConfig, 0x00, 0xFF, 0, 0});
    EXPECT_FALSE(chip.level(3));
}

TEST(Cp2112, short_or_unknown_reports_and_invalid_pins_change_nothing) {
    Cp2112 chip;
    chip.set(1, true);
    const Bytes before = chip.get_report(kGet);
    send(chip, {});
    send(chip, {kConfig});
    send(chip, {kSet, 0xFF});
    send(chip, {0x99, 0xFF, 0xFF});
    chip.set(8, true);
    chip.set(4'000'000'000U, true);
    chip.follow(1, 99);
    EXPECT_EQ(chip.get_report(kGet), before);
    EXPECT_FALSE(chip.level(8));
    EXPECT_EQ(chip.get_report(0x99), (Bytes{0x99, 0}));
    EXPECT_EQ(chip.get_report(6).size(), 14U);
}

}  // namespace
}  // namespace tact::emu::emu_cp2112_test
