// The housekeeping thread: all work of tact-rt that may wait, allocate or log.
//
// Does      serves the link, maps the GUI's region, checks its commands, loads and pointer and passes them on, logs
//           events, has models rebuilt, destroys old ones, ends the run after its time
// Runs on   the main thread, ordinary scheduling; never on the servo's core by choice
// Hostile   checks every field of the GUI's region; counts and drops invalid ones
#pragma once

#include <array>
#include <csignal>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "ipc/shm/link.hpp"
#include "ipc/shm/region.hpp"
#include "ipc/topics/regions.hpp"
#include "rt/servo/mailbox.hpp"
#include "rt/threads/command_feed.hpp"
#include "rt/threads/model_builder.hpp"
#include "rt/threads/mouse_feed.hpp"
#include "rt/threads/service_notify.hpp"

namespace tact {

// False: some field has an impossible value.
[[nodiscard]] bool plausible(const LoadTopic& load);

struct HousekeepingSettings {
    std::string session = "default";
    double seconds = 0.0;       // 0: until a signal
    bool arm_with_gui = false;  // arm once, after the visual process has drawn its first frame
    std::vector<std::string> path_names;
    int servo_thread_id = 0;
    std::uint64_t page_faults_at_start = 0;
    std::array<Latest<MouseTarget>*, kMouseHands> mouse{};  // of emulated hands that follow a pointer
    Pose T_dev_world;
    std::array<LeadDevice, kMouseHands> lead_device{};  // that the configuration names for each hand
};

class Housekeeping {
public:
    Housekeeping(HousekeepingSettings settings, OwnedRegion<RtRegion>& region, ServoMailbox& mailbox,
                 LinkServer& link);
    // Passes on an order from the command line.
    void order(CommandKind kind, double value, std::uint32_t index);
    // Returns when the servo has ended.
    void run();
    // Installs handlers that pass stop signals to `mailbox`.
    static void catch_signals(ServoMailbox& mailbox);

private:
    void serve_link();
    void serve_gui();
    void pass_on_frames();
    void count_recorders();
    void apply_order(const LinkServer::News::Order& order);
    void follow_mouse();
    void log_events();
    void report();
    void notify_service(Instant now);

    HousekeepingSettings settings_;
    OwnedRegion<RtRegion>& region_;
    ServoMailbox& mailbox_;
    LinkServer& link_;
    ModelBuilder builder_;
    MappedRegion<GuiRegion> gui_;
    CommandFeed commands_;
    MouseFeed mouse_;
    RingCursor events_;
    std::uint64_t loads_seen_ = 0, frames_seen_ = 0;
    LinkServer::Recorders recorders_;
    std::uint64_t marks_ = 0;
    std::uint64_t bad_input_ = 0;
    std::uint64_t faults_seen_ = 0;
    HousekeepingReport report_{};
    ServiceNotify service_;
};

}  // namespace tact
