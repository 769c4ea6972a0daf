#include <gtest/gtest.h>

#include <cstring>
#include <string>

#include "ipc/base/error.hpp"

namespace tact::base_error_test {
namespace {

TEST(StartupError, states_problem_cause_and_fix) {
    EXPECT_STREQ(StartupError("read a.ply", "it has no faces", "export a surface").what(),
                 "read a.ply: it has no faces\n  fix: export a surface");
}

TEST(StartupError, text_from_a_file_cannot_end_the_message_or_control_a_terminal) {
    const std::string name("x\0y\x1b[31m\r\x7f", 10);
    const StartupError error("read a.ply", "element \"" + name + "\"\nin line 3: µ", "fix the file");
    EXPECT_STREQ(error.what(), "read a.ply: element \"x?y?[31m??\"\nin line 3: µ\n  fix: fix the file");
}

}  // namespace
}  // namespace tact::base_error_test
