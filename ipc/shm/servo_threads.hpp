// Finds the controllers of this computer whose servo threads are pinned to a core: two on one core disturb
// each other.
//
// Source   /proc: the thread "servo" of each process "tact-rt" that may run on one core only. Processes of
//          other users are missing where they are hidden (hidepid).
// Input    untrusted: texts of other processes are bounded, and an invalid session name is not printed
// Thread   start-up, and programs for people; never the servo
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace tact {

struct PinnedServo {
    int process = 0;
    int core = -1;
    std::string session;  // "default", or the value of --session
};

// Sorted by process. proc: replaces /proc in tests.
[[nodiscard]] std::vector<PinnedServo> pinned_servos(const std::filesystem::path& proc = "/proc");

// Warning for a controller about others on its core; "" without others, or if it is not pinned.
[[nodiscard]] std::string shared_core_text(const std::vector<PinnedServo>& servos, int own_process);
// The same for all controllers, for an observer; "" if no core is shared.
[[nodiscard]] std::string shared_cores_text(const std::vector<PinnedServo>& servos);

inline constexpr const char* kSharedCoreFix =
    "give each session its own core: --core N, or servo.core in its configuration";

}  // namespace tact
