// Runs an experiment in a separate session, with priority over the other programs on the machine.
//
// Why     The kernel divides a core first between sessions, then between the programs of each session (autogroup), so
//         the programs of other users would affect every result. All processes of an experiment get the same priority,
//         so their relative shares do not change.
// Rights  requires CAP_SYS_NICE; without it the priority stays ordinary, and the report states this
// Thread  the program must be single-threaded. Termination signals are forwarded to the child.
#pragma once

#include <functional>

namespace tact::launch {

// session: nice -20 for the session, nice 0 for its programs; programs: nice -5 for each, without priority of sessions
enum class Precedence { none, programs, session };
[[nodiscard]] const char* precedence_text(Precedence p);

// Forks and runs `work` in the child with the achieved precedence. The result of `work` is the exit code of the child,
// which is returned. Throws StartupError.
int in_own_session(const std::function<int(Precedence)>& work);

}  // namespace tact::launch
