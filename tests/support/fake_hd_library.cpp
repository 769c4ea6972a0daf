#include "tests/support/fake_hd.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <limits>
#include <mutex>
#include <thread>
#include <vector>

#include "hal/openhaptics/hd_api.hpp"

namespace {

using namespace tact;
using namespace tact::hd;

constexpr double kStepS = 1e-3, kMassKg = 0.25, kDampingNSM = 5.0;
constexpr Handle kDevice = 7;

FakeHd& fake() {
    static FakeHd f;
    return f;
}

struct Arm {
    std::mutex stack_lock;
    std::vector<unsigned> stack;
    unsigned next_error = 0;
    std::atomic<bool> dead{false};
    bool open = false, frame = false;
    std::array<double, 3> wanted_n{}, wanted_mn_m{}, speed_mm_s{};
    Callback callback = nullptr;
    void* data = nullptr;
    std::thread thread;
};

Arm& arm() {
    static Arm a;
    return a;
}

void push(unsigned code) {
    const std::lock_guard guard(arm().stack_lock);
    arm().stack.push_back(code);
    if (code == kCommunication || code == kTimer || code == kIllegalBegin || code == kIllegalEnd)
        arm().dead.store(true);
}

void raise(unsigned code) {
    const std::lock_guard guard(arm().stack_lock);
    arm().next_error = code;
}

void move() {
    for (std::size_t i = 0; i < 3; ++i) {
        const double force_n = fake().output.load() ? arm().wanted_n[i] : 0.0;
        fake().force_n[i].store(force_n);
        fake().torque_mn_m[i].store(fake().output.load() ? arm().wanted_mn_m[i] : 0.0);
        double& v = arm().speed_mm_s[i];
        v += kStepS * (1e3 * force_n - kDampingNSM * v) / kMassKg;
        fake().position_mm[i].store(fake().position_mm[i].load() + kStepS * v);
    }
}

void tick() {
    Arm& a = arm();
    if (!fake().running.load() || a.dead.load() || a.callback == nullptr || fake().never_calls) return;
    if (a.callback(a.data) != kCallbackContinue) a.callback = nullptr;
    move();
}

void stop() {
    fake().running.store(false);
    if (arm().thread.joinable()) arm().thread.join();
}

void reset() {
    stop();
    FakeHd& f = fake();
    Arm& a = arm();
    const std::lock_guard guard(a.stack_lock);
    a.stack.clear();
    a.next_error = 0;
    a.dead = a.open = a.frame = false;
    a.wanted_n = a.wanted_mn_m = a.speed_mm_s = {};
    a.callback = nullptr;
    f.threaded = f.never_calls = false;
    f.model = "Fake Arm";
    f.init_error = 0;
    f.styles = kStyleAutomatic;
    f.dof = 3;
    f.rate_hz = 1000;
    f.force_n_max = 3.3;
    f.always = f.needs_update = f.needs_manual = f.no_rotation = f.not_a_number = false;
    f.inkwell = f.buttons = 0;
    f.updates = f.inits = 0;
    f.output = f.clamping = false;
    f.ramping = true;
    for (std::size_t i = 0; i < 3; ++i) f.force_n[i] = f.torque_mn_m[i] = f.position_mm[i] = 0.0;
}

std::atomic<bool>* capability(Enum name) {
    if (name == kForceOutput) return &fake().output;
    if (name == kForceRamping) return &fake().ramping;
    if (name == kMaxForceClamping) return &fake().clamping;
    push(kInvalidEnum);
    return nullptr;
}

bool usable() {
    if (!arm().open) push(kBadHandle);
    return arm().open;
}

}  // namespace

extern "C" {

tact::FakeHd* fake_hd() {
    FakeHd& f = fake();
    f.reset = &reset;
    f.tick = &tick;
    f.raise = &raise;
    return &f;
}

Handle hdInitDevice(const char* /*name*/) {
    ++fake().inits;
    if (fake().init_error != 0) {
        push(fake().init_error);
        return kInvalidDevice;
    }
    arm().open = true;
    arm().dead = false;
    return kDevice;
}
void hdDisableDevice(Handle /*device*/) {
    arm().open = false;
    fake().output = false;
    move();
}
void hdMakeCurrentDevice(Handle device) {
    if (device != kDevice) push(kBadHandle);
}
void hdBeginFrame(Handle /*device*/) {
    if (!usable()) return;
    if (arm().frame) push(kIllegalBegin);
    arm().frame = true;
    unsigned next = 0;
    {
        const std::lock_guard guard(arm().stack_lock);
        next = arm().next_error;
        if (!fake().always.load()) arm().next_error = 0;
    }
    if (next != 0) push(next);
}
void hdEndFrame(Handle /*device*/) {
    if (!arm().frame) push(kIllegalEnd);
    arm().frame = false;
}
ErrorInfo hdGetError() {
    const std::lock_guard guard(arm().stack_lock);
    if (arm().stack.empty()) return {kSuccess, 0, kDevice};
    const unsigned code = arm().stack.back();
    arm().stack.pop_back();
    return {code, 1, kDevice};
}
const char* hdGetErrorString(Enum code) { return code == kInvalidLicense ? "no licence" : "fake error"; }
void hdEnable(Enum name) {
    if (std::atomic<bool>* const c = capability(name)) *c = true;
}
void hdDisable(Enum name) {
    if (std::atomic<bool>* const c = capability(name)) *c = false;
}
void hdGetBooleanv(Enum name, Boolean* value) {
    if (name != kInkwellSwitch) return push(kInvalidEnum);
    *value = fake().inkwell.load() != 0 ? 1 : 0;
}
void hdGetIntegerv(Enum name, int* value) {
    if (!usable()) return;
    if (name == kButtons) {
        *value = fake().buttons.load();
    } else if (name == kOutputDof) {
        *value = fake().dof;
    } else if (name == kCalibrationStyle) {
        *value = fake().styles;
    } else if (name == kUpdateRate && fake().rate_hz != 0) {
        *value = fake().rate_hz;
    } else {
        push(kInvalidEnum);
    }
}
void hdGetDoublev(Enum name, double* values) {
    if (!usable()) return;
    const std::array<double, 6> box{-80, -50, -30, 80, 70, 40};
    if (name == kUsableWorkspace) {
        std::copy(box.begin(), box.end(), values);
    } else if (name == kMaxForce) {
        *values = fake().force_n_max;
    } else if (name == kMaxContinuousForce) {
        *values = 0.88;
    } else if (name == kMaxStiffness) {
        *values = 0.5;
    } else if (name == kVelocity) {
        std::copy(arm().speed_mm_s.begin(), arm().speed_mm_s.end(), values);
    } else if (name == kAngularVelocity) {
        std::fill_n(values, 3, 0.25);
    } else if (name == kTransform) {
        // A quarter turn about y: x of the tool is -z of the device. Column-major.
        const std::array<double, 16> t{0, 0, -1, 0, 0, 1, 0, 0, 1, 0, 0, 0, 0, 0, 0, 1};
        std::copy(t.begin(), t.end(), values);
        if (fake().no_rotation.load()) values[5] = 1.1;
        for (std::size_t i = 0; i < 3; ++i) values[12 + i] = fake().position_mm[i].load();
        if (fake().not_a_number.load()) values[12] = std::numeric_limits<double>::quiet_NaN();
    } else {
        push(kInvalidEnum);
    }
}
void hdSetDoublev(Enum name, const double* values) {
    if (!arm().frame) return push(kFrameError);
    if (name == kForce) {
        std::copy_n(values, 3, arm().wanted_n.begin());
    } else if (name == kTorque && fake().dof == 6) {
        std::copy_n(values, 3, arm().wanted_mn_m.begin());
    } else {
        push(kInvalidEnum);
    }
}
const char* hdGetString(Enum name) { return name == kModelType ? fake().model : "F-1"; }
Enum hdCheckCalibration() {
    if (fake().needs_manual.load()) return kCalibrationNeedsManualInput;
    return fake().needs_update.load() ? kCalibrationNeedsUpdate : kCalibrationOk;
}
void hdUpdateCalibration(Enum /*style*/) {
    ++fake().updates;
    fake().needs_update = fake().needs_manual = false;
}
void hdStartScheduler() {
    fake().running = true;
    if (!fake().threaded) return;
    arm().thread = std::thread([] {
        while (fake().running.load()) {
            tick();
            std::this_thread::sleep_for(std::chrono::milliseconds(1));
        }
    });
}
void hdStopScheduler() { stop(); }
void hdSetSchedulerRate(unsigned long /*rate_hz*/) {}
SchedulerHandle hdScheduleAsynchronous(Callback callback, void* data, unsigned short /*priority*/) {
    arm().callback = callback;
    arm().data = data;
    return 1;
}
void hdUnschedule(SchedulerHandle /*handle*/) { arm().callback = nullptr; }
}
