// A substitute for the Force Dimension library: the same functions, arms of 0.25 kg in oil, errors on demand.
//
// Time     lockstep: each tick() is a millisecond for the arms; or its own thread's, with `threaded`
// Strict   a call with a wrong ID, or for experts without expert mode, fails as in the real library; a force
//          reaches the motors only while the output is on and the brakes are off; the device's own watchdog
//          switches it off
// Frame    the manufacturer's: x to the user, y right, z up
// Thread   all members that a test uses while a pump runs are atomic
#pragma once

#include <array>
#include <atomic>

namespace tact {

struct FakeFdArm {
    int type = 33;  // omega.3
    unsigned short serial = 0;
    bool wrist = false, torque = false, gripper = false, left = false;
    bool busy = false;         // used by another program
    bool no_watchdog = false;  // older firmware
    int auto_init_result = 0;
    std::atomic<bool> initialized{true}, plugged{true};
    std::atomic<bool> force{false}, brakes{false}, open{false};
    std::atomic<bool> regulated{false};  // the library's own control of the position runs
    std::atomic<int> force_off_cause{0}, controller_error{0};
    std::array<std::atomic<double>, 3> position_m{}, velocity_m_s{}, angular_rad_s{};
    std::array<std::array<double, 3>, 3> turn{{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}};
    std::array<std::atomic<double>, 3> force_n{}, torque_n_m{};  // that the motors exert
    std::atomic<double> gripper_n{0.0}, gripper_rad{0.5};
    std::atomic<unsigned> buttons{0};
    std::atomic<int> watchdog_eighths{0}, silent_ms{0};
    std::atomic<unsigned> opens{0}, auto_inits{0}, stops{0};
    std::atomic<bool> gravity{true};
    bool no_gravity_call = false;  // refuses to switch its gravity compensation
    int linear_window_ms = 20;
    int time_guard_us = 0;
};

struct FakeFd {
    static constexpr int kArms = 3;

    void (*reset)() = nullptr;  // one omega.3; nothing open
    void (*tick)() = nullptr;
    int count = 1;  // devices on the bus
    std::array<FakeFdArm, kArms> arms;
    int major = 3, minor = 16;
    std::atomic<bool> threaded{false};  // time is that of the calls
    // Error codes of the next calls; 0: none.
    std::atomic<int> fail_position{0}, fail_force{0}, fail_status{0}, fail_velocity{0}, fail_count{0},
        fail_enable{0};
    std::atomic<bool> always{false};  // these errors persist
    std::atomic<bool> not_a_number{false}, no_rotation{false}, guarded{false}, saturated{false};
    std::atomic<double> com_khz{2.0};
    std::atomic<bool> expert{false};
};

using FakeFdAccess = FakeFd* (*)();
inline constexpr const char* kFakeFdAccess = "fake_fd";

}  // namespace tact
