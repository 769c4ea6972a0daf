// Takes the targets of a pointer from the visual process, checks them and passes them on to the emulated hands that follow one.
//
// Hostile   every field is checked; records for another controller, and for a hand that follows no pointer (a real arm's has no mailbox),
//           are refused and counted. A target moves the hand of an emulated arm and nothing else.
// Time      stamped on arrival: the other process's time stamp is not trusted
// Stale     the device lets go by itself (hal/sim/mouse_hand.hpp); here it is counted and published
// Thread    housekeeping
#pragma once

#include <array>
#include <cstdint>
#include <string>

#include "hal/sim/mouse_hand.hpp"
#include "ipc/base/clock.hpp"
#include "ipc/shm/latest.hpp"
#include "ipc/topics/mouse.hpp"

namespace tact {

struct MouseFeedSettings {
    std::array<Latest<MouseTarget>*, kMouseHands> hand{};  // null: this hand follows no pointer
    Pose T_dev_world;
    std::uint64_t generation = 0;                  // of the controller's region
    std::array<LeadDevice, kMouseHands> wanted{};  // by the configuration, for the window
};

class MouseFeed {
public:
    explicit MouseFeed(const MouseFeedSettings& settings);

    // Begins with what comes next.
    void restart(const Latest<MouseTopic>& from) { seen_ = from.count(); }
    // One turn. Returns how many records were refused in it: 0 or 1, because older ones are overwritten.
    std::uint64_t pass_on(const Latest<MouseTopic>& from, Instant now);
    // Lets go of everything, because the visual process left.
    void let_go();
    // Notices pointers that fell silent. True: the state changed, or is due.
    bool follow(Instant now);

    [[nodiscard]] bool leads() const;
    [[nodiscard]] MouseStateTopic state(Instant now) const;

private:
    void publish(std::size_t hand, const MouseTarget& target);

    MouseFeedSettings settings_;
    std::array<MouseTarget, kMouseHands> sent_{};
    MouseStateTopic state_{};
    std::uint64_t seen_ = 0;
    bool changed_ = true;
    Instant told_at_{};
};

}  // namespace tact
