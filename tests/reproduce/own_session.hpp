// Runs an experiment in a session of its own, with priority over the other programs of the machine.
//
// Why     The kernel divides a core first between sessions and then between their programs (autogroup), so other users'
//         compilers would affect every result. All processes of an experiment get the same priority, so their relative
//         shares do not change.
// Rights  without CAP_SYS_NICE nothing changes, and the result reports it.
// Thread  the program must be single-threaded. Passes signals that request the end to the child.
#pragma once

#include <functional>

namespace tact::launch {

enum class Precedence { none, session };  // session: nice -20, for the session and each program in it
[[nodiscard]] const char* precedence_text(Precedence p);

// Forks; `work` runs in the child with the achieved precedence, and its result is the child's exit code, which is returned.
// Throws StartupError.
int in_own_session(const std::function<int(Precedence)>& work);

}  // namespace tact::launch
