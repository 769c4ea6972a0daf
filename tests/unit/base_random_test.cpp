// The random numbers, against values from a program of its own in Python: the same with every compiler.
#include <gtest/gtest.h>

#include "ipc/base/random.hpp"

namespace tact::base_random_test {
namespace {

TEST(SeededRandom, numbers_are_those_of_splitmix64) {
    SeededRandom random(1);
    EXPECT_EQ(random.next(), 0x910a2dec89025cc1U);
    EXPECT_EQ(random.next(), 0xbeeb8da1658eec67U);
}

TEST(SeededRandom, a_vector_draws_its_direction_before_its_length) {
    const Vec3 v = SeededRandom(1).within(2.0);
    EXPECT_NEAR(v.x(), -0.051006826601287795, 1e-14);
    EXPECT_NEAR(v.y(), -1.924044712880352, 1e-14);
    EXPECT_NEAR(v.z(), 0.25852589110143714, 1e-14);
}

}  // namespace
}  // namespace tact::base_random_test
