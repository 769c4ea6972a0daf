// The start of Force Dimension's arms: library, device, initialization, each with its message and fix.
#include <gtest/gtest.h>

#include "tests/support/forcedimension_driver.hpp"

namespace tact {
namespace {

TEST_F(ForceDimensionTest, a_missing_library_is_reported_with_the_source_and_the_key) {
    try {
        const fd::Library library("");
        GTEST_SKIP() << "the manufacturer's library is installed here: " << library.path();
    } catch (const StartupError& e) {
        EXPECT_TRUE(says(e.what(), {"libdrd.so", "libdhd.so", "/usr/local/lib/libdrd.so",
                                    "fix:", "forcedimension.com", "device.fd_library"}))
            << e.what();
    }
    settings.library = "/nowhere/libdrd.so";
    EXPECT_TRUE(says(refusal(), {"/nowhere/libdrd.so", "No such file", "device.fd_library"}));
}

TEST_F(ForceDimensionTest, an_old_library_is_refused_with_its_missing_function_or_version) {
    settings.library = TACT_FAKE_FD_OLD;
    EXPECT_TRUE(
        says(refusal(), {TACT_FAKE_FD_OLD, "no function dhdErrorGetLastStr", "fix:", "3.7 or newer"}));
    settings.library = TACT_FAKE_FD;
    fake().minor = 6;
    EXPECT_TRUE(says(refusal(), {"its version is 3.6.2", "supports 3.7", "fix:", "3.7 or newer"}));
    fake().major = 4;
    EXPECT_TRUE(says(refusal(), {"its version is 4.6.2"}));
    fake().reset();
    fake().minor = 7;
    EXPECT_EQ(refusal(), "it opened");
}

TEST_F(ForceDimensionTest, open_errors_are_reported_with_a_fix) {
    fake().count = 0;
    EXPECT_TRUE(says(refusal(), {"finds no device", "fix:", "--rights", "tact probe"}));
    fake().reset();
    fake().fail_count = fd::kErrorNoDriver;
    EXPECT_TRUE(says(refusal(), {"no communication", "error 4", "fix:", "cable"}));
    fake().reset();
    arm().busy = true;
    EXPECT_TRUE(says(
        refusal(), {"another program uses the device", "already in use", "error 20", "fix:", "HapticDesk"}));
    fake().reset();
    arm().type = 60;
    EXPECT_TRUE(says(refusal(), {"no limits for this model (type 60)", "driver = \"falcon\""}));
    EXPECT_FALSE(arm().open.load());
    fake().reset();
    fake().not_a_number = true;
    EXPECT_TRUE(says(refusal(), {"no usable position in 5 s", "HapticDesk"}));
    EXPECT_FALSE(arm().open.load());
    fake().reset();
    fake().fail_position = fd::kErrorCom;
    EXPECT_TRUE(says(refusal(), {"no communication", "fix:"}));
    fake().reset();
    settings.serial = "12x";
    EXPECT_TRUE(says(refusal(), {"device.serial = \"12x\"", "1 to 65535"}));
    settings.serial = "70000";
    EXPECT_TRUE(says(refusal(), {"1 to 65535"}));
    settings.serial = "0";
    EXPECT_TRUE(says(refusal(), {"1 to 65535"}));
}

TEST_F(ForceDimensionTest, of_several_devices_the_serial_number_chooses) {
    fake().count = 2;
    EXPECT_TRUE(says(refusal(), {"several devices", "1001, 1002", "device.serial"}));
    EXPECT_FALSE(fake().arms[0].open.load() || fake().arms[1].open.load());
    settings.serial = "1002";
    open();
    EXPECT_EQ(info.serial, "1002");
    EXPECT_FALSE(fake().arms[0].open.load());
    // A second driver of this process takes the other, and never the same.
    ForceDimensionSettings other = fd_settings();
    ForceDimension second(other, clock);
    EXPECT_EQ(second.open().serial, "1001");
    EXPECT_TRUE(fake().arms[1].open.load());
    ForceDimension third(other, clock);
    EXPECT_THROW(static_cast<void>(third.open()), StartupError);
    EXPECT_TRUE(fake().arms[0].open.load() && fake().arms[1].open.load());
    clock.device = nullptr;
    device.reset();
    settings.serial = "7";
    EXPECT_TRUE(says(refusal(), {"no free device with this serial number", "1002", "device.serial"}));
}

TEST_F(ForceDimensionTest, an_arm_that_is_not_initialized_never_moves_unasked) {
    arm().initialized = false;
    EXPECT_TRUE(says(refusal(), {"not initialized", "fix:", "HapticInit", "device.fd_initialize = true"}));
    EXPECT_EQ(arm().auto_inits.load(), 0U);
    EXPECT_FALSE(arm().open.load());  // so that HapticInit can open it
    settings.initialize = true;
    said().clear();
    open();
    EXPECT_EQ(arm().auto_inits.load(), 1U);
    EXPECT_TRUE(says(said(), {"moves by itself", "let go"})) << said();
    EXPECT_FALSE(arm().force.load());  // the library's own control has ended
    EXPECT_FALSE(arm().regulated.load());
    power();
    open();
    EXPECT_EQ(arm().auto_inits.load(), 1U);  // it is initialized already
    arm().initialized = false;
    arm().auto_init_result = -1;
    EXPECT_TRUE(says(refusal(), {"the initialization failed", "error 7", "fix:", "let go"}));
    EXPECT_FALSE(arm().force.load() || arm().regulated.load());
}

TEST_F(ForceDimensionTest, libdhd_alone_knows_the_initialization_and_cannot_do_it) {
    FakeFd& other = fake_fd_of(TACT_FAKE_FD_DHD);
    other.reset();
    settings.library = TACT_FAKE_FD_DHD;
    open();
    EXPECT_EQ(info.name, "Force Dimension omega.3");
    for (const bool wrist : {false, true}) {
        other.reset();
        other.arms[0].wrist = wrist;
        other.arms[0].type = wrist ? 34 : 33;
        other.arms[0].initialized = false;
        settings.initialize = false;
        EXPECT_TRUE(says(refusal(), {"not initialized", "HapticInit"}));
        settings.initialize = true;
        EXPECT_TRUE(says(refusal(), {"libdhd cannot initialize", "fix:", "libdrd.so"}));
        EXPECT_FALSE(other.arms[0].open.load());
    }
}

}  // namespace
}  // namespace tact
