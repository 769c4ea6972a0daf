// A Force Dimension arm that is open: found by its serial number, checked, and set up.
//
// Safety   opening leaves the output off and the brakes on; closing too. The arm moves by itself only where
//          open() is told so (`initialize`), never after a loss.
// Two arms each open device belongs to one session of the process; the others skip it
// Errors   none thrown: open() returns the failure, so that the pump can search again
// Thread   open() and close() on the thread that opens, later on the pump's
#pragma once

#include <array>
#include <cstdint>

#include "hal/forcedimension/fd_api.hpp"
#include "hal/forcedimension/fd_faults.hpp"
#include "hal/forcedimension/fd_models.hpp"

namespace tact::fd {

enum class OpenFailure : std::uint8_t {
    none,
    refused,  // by the library: `code`
    missing,  // no device, or none with this serial number
    several,  // and no serial number to choose by
    unknown_model,
    not_initialized,
    no_robot_library,  // to initialize it, libdrd is needed
    moved_wrongly      // the initialization failed
};

struct OpenResult {
    static constexpr std::size_t kListed = 16;

    OpenFailure failure = OpenFailure::none;
    int code = 0;                                   // of the library
    int type = 0;                                   // of an unknown model
    int count = 0;                                  // devices connected
    std::array<unsigned short, kListed> serials{};  // of the first `free` devices that could be opened
    std::size_t free = 0;
};

struct SessionSettings {
    unsigned short serial = 0;  // 0: the only device
    bool gravity = false;       // the library holds the weight of the arm while the force is on
};

class Session {
public:
    static constexpr int kWatchdogEighthsMs = 80;  // the device's own watchdog: 10 ms without a force
    // Of the library's velocities; its default of 20 ms would add 10 ms of delay to every damping.
    static constexpr int kVelocityWindowMs = 5;

    Session(const Api& api, const SessionSettings& settings) : api_(&api), settings_(settings) {}
    ~Session() { close(); }
    Session(const Session&) = delete;
    Session& operator=(const Session&) = delete;

    // One attempt. After the first success, the serial number is that of the device found.
    [[nodiscard]] OpenResult open(bool initialize) noexcept;
    void close() noexcept;

    [[nodiscard]] bool is_open() const noexcept { return id_ >= 0; }
    [[nodiscard]] char id() const noexcept { return static_cast<char>(id_); }
    [[nodiscard]] unsigned short serial() const noexcept { return settings_.serial; }
    [[nodiscard]] const Model& model() const noexcept { return *model_; }
    [[nodiscard]] bool wrist() const noexcept { return wrist_; }
    [[nodiscard]] bool torque() const noexcept { return torque_; }
    [[nodiscard]] bool gripper() const noexcept { return gripper_; }
    [[nodiscard]] bool left_handed() const noexcept { return left_; }
    // False: the library refused to switch its gravity compensation as the settings say.
    [[nodiscard]] bool gravity_set() const noexcept { return gravity_set_; }
    [[nodiscard]] bool own_watchdog() const noexcept { return own_watchdog_; }  // of the device
    [[nodiscard]] bool initialized() const noexcept;

private:
    [[nodiscard]] OpenResult choose() noexcept;
    [[nodiscard]] OpenFailure prepare(OpenResult& result, bool initialize) noexcept;
    [[nodiscard]] OpenFailure initialize() noexcept;
    void release(int id) noexcept;

    const Api* api_;
    SessionSettings settings_;
    const Model* model_ = nullptr;
    int id_ = -1;
    bool wrist_ = false, torque_ = false, gripper_ = false, left_ = false, own_watchdog_ = false,
         gravity_set_ = false;
};

}  // namespace tact::fd
