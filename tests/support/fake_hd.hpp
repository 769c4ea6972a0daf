// A substitute for the vendor's libHD.so: the same functions, an arm of 0.25 kg in oil, errors on demand.
//
// Time     lockstep: each tick() is one cycle of the scheduler, a millisecond for the arm; with
//          `threaded` set before hdStartScheduler a thread of its own runs the cycles
// Strict   unpaired frames, forces outside of a frame and calls without a device raise the library's own
//          errors; 302, 304, 400 and 401 end the scheduler, as in the real one
// Thread   all members that a test uses while cycles run are atomic
#pragma once

#include <array>
#include <atomic>

namespace tact {

struct FakeHd {
    void (*reset)() = nullptr;               // resets everything; no device open
    void (*tick)() = nullptr;                // one cycle
    void (*raise)(unsigned code) = nullptr;  // an error in the next frame
    bool threaded = false;
    const char* model = "Fake Arm";
    unsigned init_error = 0;  // of the next hdInitDevice
    int styles = 2, dof = 3;  // automatic; only force
    int rate_hz = 1000;       // that it reports; 0: it does not know the question
    double force_n_max = 3.3;
    bool never_calls = false;         // the scheduler calls nothing
    std::atomic<bool> always{false};  // the error of raise() persists
    std::atomic<bool> needs_update{false}, needs_manual{false};
    std::atomic<bool> no_rotation{false}, not_a_number{false};
    std::atomic<int> inkwell{0}, buttons{0};
    std::atomic<unsigned> updates{0}, inits{0};
    std::array<std::atomic<double>, 3> force_n{}, torque_mn_m{};  // current output of the motors
    std::array<std::atomic<double>, 3> position_mm{};
    std::atomic<bool> output{false}, ramping{true}, clamping{false}, running{false};
};

using FakeHdAccess = FakeHd* (*)();
inline constexpr const char* kFakeHdAccess = "fake_hd";

}  // namespace tact
