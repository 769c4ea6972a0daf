// The servo's core belongs to the servo: everybody else whom a run starts is kept off it.
//
// Why       FIFO priority takes the core from a window that draws on it, but not its caches, nor a system call that a kernel
//           without preemption lets end first. Threads of a software renderer are spread over all cores.
// How       the controller chooses the core; its pinned thread "servo" tells which. What else runs gets the cores that it
//           had without that one, thread by thread; where nothing would be left, it keeps what it has.
// Again     now and then: graphics drivers give some threads all cores by themselves.
// Fails by  doing nothing: a thread that is gone meanwhile, or is not ours, stays as it is.
#pragma once

#include <sys/types.h>

#include <optional>

namespace tact::launch {

// Nothing: there is no such thread, or it may run on more than one.
[[nodiscard]] std::optional<int> servo_core(pid_t controller);
// Returns how many threads had to be moved.
int keep_off_core(pid_t process, int core);

}  // namespace tact::launch
