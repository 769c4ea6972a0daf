// Reader of a SpaceMouse: a thread that is connected to spacenavd through libspnav.
//
// libspnav   finds the daemon's socket, opens it and agrees on the protocol. It waits while it does so, and would wait for the rest of a
//            packet that the daemon does not send; so it works on a thread of its own, and the events are read from its descriptor
//            without waiting and decoded here (ipc/spacenav).
// Frame      sample() copies a few numbers and never waits for the daemon
// Hostile    at most kBatchBytes every kBatchEvery; a stream that is lost is connected again
// Silent     a daemon that says nothing for kSilentMost while the cap is deflected counts as at rest
// Lost       the daemon ends, or is restarted: tried again every kRetryEvery. The device is unplugged: the daemon says so.
// End        the destructor ends the thread; one that hangs in libspnav is left behind after kEndMost
// One        libspnav has one connection in a process, so only one reader at a time
// Thread     any one thread
#pragma once

#include <cstdint>
#include <memory>
#include <string>

#include "gui/input/rate_control.hpp"
#include "ipc/base/clock.hpp"
#include "ipc/spacenav/spacenav_stream.hpp"

namespace tact {

struct SpaceMouseState {
    bool connected = false;        // to the daemon
    std::uint64_t connection = 0;  // counts connections, and devices that left
    std::string problem;           // why it is not connected, for a person; "" at first and while connected
    SpacenavState events;          // pressed: since the state was last taken
};

class SpaceMouse {
public:
    static constexpr std::size_t kBatchBytes = 8192;
    static constexpr Duration kBatchEvery = std::chrono::milliseconds(4);
    static constexpr Duration kRetryEvery = std::chrono::milliseconds(500);
    static constexpr Duration kSilentMost = std::chrono::seconds(5);
    static constexpr Duration kEndMost = std::chrono::milliseconds(500);
    static constexpr double kFull = 350.0;  // deflection of an axis at spacenavd's default sensitivity

    SpaceMouse();
    ~SpaceMouse();
    SpaceMouse(const SpaceMouse&) = delete;
    SpaceMouse& operator=(const SpaceMouse&) = delete;

    [[nodiscard]] SpaceMouseState take();

private:
    struct Shared;
    std::shared_ptr<Shared> shared_;
};

[[nodiscard]] Deflection space_mouse_deflection(const SpacenavState& events);  // not shaped
[[nodiscard]] InputSample space_mouse_sample(const SpaceMouseState& state, const InputChoice& choice);
// "SpaceMouse Pro", "not found. Install and start spacenavd."
[[nodiscard]] std::string space_mouse_text(const SpaceMouseState& state);

}  // namespace tact
