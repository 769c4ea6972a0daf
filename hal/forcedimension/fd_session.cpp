#include "hal/forcedimension/fd_session.hpp"

#include <algorithm>
#include <atomic>

namespace tact::fd {

namespace {

// Bit n: the device with ID n belongs to a session of this process.
std::atomic<std::uint32_t> taken_ids{0};

constexpr std::uint32_t bit_of(int id) { return id >= 0 && id < 32 ? 1U << static_cast<unsigned>(id) : 0; }

bool take_id(int id) {
    const std::uint32_t bit = bit_of(id);
    return bit != 0 && (taken_ids.fetch_or(bit) & bit) == 0;
}

}  // namespace

void Session::release(int id) noexcept {
    const char which = static_cast<char>(id);
    static_cast<void>(api_->robot ? api_->drdClose(which) : api_->dhdClose(which));
    taken_ids.fetch_and(~bit_of(id));
}

// Opens every free device for a moment, since only an open one tells its serial number.
OpenResult Session::choose() noexcept {
    OpenResult result;
    result.count = api_->dhdGetDeviceCount();
    if (result.count < 0) {
        result.failure = OpenFailure::refused;
        result.code = api_->dhdErrorGetLast();
        return result;
    }
    int chosen = -1;
    unsigned short chosen_serial = 0;
    for (int index = 0; index < std::min<int>(result.count, OpenResult::kListed); ++index) {
        const char at = static_cast<char>(index);
        const int id = api_->robot ? api_->drdOpenID(at) : api_->dhdOpenID(at);
        if (id < 0) {
            result.code = api_->dhdErrorGetLast();
            continue;
        }
        if (!take_id(id)) continue;  // of another session, which keeps it
        unsigned short serial = 0;
        if (api_->dhdGetSerialNumber(&serial, static_cast<char>(id)) < 0) serial = 0;
        result.serials[result.free++] = serial;
        if (chosen < 0 && (settings_.serial == 0 || serial == settings_.serial)) {
            chosen = id;
            chosen_serial = serial;
        } else {
            release(id);
        }
    }
    if (chosen >= 0 && settings_.serial == 0 && result.free > 1) {
        release(chosen);
        result.failure = OpenFailure::several;
    } else if (chosen >= 0) {
        id_ = chosen;
        settings_.serial = chosen_serial;
    } else {
        result.failure = result.code != 0 && result.free == 0 ? OpenFailure::refused : OpenFailure::missing;
    }
    return result;
}

bool Session::initialized() const noexcept {
    if (api_->robot) return api_->drdIsInitialized(id());
    std::array<int, kStatusRoom> status{};
    if (api_->dhdGetStatus(status.data(), id()) < 0) return false;
    return status[kStatusReset] == 0 && (status[kStatusWristDetected] == 0 || status[kStatusWristInit] != 0);
}

OpenFailure Session::initialize() noexcept {
    if (!api_->robot) return OpenFailure::no_robot_library;
    const bool done = api_->drdAutoInit(id()) >= 0;
    static_cast<void>(api_->drdStop(false, id()));  // ends the library's position control, without force
    return done && initialized() ? OpenFailure::none : OpenFailure::moved_wrongly;
}

OpenFailure Session::prepare(OpenResult& result, bool initialize) noexcept {
    const char device = id();
    result.type = api_->dhdGetSystemType(device);
    model_ = fd::model(result.type);
    if (model_ == nullptr) return OpenFailure::unknown_model;
    wrist_ = api_->dhdHasWrist(device);
    torque_ = model_->torque_n_m_max > 0.0 && api_->dhdHasActiveWrist(device);
    gripper_ = api_->dhdHasGripper(device);
    left_ = api_->dhdIsLeftHanded(device);
    if (!initialized()) {
        const OpenFailure failure = initialize ? this->initialize() : OpenFailure::not_initialized;
        if (failure != OpenFailure::none) {
            result.code = api_->dhdErrorGetLast();
            return failure;
        }
    }
    // Time guard and watchdog are functions for experts. Not every device has each of these functions.
    static_cast<void>(api_->dhdEnableExpertMode());
    static_cast<void>(api_->dhdSetTimeGuard(kTimeGuardDefault, device));
    own_watchdog_ = api_->dhdSetWatchdog(kWatchdogEighthsMs, device) >= 0;
    gravity_set_ = api_->dhdSetGravityCompensation(settings_.gravity ? kOn : kOff, device) >= 0;
    static_cast<void>(api_->dhdConfigLinearVelocity(kVelocityWindowMs, kVelocityWindowing, device));
    if (wrist_)
        static_cast<void>(api_->dhdConfigAngularVelocity(kVelocityWindowMs, kVelocityWindowing, device));
    if (api_->dhdEnableForce(kOff, device) < 0) {
        result.code = api_->dhdErrorGetLast();
        return OpenFailure::refused;
    }
    static_cast<void>(api_->dhdSetBrakes(kOn, device));
    return OpenFailure::none;
}

OpenResult Session::open(bool initialize) noexcept {
    close();
    OpenResult result = choose();
    if (result.failure != OpenFailure::none) return result;
    result.code = 0;
    result.failure = prepare(result, initialize);
    if (result.failure != OpenFailure::none) close();
    return result;
}

void Session::close() noexcept {
    if (id_ < 0) return;
    static_cast<void>(api_->dhdStop(id()));  // no force, brakes on
    release(id_);
    id_ = -1;
}

}  // namespace tact::fd
