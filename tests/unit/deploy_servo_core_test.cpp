// The core of the servo, and moving other processes off it.
#include "deploy/tact/servo_core.hpp"

#include <gtest/gtest.h>
#include <sched.h>
#include <sys/prctl.h>
#include <unistd.h>

#include <latch>
#include <thread>

#include "deploy/tact/child.hpp"

namespace tact::launch::deploy_servo_core_test {
namespace {

cpu_set_t cores_of(pid_t thread) {
    cpu_set_t cores;
    CPU_ZERO(&cores);
    EXPECT_EQ(sched_getaffinity(thread, sizeof cores, &cores), 0);
    return cores;
}

int last_of(const cpu_set_t& cores) {
    int last = -1;
    for (int c = 0; c < CPU_SETSIZE; ++c)
        if (CPU_ISSET(static_cast<std::size_t>(c), &cores)) last = c;
    return last;
}

TEST(ServoCore, is_the_core_of_the_pinned_servo_thread) {
    EXPECT_EQ(servo_core(getpid()), std::nullopt);
    const int core = last_of(cores_of(0));
    std::latch named(1), seen(1);
    std::thread servo([&] {
        prctl(PR_SET_NAME, "servo");
        cpu_set_t one;
        CPU_ZERO(&one);
        CPU_SET(static_cast<std::size_t>(core), &one);
        EXPECT_EQ(sched_setaffinity(0, sizeof one, &one), 0);
        named.count_down();
        seen.wait();
    });
    named.wait();
    EXPECT_EQ(servo_core(getpid()), core);
    seen.count_down();
    servo.join();
    EXPECT_EQ(servo_core(-1), std::nullopt);
}

TEST(ServoCore, a_servo_that_is_not_pinned_has_none) {
    const cpu_set_t mine = cores_of(0);
    if (CPU_COUNT(&mine) < 2) GTEST_SKIP() << "one core";
    std::latch named(1), seen(1);
    std::thread servo([&] {
        prctl(PR_SET_NAME, "servo");
        named.count_down();
        seen.wait();
    });
    named.wait();
    EXPECT_EQ(servo_core(getpid()), std::nullopt);
    seen.count_down();
    servo.join();
}

TEST(ServoCore, without_a_pinned_servo_others_keep_their_cores) {
    ChildSettings settings;
    settings.arguments = {"600"};
    const Child child("sleep", "/bin/sleep", settings);
    const cpu_set_t before = cores_of(child.pid());
    const int core = last_of(before);
    const bool several = CPU_COUNT(&before) > 1;
    EXPECT_EQ(keep_off_core(child.pid(), core), several ? 1 : 0);
    EXPECT_EQ(keep_off_core(child.pid(), core), 0);  // it is already off, or has no other core
    const cpu_set_t after = cores_of(child.pid());
    EXPECT_EQ(CPU_COUNT(&after), several ? CPU_COUNT(&before) - 1 : 1);
    EXPECT_EQ(CPU_ISSET(static_cast<std::size_t>(core), &after) != 0, !several);
    EXPECT_EQ(keep_off_core(child.pid(), -1), 0);
    EXPECT_EQ(keep_off_core(child.pid(), CPU_SETSIZE), 0);
    EXPECT_EQ(keep_off_core(-1, 0), 0);
}

}  // namespace
}  // namespace tact::launch::deploy_servo_core_test
