// Loading of a Falcon's firmware, and the errors if it fails.
#include "hal/falcon/boot.hpp"

#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>

#include "ipc/base/error.hpp"
#include "tests/support/falcon_board.hpp"
#include "tests/support/says.hpp"

namespace tact::hal_falcon_boot_test {
namespace {

using emu::FalconBoard;
using emu::LockstepFalcon;
using falcon::Link;
using usb::BusFault;

TEST(FtdiPieces, drop_their_status_and_damaged_ones_all_bytes) {
    const auto piece = [](std::initializer_list<int> values) {
        static std::vector<std::byte> packet;
        packet.clear();
        for (const int v : values) packet.push_back(static_cast<std::byte>(v));
        return falcon::ftdi::piece_of(packet);
    };
    EXPECT_TRUE(piece({0x31, 0x60}).bytes.empty());  // a status without data
    EXPECT_FALSE(piece({0x31, 0x60}).damaged);
    ASSERT_EQ(piece({0x31, 0x60, 'A', 'B'}).bytes.size(), 2U);
    EXPECT_EQ(piece({0x31, 0x60, 'A', 'B'}).bytes[0], std::byte{'A'});
    for (const int error : {0x02, 0x04, 0x08, 0x10}) {
        EXPECT_TRUE(piece({0x31, 0x60 | error, 'A'}).damaged);
        EXPECT_TRUE(piece({0x31, 0x60 | error, 'A'}).bytes.empty());
    }
    EXPECT_TRUE(piece({}).damaged);
    EXPECT_TRUE(piece({0x31}).damaged);
    EXPECT_TRUE(falcon::ftdi::piece_of(std::vector<std::byte>(65)).damaged);
    EXPECT_EQ(falcon::ftdi::piece_of(std::vector<std::byte>(64)).bytes.size(), 62U);
}

class FalconBoot : public testing::Test {
protected:
    FalconBoot() {
        std::string pattern = (std::filesystem::temp_directory_path() / "falcon-XXXXXX").string();
        folder_ = mkdtemp(pattern.data());
        write("firmware.bin", FalconBoard::firmware_of(700));
    }
    ~FalconBoot() override { std::filesystem::remove_all(folder_); }

    std::string write(const std::string& name, const std::vector<std::byte>& bytes) {
        std::ofstream file(folder_ / name, std::ios::binary);
        file.write(reinterpret_cast<const char*>(bytes.data()), static_cast<std::streamsize>(bytes.size()));
        return (folder_ / name).string();
    }
    [[nodiscard]] std::string path(const std::string& name = "firmware.bin") const {
        return (folder_ / name).string();
    }
    // Returns the error of open(), or "" on success.
    static std::string opening(LockstepFalcon& arm) {
        try {
            static_cast<void>(arm.open_only());
        } catch (const StartupError& e) {
            return e.what();
        }
        return "";
    }

    std::filesystem::path folder_;
};

TEST_F(FalconBoot, running_firmware_is_kept_and_no_file_is_needed) {
    LockstepFalcon arm;
    arm.board().push_through();
    EXPECT_EQ(opening(arm), "");
    EXPECT_EQ(arm.board().loads, 0U);
    EXPECT_EQ(arm.board().homed, falcon::kHomedAll);  // no restart
}

TEST_F(FalconBoot, the_firmware_file_is_loaded_to_the_last_byte) {
    for (const std::size_t size : {1U, 61U, 62U, 63U, 700U}) {
        const std::vector<std::byte> firmware = FalconBoard::firmware_of(size);
        LockstepFalcon arm(write("some.bin", firmware));
        arm.board().runs = false;
        arm.board().firmware = firmware;
        EXPECT_EQ(opening(arm), "") << size;
        EXPECT_EQ(arm.board().loads, 1U);
        EXPECT_EQ(arm.board().loaded, firmware);
    }
}

TEST_F(FalconBoot, a_missed_hello_is_repeated) {
    LockstepFalcon arm(path());
    arm.board().runs = false;
    arm.board().hellos_missed = 7;
    EXPECT_EQ(opening(arm), "");
}

TEST_F(FalconBoot, a_wrong_echo_restarts_the_load) {
    LockstepFalcon arm(path());
    arm.board().runs = false;
    arm.board().wrong_echo_at = 321;
    arm.board().wrong_echoes = 2;
    EXPECT_EQ(opening(arm), "");
    EXPECT_EQ(arm.board().wrong_echoes, 0U);
    EXPECT_EQ(arm.board().loads, 1U);
}

TEST_F(FalconBoot, failures_are_reported_with_a_fix) {
    LockstepFalcon none;
    none.board().runs = false;
    EXPECT_TRUE(says(opening(none), {"FA-1", "no firmware", "fix: set device.firmware"}));
    LockstepFalcon wrong(path());
    wrong.board().runs = false;
    wrong.board().wrong_echo_at = 5;
    wrong.board().wrong_echoes = 100;
    EXPECT_TRUE(says(opening(wrong), {"echoes wrong firmware bytes", "fix:"}));
    EXPECT_EQ(wrong.board().wrong_echoes, 97U);
    LockstepFalcon dead(path());
    dead.board().runs = false;
    dead.board().hellos_missed = 1'000'000;
    EXPECT_TRUE(says(opening(dead), {"the boot loader does not answer", "power supply"}));
    LockstepFalcon stops(path());
    stops.board().runs = false;
    stops.board().mute = true;
    EXPECT_TRUE(says(opening(stops), {"stopped in the middle"}));
    LockstepFalcon other(path());
    other.board().runs = false;
    other.board().firmware.push_back(std::byte{0});  // the board expects one more byte
    EXPECT_TRUE(says(opening(other), {"accepted the firmware, but the firmware does not answer"}));
    LockstepFalcon stubborn(path());
    stubborn.board().refuses_settings = true;
    EXPECT_TRUE(says(opening(stubborn), {"serial converter does not accept its settings"}));
}

TEST_F(FalconBoot, a_missing_empty_or_too_large_file_is_an_error_before_bus_access) {
    write("empty.bin", {});
    write("large.bin", std::vector<std::byte>(falcon::kFirmwareBytesMax + 1));
    for (const auto& [name, why] :
         {std::pair{"missing.bin", "No such file"}, std::pair{"empty.bin", "the file is empty"},
          std::pair{"large.bin", "more than 131072 bytes"}}) {
        LockstepFalcon arm(path(name));
        EXPECT_TRUE(says(opening(arm), {name, why, "fix: set device.firmware"})) << name;
        EXPECT_EQ(arm.board().opens, 0U);
    }
    LockstepFalcon folder(folder_.string());
    EXPECT_TRUE(says(opening(folder), {"fix: set device.firmware"}));
    write("largest.bin", std::vector<std::byte>(falcon::kFirmwareBytesMax));
    EXPECT_EQ(falcon::read_firmware(path("largest.bin")).size(), falcon::kFirmwareBytesMax);
}

TEST_F(FalconBoot, bus_faults_are_reported_with_a_fix) {
    for (const auto& [fault, why] :
         {std::pair{BusFault::missing, "0403:cb48"}, std::pair{BusFault::several, "device.serial"},
          std::pair{BusFault::twins, "two devices have this serial number"},
          std::pair{BusFault::denied, "install.sh --rights"}, std::pair{BusFault::busy, "lsof"},
          std::pair{BusFault::failed, "dmesg"}}) {
        LockstepFalcon arm;
        arm.board().finding = fault;
        EXPECT_TRUE(says(opening(arm), {"opening the Falcon", why, "fix:"})) << why;
    }
}

TEST_F(FalconBoot, firmware_is_reloaded_after_replugging_and_after_a_jump) {
    LockstepFalcon arm(path());
    static_cast<void>(arm.open());
    arm.board().unplug();
    for (int i = 0; i < 10; ++i) arm.cycle({});
    arm.board().plug();
    for (int i = 0; i < 8000 && arm.news().link != Link::open; ++i) arm.cycle({});
    EXPECT_EQ(arm.news().link, Link::open);
    EXPECT_EQ(arm.board().loads, 1U);
    arm.board().push_through();
    for (int i = 0; i < 20; ++i) arm.cycle({});
    ASSERT_TRUE(arm.sample.hand_present);
    // After a jump the counts are invalid: the device restarts and must find its reference marks again.
    arm.board().shift = {500, 500, 500};
    for (int i = 0; i < 8000 && arm.board().loads < 2; ++i) arm.cycle({});
    for (int i = 0; i < 500; ++i) arm.cycle({});
    EXPECT_EQ(arm.board().loads, 2U);
    EXPECT_FALSE(arm.sample.hand_present);
    EXPECT_EQ(arm.sample.notice, DeviceNotice::move_about);
}

TEST_F(FalconBoot, a_failed_restart_is_retried_without_force) {
    LockstepFalcon arm;
    static_cast<void>(arm.open());
    arm.board().unplug();
    for (int i = 0; i < 10; ++i) arm.cycle({});
    arm.board().plug();  // now without firmware, and none is configured
    for (int i = 0; i < 4000; ++i) arm.cycle({.wrench_dev = {}, .enable = true});
    EXPECT_NE(arm.news().link, Link::open);
    EXPECT_EQ(arm.sample.notice, DeviceNotice::gone);
    arm.board().runs = true;  // another program loaded the firmware
    for (int i = 0; i < 4000 && arm.news().link != Link::open; ++i) arm.cycle({});
    EXPECT_EQ(arm.news().link, Link::open);
}

}  // namespace
}  // namespace tact::hal_falcon_boot_test
