// Keeps all other processes of a run off the core of the servo.
//
// Why       FIFO priority takes the core from a window that draws on it, but not its caches; a kernel without
//           preemption also finishes a system call first. Threads of a software renderer run on all cores.
// How       the controller chooses the core; its pinned thread "servo" shows which. Every other thread gets its present
//           cores without that one; a thread with no other core is left unchanged.
// Again     once per second, because graphics drivers give some threads all cores.
// Fails by  doing nothing: threads that have ended or belong to another user are skipped.
#pragma once

#include <sys/types.h>

#include <optional>

namespace tact::launch {

// Empty if there is no such thread, or if it may run on several cores.
[[nodiscard]] std::optional<int> servo_core(pid_t controller);
// Returns the number of threads that were moved.
int keep_off_core(pid_t process, int core);

}  // namespace tact::launch
