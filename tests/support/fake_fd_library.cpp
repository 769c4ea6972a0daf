#include "tests/support/fake_fd.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "hal/forcedimension/fd_api.hpp"

namespace {

using namespace tact;
using namespace tact::fd;

constexpr double kFdStepS = 1e-3, kFdMassKg = 0.25, kFdDampingNSM = 5.0;

thread_local int last_error = kNoError;

FakeFd& fake() {
    static FakeFd f;
    return f;
}

int failed(int code) {
    last_error = code;
    return -1;
}

// True: this call fails, once.
bool demanded(std::atomic<int>& code) {
    const int now = fake().always.load() ? code.load() : code.exchange(0);
    if (now == 0) return false;
    last_error = now;
    return true;
}

FakeFdArm* arm_of(char id) {
    if (id < 0 || id >= FakeFd::kArms || !fake().arms[static_cast<std::size_t>(id)].open.load()) {
        last_error = 15;  // invalid index
        return nullptr;
    }
    FakeFdArm& a = fake().arms[static_cast<std::size_t>(id)];
    if (!a.plugged.load()) {
        last_error = kErrorCom;
        return nullptr;
    }
    return &a;
}

void off(FakeFdArm& a, int cause) {
    a.force = false;
    a.force_off_cause = cause;
    for (std::size_t i = 0; i < 3; ++i) a.force_n[i] = a.torque_n_m[i] = 0.0;
    a.gripper_n = 0.0;
}

void tick_arm(FakeFdArm& a) {
    if (!a.plugged.load()) off(a, kForceOffUsb);
    const int watchdog = a.watchdog_eighths.load();
    if (a.force.load() && watchdog > 0 && 8 * ++a.silent_ms > watchdog) off(a, kForceOffWatchdog);
    for (std::size_t i = 0; i < 3; ++i) {
        double v = a.velocity_m_s[i].load();
        v += kFdStepS * (a.force_n[i].load() - kFdDampingNSM * v) / kFdMassKg;
        a.velocity_m_s[i].store(v);
        a.position_m[i].store(a.position_m[i].load() + kFdStepS * v);
    }
}

void tick() {
    for (FakeFdArm& a : fake().arms) tick_arm(a);
}

void reset_arm(FakeFdArm& a, unsigned short serial) {
    a.type = 33;
    a.serial = serial;
    a.wrist = a.torque = a.gripper = a.left = a.busy = a.no_watchdog = a.no_gravity_call = false;
    a.auto_init_result = 0;
    a.initialized = a.plugged = a.gravity = true;
    a.force = a.brakes = a.open = a.regulated = false;
    a.force_off_cause = a.controller_error = a.watchdog_eighths = a.silent_ms = 0;
    a.turn = {{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}};
    for (std::size_t i = 0; i < 3; ++i)
        a.position_m[i] = a.velocity_m_s[i] = a.angular_rad_s[i] = a.force_n[i] = a.torque_n_m[i] = 0.0;
    a.gripper_n = 0.0;
    a.gripper_rad = 0.5;
    a.buttons = a.opens = a.auto_inits = a.stops = 0;
    a.linear_window_ms = 20;
    a.time_guard_us = 0;
}

void reset() {
    FakeFd& f = fake();
    f.count = 1;
    for (std::size_t i = 0; i < f.arms.size(); ++i)
        reset_arm(f.arms[i], static_cast<unsigned short>(1001 + i));
    f.major = 3;
    f.minor = 16;
    f.fail_position = f.fail_force = f.fail_status = f.fail_velocity = f.fail_count = f.fail_enable = 0;
    f.threaded = f.always = f.not_a_number = f.no_rotation = f.guarded = f.saturated = f.expert = false;
    f.com_khz = 2.0;
}

int open_index(char index) {
    if (index < 0 || index >= fake().count) return failed(15);
    FakeFdArm& a = fake().arms[static_cast<std::size_t>(index)];
    if (!a.plugged.load()) return failed(kErrorNoDevice);
    if (a.busy) return failed(kErrorInUse);
    if (!a.open.load()) ++a.opens;
    a.open = true;
    return index;
}

int close_arm(char id) {
    if (id < 0 || id >= FakeFd::kArms) return failed(15);
    FakeFdArm& a = fake().arms[static_cast<std::size_t>(id)];
    off(a, kForceOffSoftware);
    a.open = false;
    return 0;
}

int triple(char id, const std::array<std::atomic<double>, 3>& from, double* x, double* y, double* z) {
    static_cast<void>(id);
    *x = from[0].load();
    *y = from[1].load();
    *z = from[2].load();
    return 0;
}

int position_of(char id, double* x, double* y, double* z) {
    FakeFdArm* const a = arm_of(id);
    if (a == nullptr || demanded(fake().fail_position)) return -1;
    triple(id, a->position_m, x, y, z);
    if (fake().not_a_number.load()) *y = std::numeric_limits<double>::quiet_NaN();
    return fake().guarded.load() ? kTimeGuard : 0;
}

}  // namespace

extern "C" {

tact::FakeFd* fake_fd() {
    fake().reset = &reset;
    fake().tick = &tick;
    return &fake();
}

int dhdErrorGetLast() { return last_error; }
const char* dhdErrorGetLastStr() {
    return last_error == kErrorInUse ? "device already in use" : "fake\x1b[2J error";
}
void dhdGetSDKVersion(int* major, int* minor, int* release, int* revision) {
    *major = fake().major;
    *minor = fake().minor;
    *release = 2;
    *revision = 99;
}
int dhdGetDeviceCount() {
    if (demanded(fake().fail_count)) return -1;
    int n = fake().count;
    if (n == 1 && !fake().arms[0].plugged.load()) n = 0;
    return n;
}
int dhdOpenID(char index) { return open_index(index); }
int dhdClose(char id) { return close_arm(id); }
int dhdStop(char id) {
    FakeFdArm* const a = arm_of(id);
    if (a == nullptr) return -1;
    ++a->stops;
    off(*a, kForceOffSoftware);
    a->brakes = true;
    return 0;
}
int dhdGetSystemType(char id) {
    const FakeFdArm* const a = arm_of(id);
    return a == nullptr ? -1 : a->type;
}
const char* dhdGetSystemName(char id) { return arm_of(id) == nullptr ? nullptr : "fake"; }
int dhdGetSerialNumber(unsigned short* serial, char id) {
    const FakeFdArm* const a = arm_of(id);
    if (a == nullptr) return -1;
    if (a->serial == 0) return failed(kErrorNotAvailable);
    *serial = a->serial;
    return 0;
}
int dhdGetStatus(int* status, char id) {
    const FakeFdArm* const a = arm_of(id);
    if (a == nullptr || demanded(fake().fail_status)) return -1;
    std::fill_n(status, 17, 0);
    status[kStatusPower] = status[kStatusConnected] = status[2] = 1;
    status[kStatusReset] = a->initialized.load() ? 0 : 1;
    status[kStatusForce] = a->force.load() ? 1 : 0;
    status[6] = a->brakes.load() ? 1 : 0;
    status[kStatusWristDetected] = a->wrist ? 1 : 0;
    status[kStatusWristInit] = a->wrist && a->initialized.load() ? 1 : 0;
    status[kStatusError] = a->controller_error.load();
    status[kStatusForceOffCause] = a->force_off_cause.load();
    return 0;
}
bool dhdIsLeftHanded(char id) {
    const FakeFdArm* const a = arm_of(id);
    return a != nullptr && a->left;
}
bool dhdHasWrist(char id) {
    const FakeFdArm* const a = arm_of(id);
    return a != nullptr && a->wrist;
}
bool dhdHasActiveWrist(char id) {
    const FakeFdArm* const a = arm_of(id);
    return a != nullptr && a->torque;
}
bool dhdHasGripper(char id) {
    const FakeFdArm* const a = arm_of(id);
    return a != nullptr && a->gripper;
}
int dhdEnableExpertMode() {
    fake().expert = true;
    return 0;
}
int dhdSetTimeGuard(int microseconds, char id) {
    FakeFdArm* const a = arm_of(id);
    if (a == nullptr) return -1;
    if (!fake().expert.load()) return failed(kErrorExpertMode);
    a->time_guard_us = microseconds;
    return 0;
}
int dhdSetWatchdog(unsigned char eighths_of_a_ms, char id) {
    FakeFdArm* const a = arm_of(id);
    if (a == nullptr) return -1;
    if (!fake().expert.load()) return failed(kErrorExpertMode);
    if (a->no_watchdog) return failed(kErrorNotAvailable);
    a->watchdog_eighths = eighths_of_a_ms;
    return 0;
}
int dhdSetGravityCompensation(int on, char id) {
    FakeFdArm* const a = arm_of(id);
    if (a == nullptr) return -1;
    if (a->no_gravity_call) return failed(kErrorNotAvailable);
    a->gravity = on != 0;
    return 0;
}
int dhdSetBrakes(int on, char id) {
    FakeFdArm* const a = arm_of(id);
    if (a == nullptr) return -1;
    a->brakes = on != 0;
    return 0;
}
int dhdEnableForce(unsigned char on, char id) {
    FakeFdArm* const a = arm_of(id);
    if (a == nullptr || (on != 0 && demanded(fake().fail_enable))) return -1;
    if (on == 0) {
        off(*a, kForceOffSoftware);
    } else {
        a->force = true;
        a->silent_ms = 0;
    }
    return 0;
}
int dhdConfigLinearVelocity(int ms, int /*mode*/, char id) {
    FakeFdArm* const a = arm_of(id);
    if (a == nullptr) return -1;
    a->linear_window_ms = ms;
    return 0;
}
int dhdConfigAngularVelocity(int /*ms*/, int /*mode*/, char id) { return arm_of(id) == nullptr ? -1 : 0; }
int dhdGetPosition(double* px, double* py, double* pz, char id) { return position_of(id, px, py, pz); }
int dhdGetPositionAndOrientationFrame(double* px, double* py, double* pz, double (*r)[3], char id) {
    const FakeFdArm* const a = arm_of(id);
    if (a == nullptr) return -1;
    if (!a->wrist) return failed(kErrorNotAvailable);
    for (std::size_t i = 0; i < 3; ++i)
        for (std::size_t j = 0; j < 3; ++j) r[i][j] = a->turn[i][j];
    if (fake().no_rotation.load()) r[1][1] += 0.1;
    return position_of(id, px, py, pz);
}
int dhdGetLinearVelocity(double* vx, double* vy, double* vz, char id) {
    const FakeFdArm* const a = arm_of(id);
    if (a == nullptr || demanded(fake().fail_velocity)) return -1;
    triple(id, a->velocity_m_s, vx, vy, vz);
    return kTimeGuard;
}
int dhdGetAngularVelocityRad(double* wx, double* wy, double* wz, char id) {
    const FakeFdArm* const a = arm_of(id);
    if (a == nullptr) return -1;
    if (!a->wrist) return failed(kErrorNotAvailable);
    triple(id, a->angular_rad_s, wx, wy, wz);
    return kTimeGuard;
}
int dhdGetGripperAngleRad(double* angle, char id) {
    const FakeFdArm* const a = arm_of(id);
    if (a == nullptr) return -1;
    if (!a->gripper) return failed(kErrorNotAvailable);
    *angle = a->left ? -a->gripper_rad.load() : a->gripper_rad.load();
    return kTimeGuard;
}
unsigned dhdGetButtonMask(char id) {
    const FakeFdArm* const a = arm_of(id);
    return a == nullptr ? 0 : a->buttons.load();
}
double dhdGetComFreq(char id) { return arm_of(id) == nullptr ? 0.0 : fake().com_khz.load(); }
int dhdSetForceAndTorqueAndGripperForce(double fx, double fy, double fz, double tx, double ty, double tz,
                                        double gripper, char id) {
    FakeFdArm* const a = arm_of(id);
    if (a == nullptr || demanded(fake().fail_force)) return -1;
    a->silent_ms = 0;
    const bool shown = a->force.load() && !a->brakes.load();
    const std::array<double, 3> f{fx, fy, fz}, t{tx, ty, tz};
    for (std::size_t i = 0; i < 3; ++i) {
        a->force_n[i] = shown ? f[i] : 0.0;
        a->torque_n_m[i] = shown && a->torque ? t[i] : 0.0;
    }
    a->gripper_n = shown ? gripper : 0.0;
    if (fake().threaded.load()) tick_arm(*a);
    return fake().saturated.load() ? kMotorSaturated : 0;
}

#ifndef TACT_FAKE_FD_WITHOUT_DRD
int drdOpenID(char index) { return open_index(index); }
int drdClose(char id) { return close_arm(id); }
bool drdIsInitialized(char id) {
    const FakeFdArm* const a = arm_of(id);
    return a != nullptr && a->initialized.load();
}
int drdAutoInit(char id) {
    FakeFdArm* const a = arm_of(id);
    if (a == nullptr) return -1;
    ++a->auto_inits;
    a->force = a->regulated = true;  // its own control moves the arm
    if (a->auto_init_result < 0) return failed(kErrorTimeout);
    a->initialized = true;
    return 0;
}
int drdStop(bool force, char id) {
    FakeFdArm* const a = arm_of(id);
    if (a == nullptr) return -1;
    a->regulated = false;
    if (!force) off(*a, kForceOffSoftware);
    return 0;
}
#endif
}
