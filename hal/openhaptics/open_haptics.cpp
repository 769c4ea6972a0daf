// Values: the library reports force, stiffness and workspace. It does not report the position step; 0.055
// mm is the manufacturer's value for the Touch, the coarsest of these arms. Torque of an arm with six
// motors: 48 mN m, the continuous limit of the weakest of the Premium's three gimbal motors.
#include "hal/openhaptics/open_haptics.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "ipc/base/error.hpp"
#include "ipc/base/servo_clock.hpp"

namespace tact {

namespace {

constexpr double kPositionStepM = 5.5e-5;
constexpr double kTorqueMaxNM = 0.048;
constexpr unsigned long kRateHz = 1000;
constexpr Duration kLook = std::chrono::milliseconds(5);
// An estimate, since the library reports no times: the counts of a frame may be read one period of
// HD_UPDATE_RATE before the frame begins, and the force may reach the motors one period after the frame
// ends.
constexpr double kTransportPeriods = 2.0;

// The device's name, in printable ASCII.
std::string plain(const char* text, const char* otherwise) {
    std::string out;
    for (const char* c = text; c != nullptr && *c != '\0' && out.size() < 60; ++c)
        out += *c >= ' ' && *c <= '~' ? *c : '?';
    return out.empty() ? otherwise : out;
}

std::string hex(unsigned code) {
    char text[16];
    static_cast<void>(std::snprintf(text, sizeof text, "0x%X", code));
    return text;
}

}  // namespace

OpenHaptics::OpenHaptics(const OpenHapticsSettings& settings)
    : settings_(settings), own_clock_(std::make_unique<ServoClock>(Duration{0})), clock_(own_clock_.get()) {}

OpenHaptics::OpenHaptics(const OpenHapticsSettings& settings, Clock& clock)
    : settings_(settings), clock_(&clock) {}

OpenHaptics::~OpenHaptics() { close(); }

hd::Enum OpenHaptics::callback(void* self) noexcept {
    const OpenHaptics& it = *static_cast<OpenHaptics*>(self);
    return it.pump_->tick(it.clock_->now());
}

void OpenHaptics::close() noexcept {
    if (!library_) return;
    const hd::Api& api = library_->api();
    if (running_) {
        api.hdStopScheduler();
        api.hdUnschedule(scheduled_);
    }
    running_ = false;
    if (device_ != hd::kInvalidDevice) api.hdDisableDevice(device_);  // forces off
    device_ = hd::kInvalidDevice;
    pump_.reset();
}

void OpenHaptics::forget_errors() {
    for (int n = 0; n < 100 && library_->api().hdGetError().code != hd::kSuccess; ++n) {
    }
}

// Throws the newest error of the stack, if any, and clears the stack.
void OpenHaptics::check(const std::string& attempt) {
    const hd::Api& api = library_->api();
    const hd::ErrorInfo error = api.hdGetError();
    forget_errors();
    if (error.code == hd::kSuccess) return;
    throw StartupError(
        attempt,
        plain(api.hdGetErrorString(error.code), "unknown error") + " (" + hex(error.code) + ", " +
            std::to_string(error.internal) + " internal)",
        std::string(hd::meaning(error.code).fixes) +
            "; check that the manufacturer's set-up program lists the device (device.hd_device)");
}

DeviceInfo OpenHaptics::describe(hd::PumpSettings& settings) {
    const hd::Api& api = library_->api();
    std::array<double, 6> box_mm{};
    int dof = 3;
    DeviceInfo info;
    double stiffness_n_mm = 0.0;
    api.hdGetDoublev(hd::kUsableWorkspace, box_mm.data());
    api.hdGetDoublev(hd::kMaxForce, &info.force_n_max);
    api.hdGetDoublev(hd::kMaxContinuousForce, &info.force_n_continuous);
    api.hdGetDoublev(hd::kMaxStiffness, &stiffness_n_mm);
    api.hdGetIntegerv(hd::kOutputDof, &dof);
    api.hdGetIntegerv(hd::kCalibrationStyle, &settings.styles);
    info.name = plain(api.hdGetString(hd::kModelType), "haptic device") + " by OpenHaptics";
    info.serial = plain(api.hdGetString(hd::kSerialNumber), "");
    check("querying the haptic device");

    const Vec3 low = Eigen::Map<const Vec3>(box_mm.data()), high = Eigen::Map<const Vec3>(box_mm.data() + 3);
    const bool box = low.allFinite() && high.allFinite() && ((high - low).array() > 1.0).all() &&
                     low.cwiseAbs().maxCoeff() < 2000.0 && high.cwiseAbs().maxCoeff() < 2000.0;
    const bool force = std::isfinite(info.force_n_max) && info.force_n_max > 0.0 &&
                       info.force_n_max <= 100.0 && std::isfinite(info.force_n_continuous) &&
                       info.force_n_continuous >= 0.0;
    if (!box || !force || !std::isfinite(stiffness_n_mm) || stiffness_n_mm < 0.0 || stiffness_n_mm > 100.0)
        throw StartupError("querying the haptic device",
                           "the reported workspace, force or stiffness is not plausible",
                           "test the device in the manufacturer's diagnostic program; set device.hd_library "
                           "to the library that belongs to it");
    settings.centre_mm = 0.5 * (low + high);
    info.workspace_half_m = 0.5e-3 * (high - low);
    info.force_n_continuous = std::min(info.force_n_continuous, info.force_n_max);
    info.torque_n_m_max = dof >= 6 ? kTorqueMaxNM : 0.0;
    info.stiffness_n_m_max = 1e3 * stiffness_n_mm;
    info.position_step_m = kPositionStepM;
    settings.force_n_max = info.force_n_max;
    settings.torque_n_m_max = info.torque_n_m_max;
    return info;
}

// The library's own rate before its scheduler runs, else the requested rate.
double OpenHaptics::rate_hz() {
    const hd::Api& api = library_->api();
    int rate = 0;
    api.hdGetIntegerv(hd::kUpdateRate, &rate);
    forget_errors();  // a library that does not report the rate leaves one
    return rate >= 200 && rate <= 10000 ? rate : static_cast<double>(kRateHz);
}

void OpenHaptics::wait_for_first_sample() {
    const Instant begin = clock_->now();
    while (true) {
        const hd::Counts c = pump_->counts();
        DeviceSample sample;
        const bool sampled = pump_->read(sample, clock_->now()) != IoStatus::lost;
        if (c.last_kind != hd::FaultKind::none && hd::meaning(c.last_kind).ends)
            throw StartupError("starting the haptic device", hd::meaning(c.last_kind).says,
                               hd::meaning(c.last_kind).fixes);
        if (sampled) return;
        const Duration waited = clock_->now() - begin;
        if (waited > settings_.first_sample_max) {
            const std::string s = std::to_string(static_cast<long>(to_s(waited)));
            if (c.ticks == 0)
                throw StartupError(
                    "starting the haptic device", "the library started no cycle in " + s + " s",
                    "unplug the device and plug it in again; reduce the load of the processor");
            throw StartupError("starting the haptic device",
                               "the device delivered no usable position in " + s + " s (" +
                                   std::to_string(c.refused_samples) + " refused)",
                               "test the device in the manufacturer's diagnostic program");
        }
        clock_->wait_until(clock_->now() + kLook);
    }
}

DeviceInfo OpenHaptics::open() {
    close();
    if (!library_) library_.emplace(settings_.library);
    const hd::Api& api = library_->api();
    const std::string which = settings_.device.empty() ? "the default haptic device"
                                                       : "the haptic device \"" + settings_.device + "\"";
    const hd::Handle device = api.hdInitDevice(settings_.device.empty() ? nullptr : settings_.device.c_str());
    check("opening " + which);
    if (device == hd::kInvalidDevice)
        throw StartupError("opening " + which, "the library returned no device",
                           "set it up in the manufacturer's set-up program (device.hd_device)");
    device_ = device;
    try {
        api.hdMakeCurrentDevice(device_);
        hd::PumpSettings settings;
        const DeviceInfo info = describe(settings);
        api.hdDisable(hd::kForceOutput);
        api.hdDisable(hd::kForceRamping);
        api.hdEnable(hd::kMaxForceClamping);
        check("setting up " + which);
        pump_ = std::make_unique<hd::Pump>(api, device_);
        api.hdSetSchedulerRate(kRateHz);
        forget_errors();  // a library with a single rate keeps it
        settings.transport = Duration(std::llround(kTransportPeriods * 1e9 / rate_hz()));
        pump_->set(settings);
        scheduled_ = api.hdScheduleAsynchronous(&OpenHaptics::callback, this, hd::kPriorityMax);
        running_ = true;
        api.hdStartScheduler();
        wait_for_first_sample();
        return info;
    } catch (...) {
        close();
        throw;
    }
}

IoStatus OpenHaptics::read(DeviceSample& newest, Instant now) noexcept {
    return pump_ ? pump_->read(newest, now) : IoStatus::lost;
}

IoStatus OpenHaptics::write(const DeviceCommand& command, Instant /*now*/) noexcept {
    return pump_ ? pump_->write(command) : IoStatus::lost;
}

void OpenHaptics::relax() noexcept {
    if (pump_) pump_->relax();
}

hd::Counts OpenHaptics::counts() const noexcept { return pump_ ? pump_->counts() : hd::Counts{}; }

}  // namespace tact
