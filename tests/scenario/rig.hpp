// The basis of the scenarios: a folder of their own, a small scene, the real tact-rt in it, and a visual process.
//
// Own place  every rig has its own runtime folder (TACT_RUNTIME_DIR) and session, so that scenarios disturb neither each
//            other nor a person's controller; the folder is removed with the rig.
// Waiting    until(condition) polls every millisecond and gives up after a large limit: it tolerates slow machines, and
//            a broken program fails. No scenario checks a duration.
#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "deploy/tact/child.hpp"
#include "deploy/tact/files.hpp"
#include "deploy/tact/observer.hpp"
#include "ipc/shm/link.hpp"
#include "ipc/shm/region.hpp"
#include "ipc/topics/regions.hpp"

namespace tact::scenario {

// False: the limit (a minute) has passed.
bool until(const std::function<bool()>& condition);

// Path of the tact-rt of this build.
std::filesystem::path rt_program();

class Rig {
public:
    Rig();  // throws if the folder cannot be created
    [[nodiscard]] std::filesystem::path folder() const { return scratch_.path(); }
    [[nodiscard]] std::filesystem::path scene() const { return folder() / "rod.tact"; }
    [[nodiscard]] std::string session() const { return "scenario"; }
    [[nodiscard]] std::filesystem::path socket() const { return folder() / "tact-scenario.sock"; }
    // Writes a file with this content in the rig's folder.
    std::filesystem::path file(const std::string& name, const std::string& content) const;
    // True if no process holds the session's lock.
    [[nodiscard]] bool lock_is_free() const;

private:
    launch::ScratchFolder scratch_;
};

struct Said {  // result of a program that has ended
    launch::Ending ending;
    std::string text;
};
// Runs a program to its end; empty if it did not end within the limit (it is then killed).
std::optional<Said> run_to_end(const Rig& rig, const std::filesystem::path& program,
                               std::vector<std::string> arguments, const std::string& runtime_folder = {});

// The real controller on the emulated device, with ordinary scheduling. The hand wanders, so there is always a force; the
// device's watchdog is a second, because a busy machine delays ordinary threads by
// 10 ms.
class Controller {
public:
    Controller(const Rig& rig, const std::vector<std::string>& more, const std::string& more_config = {});

    launch::Child& child() { return child_; }
    [[nodiscard]] std::string said() const;  // output so far, standard output and error

private:
    std::filesystem::path log_;
    launch::Child child_;
};

// Observes the controller of the session.
class Watch {
public:
    explicit Watch(const Rig& rig) : observer_(rig.session()) {}
    launch::Observer& observer() { return observer_; }
    // Waits for a controller of another generation that has published its health.
    bool attach(std::uint64_t not_generation = 0);
    [[nodiscard]] HealthTopic health();
    [[nodiscard]] RunState state() { return static_cast<RunState>(health().state); }
    [[nodiscard]] ToolTopic tool();
    [[nodiscard]] double force_n();
    [[nodiscard]] std::uint64_t generation() const { return observer_.generation(); }
    [[nodiscard]] const RtRegion& region() const { return observer_.region(); }
    // Waits for so many more cycles of the loop.
    bool cycles_pass(std::uint64_t count);

private:
    launch::Observer observer_;
};

// A visual process inside the test, with the same link as tact-gui's, that can misbehave.
class Visual {
public:
    explicit Visual(const Rig& rig) : Visual(rig.session()) {}
    explicit Visual(const std::string& session) : link_(session, ready_region()) {}
    // Reports a frame, which also keeps the link alive. True while attached.
    bool frame();
    // Returns the number of the command, which the health topic echoes.
    std::uint64_t send(CommandKind kind, double value = 0.0, const std::string& text = {});
    GuiRegion& region() { return *region_; }
    [[nodiscard]] std::uint64_t generation() const { return region_.generation(); }

private:
    int ready_region();
    OwnedRegion<GuiRegion> region_;
    LinkClient link_;
    std::uint64_t frames_ = 0, commands_ = 0;
};

// Sends frames until the controller has answered the command; returns the result, or none.
CommandResult command(Visual& visual, Watch& watch, CommandKind kind, double value = 0.0,
                      const std::string& text = {});

// Attaches a visual process, arms, and waits for a force.
bool bring_to_force(Visual& visual, Watch& watch);

}  // namespace tact::scenario
