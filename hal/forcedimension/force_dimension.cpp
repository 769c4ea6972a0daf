#include "hal/forcedimension/force_dimension.hpp"

#include <pthread.h>

#include <charconv>
#include <cstdio>

#include "hal/forcedimension/fd_refusal.hpp"
#include "ipc/base/error.hpp"
#include "ipc/base/quiet_thread.hpp"
#include "ipc/base/servo_clock.hpp"

namespace tact {

namespace {

constexpr Duration kFdLook = std::chrono::milliseconds(5);

unsigned short serial_number(const std::string& text) {
    if (text.empty()) return 0;
    unsigned short serial = 0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), serial);
    if (error != std::errc{} || end != text.data() + text.size() || serial == 0)
        throw StartupError("device.serial = \"" + text + "\" with driver \"forcedimension\"",
                           "the serial number of such a device is a number from 1 to 65535",
                           "correct device.serial, or remove it if only one device is connected");
    return serial;
}

}  // namespace

ForceDimension::ForceDimension(const ForceDimensionSettings& settings)
    : settings_(settings), own_clock_(std::make_unique<ServoClock>(Duration{0})), clock_(own_clock_.get()) {}

ForceDimension::ForceDimension(const ForceDimensionSettings& settings, Clock& clock)
    : settings_(settings), clock_(&clock) {}

ForceDimension::~ForceDimension() { close(); }

void ForceDimension::close() noexcept {
    leave_.store(true, std::memory_order_relaxed);
    if (thread_.joinable()) thread_.join();
    if (pump_) pump_->finish();
    pump_.reset();
    session_.reset();  // after its pump
}

void ForceDimension::say(const std::string& text) const {
    if (settings_.say != nullptr) return settings_.say(text.c_str());
    std::fprintf(stderr, "%s\n", text.c_str());
}

DeviceInfo ForceDimension::open() {
    close();
    const unsigned short serial = serial_number(settings_.serial);
    if (!library_) library_.emplace(settings_.library);
    session_.emplace(library_->api(), fd::SessionSettings{.serial = serial, .gravity = settings_.gravity});
    if (settings_.initialize)
        say("device.fd_initialize: the arm moves by itself if it is not initialized; let go of it");
    if (const fd::OpenResult result = session_->open(settings_.initialize);
        result.failure != fd::OpenFailure::none) {
        session_.reset();
        fd::refuse_open(result, library_->api(), settings_.serial);
    }
    if (!session_->own_watchdog())
        say("the device has no watchdog of its own: only Tact's watchdog of 10 ms removes the force");
    if (settings_.gravity && session_->gravity_set())
        say("device.fd_gravity: the library holds the weight of the arm with a force that passes none of "
            "Tact's limits");
    if (!session_->gravity_set())
        say(settings_.gravity ? "device.fd_gravity: the library does not hold the weight of this arm"
                              : "the library did not confirm that its gravity compensation is off: it may "
                                "add a force that passes none of Tact's limits; fix: switch it off in the "
                                "manufacturer's programs, or update the SDK");
    pump_ = std::make_unique<fd::Pump>(library_->api(), *session_);
    DeviceInfo info = describe();
    try {
        wait_for_first_sample();
        if (settings_.thread) {
            leave_.store(false, std::memory_order_relaxed);
            thread_ = start_quiet_thread([this] { run(); });
            const std::string refused = raise_to_fifo(
                thread_.native_handle(), "the thread of the haptic device", settings_.pump_priority);
            if (!refused.empty()) say(refused);
        }
    } catch (...) {
        close();
        throw;
    }
    return info;
}

DeviceInfo ForceDimension::describe() const {
    const fd::Model& m = session_->model();
    DeviceInfo info;
    info.name = std::string("Force Dimension ") + m.name;
    info.serial = session_->serial() == 0 ? "" : std::to_string(session_->serial());
    info.workspace_half_m = Vec3(m.radius_m, m.radius_m, fd::kDepthShare * m.radius_m);
    info.force_n_max = m.force_n_max;
    info.force_n_continuous = fd::kContinuousShare * m.force_n_max;
    info.torque_n_m_max = session_->torque() ? m.torque_n_m_max : 0.0;
    info.stiffness_n_m_max = m.stiffness_n_m_max;
    info.position_step_m = m.step_m;
    return info;
}

void ForceDimension::wait_for_first_sample() {
    const Instant begin = clock_->now();
    DeviceSample sample;
    while (true) {
        pump_->round(clock_->now());
        if (pump_->read(sample, clock_->now()) == IoStatus::ok) return;
        const fd::Counts c = pump_->counts();
        if (!session_->is_open())
            throw StartupError("starting the haptic device", fd::meaning(c.last_kind).says,
                               fd::meaning(c.last_kind).fixes);
        if (clock_->now() - begin > settings_.first_sample_max)
            throw StartupError("starting the haptic device",
                               "the device delivered no usable position in " +
                                   std::to_string(static_cast<long>(to_s(settings_.first_sample_max))) +
                                   " s (" + std::to_string(c.refused_samples) + " refused, " +
                                   fd::meaning(c.last_kind).says + ")",
                               "test the device with HapticDesk of the Force Dimension SDK");
        clock_->wait_until(clock_->now() + kFdLook);
    }
}

void ForceDimension::run() noexcept {
    pthread_setname_np(pthread_self(), "forcedimension");
    Instant next = clock_->now();
    while (!leave_.load(std::memory_order_relaxed)) {
        pump_->round(clock_->now());
        next = std::max(next + fd::Pump::kPeriod, clock_->now());  // a late round is not caught up
        clock_->wait_until(next);
    }
}

void ForceDimension::round() noexcept {
    if (pump_) pump_->round(clock_->now());
}

IoStatus ForceDimension::read(DeviceSample& newest, Instant now) noexcept {
    return pump_ ? pump_->read(newest, now) : IoStatus::lost;
}

IoStatus ForceDimension::write(const DeviceCommand& command, Instant /*now*/) noexcept {
    return pump_ ? pump_->write(command) : IoStatus::lost;
}

void ForceDimension::relax() noexcept {
    if (pump_) pump_->relax();
}

fd::Counts ForceDimension::counts() const noexcept { return pump_ ? pump_->counts() : fd::Counts{}; }

}  // namespace tact
