// The mailbox between the pump of a manufacturer's library and the servo, with the servo's end of it.
//
// Frame   the device frame of hal/api, SI units
// Edges   the servo's end counts enable edges and calls of relax(), so that the pump misses none when it
//         reads only the newest command
// Thread  read(), write() and relax() on the servo's; publish() and fetch() on the pump's. All only touch
//         memory.
#pragma once

#include <memory>

#include "hal/api/haptic_device.hpp"
#include "ipc/shm/latest.hpp"

namespace tact::vendor {

// Trivially copyable sample and command, for Latest.
struct SampleWords {
    std::int64_t taken_at_ns, delay_ns;
    std::uint64_t sequence;
    double pos_m[3], quat_xyzw[4], linear_m_s[3], angular_rad_s[3];
    std::uint32_t buttons;
    std::uint8_t hand_present, state, ended,
        notice;  // ended: no more samples until the device is opened again
    BusCounts bus;
};

struct CommandWords {
    double force_n[3], torque_n_m[3];
    std::uint64_t heartbeat;
    std::int64_t answers_ns;  // taken_at_ns of the sample that it answers; 0: none
    std::uint64_t edge;       // enable edges so far; only the newest counts
    std::uint32_t enable;
    std::uint32_t relaxed;  // calls of relax(); each one removes the force
};

class ServoMail {
public:
    static constexpr Duration kLostAfter = std::chrono::milliseconds(100);

    [[nodiscard]] IoStatus read(DeviceSample& newest, Instant now) noexcept TACT_RT;
    [[nodiscard]] IoStatus write(const DeviceCommand& command) noexcept TACT_RT;
    void relax() noexcept;

    void publish(const SampleWords& sample) noexcept { mailbox_->sample.publish(sample); }
    // False: there was no command yet. A command that cannot be read completely leaves the last one.
    [[nodiscard]] bool fetch(CommandWords& command) const noexcept {
        return mailbox_->command.read(command) || mailbox_->command.count() > 0;
    }

private:
    struct Mailbox {
        Latest<SampleWords> sample;
        Latest<CommandWords> command;
    };
    std::unique_ptr<Mailbox> mailbox_ = std::make_unique<Mailbox>();

    std::uint64_t sequence_ = 0, heartbeat_sent_ = 0, edges_sent_ = 0;
    std::int64_t taken_at_ns_ = 0;  // of the newest sample read
    std::uint32_t relaxed_sent_ = 0;
    bool low_seen_ = true;  // enable was low since the last edge
    IoStatus status_ = IoStatus::ok;
};

}  // namespace tact::vendor
