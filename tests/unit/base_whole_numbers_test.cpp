#include <gtest/gtest.h>

#include "ipc/base/whole_numbers.hpp"

namespace tact::base_whole_numbers_test {
namespace {

TEST(WholeNumbers, are_read_with_letters_between) {
    EXPECT_EQ(numbers_between("1280x720", "x"), (std::array{1280U, 720U}));
    EXPECT_EQ(numbers_between("0:256,10:90", ":,:"), (std::array{0U, 256U, 10U, 90U}));
    EXPECT_EQ(numbers_between("7", ""), (std::array{7U}));
    EXPECT_EQ(numbers_between("4294967295x0", "x"), (std::array{4294967295U, 0U}));
}

TEST(WholeNumbers, other_text_is_refused) {
    for (const char* const text :
         {"", "x", "1280", "1280x", "x720", "1280x720 ", " 1280x720", "1280 x720", "1280X720", "-1x720",
          "+1x720", "1280x-720", "1280x720x3", "12.5x720", "4294967296x1", "0x10x1", "nanx1"}) {
        EXPECT_FALSE(numbers_between(text, "x").has_value()) << text;
    }
    EXPECT_FALSE(numbers_between({"1x2\0", 4}, "x").has_value());
}

}  // namespace
}  // namespace tact::base_whole_numbers_test
