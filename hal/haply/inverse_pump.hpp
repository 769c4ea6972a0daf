// One round with the Inverse Service: sends the newest command, takes the state that answers it, and searches
// a lost arm.
//
// Service   sends exactly one state for each message; a force applies for one message, and without the next
//           one the arm returns to idle
// Frame     the device frame of hal/api: x right, y up, z to the user; origin in the middle of the workspace
// Enable    as hal/vendor/output_gate.hpp; while the output is off, the messages ask for the pose only
// Errors    no answer for 20 ms, a broken connection, an arm that is no longer listed: closed, lost, and one
//           attempt per 500 ms to find it again by its ID. A status that is not usable: fault. Nothing re-arms
//           automatically
// Numbers   impossible poses are refused and counted; the last good sample stays and ages
// Thread    round() and finish() on the pump's; read(), write() and relax() on the servo's: memory only
#pragma once

#include <memory>
#include <string>

#include "hal/haply/inverse_link.hpp"
#include "hal/haply/inverse_messages.hpp"
#include "hal/vendor/output_gate.hpp"

namespace tact::haply {

enum class Loss : std::uint8_t { none, no_service, no_arm, several, old_service, silent, broken };

struct InverseCounts {
    std::uint64_t rounds = 0, states = 0;
    std::uint64_t refused_messages = 0, refused_samples = 0, refused_commands = 0;
    std::uint64_t lost = 0, reopened = 0, watchdog_trips = 0, not_usable = 0;
    Loss last = Loss::none;
};

struct InverseLimits {
    // No figure is published: a conservative one, and half the stiffness of the manufacturer's own example of
    // a wall (1000 N/m).
    static constexpr double kForceN = 3.0, kStiffnessNM = 500.0;
    // The sphere of the manufacturer's tutorials.
    static constexpr double kRadiusM = 0.10, kMinverseRadiusM = 0.04;
    static constexpr double kStepM = 1e-4;  // no figure is published: a conservative one
};

class InversePump {
public:
    static constexpr Duration kAnswerMax = std::chrono::milliseconds(20);
    static constexpr Duration kReopenEvery = std::chrono::milliseconds(500);
    // Between service and arm, which the service does not report: an estimate.
    static constexpr Duration kTransport = std::chrono::milliseconds(1);

    // The channel outlives the pump. id: empty: the only arm.
    InversePump(Channel& channel, std::string id);

    // Connects, chooses the arm and configures it. The text has the reason and, for `several`, the IDs.
    [[nodiscard]] Loss open(std::string& text);
    void round(Instant now) noexcept;
    void finish() noexcept;

    IoStatus read(DeviceSample& newest, Instant now) noexcept TACT_RT { return mail_.read(newest, now); }
    IoStatus write(const DeviceCommand& command) noexcept TACT_RT { return mail_.write(command); }
    void relax() noexcept { mail_.relax(); }
    [[nodiscard]] InverseCounts counts() const noexcept;
    [[nodiscard]] const std::string& id() const noexcept { return id_; }
    [[nodiscard]] const std::string& type() const noexcept { return type_; }

private:
    [[nodiscard]] Loss ask(const std::string& message, InverseState& state);
    void exchange(Instant now);
    void lose(Loss why, Instant now);
    void take(const InverseState& state, Instant now, std::int64_t shown_ns);
    [[nodiscard]] std::string next_message();
    void publish() noexcept;

    Channel* channel_;
    vendor::ServoMail mail_;
    std::unique_ptr<Latest<InverseCounts>> published_;
    std::string id_, type_, text_;

    vendor::SampleWords sample_{};
    vendor::CommandWords command_{};
    vendor::OutputGate gate_;
    InverseCounts counts_;
    Instant retry_at_{};
    // Of the sample that the last message answered: the next state is the first that it can have moved.
    std::int64_t sent_answers_ns_ = 0;
    bool open_ = false, usable_ = true;
};

}  // namespace tact::haply
