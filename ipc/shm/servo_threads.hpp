// Which controllers of this machine have their servo thread pinned to which core: two on one core disturb each other.
//
// Source   /proc: the thread "servo" of each process "tact-rt" that may run on one core only. Where processes of other users
//          are hidden (hidepid), theirs are missing.
// Hostile  texts of other processes are bounded, and a session that is no session name is not repeated.
// Thread   start-up, and programs for people; never the servo
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace tact {

struct PinnedServo {
    int process = 0;
    int core = -1;
    std::string session;  // "default", or what --session says
};

// By process. proc: stands for /proc.
[[nodiscard]] std::vector<PinnedServo> pinned_servos(const std::filesystem::path& proc = "/proc");

// What a controller should know about others on its core; "" where there is none, or where it is not pinned itself.
[[nodiscard]] std::string shared_core_text(const std::vector<PinnedServo>& servos, int own_process);
// The same of all of them, as an observer sees it; "" where no core is shared.
[[nodiscard]] std::string shared_cores_text(const std::vector<PinnedServo>& servos);

inline constexpr const char* kSharedCoreFix =
    "give each session a core of its own: --core N, or servo.core in its configuration";

}  // namespace tact
