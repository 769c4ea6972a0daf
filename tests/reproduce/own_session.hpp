// Runs an experiment in a session of its own, with precedence over the other programs of the machine.
//
// Why     the kernel shares a core out between sessions first and their programs second (autogroup), so what
//         somebody else compiles would take part in every figure. All parties of an experiment get the same
//         precedence, whoever they are: what they have among each other stays as it is.
// Rights  without CAP_SYS_NICE nothing changes, and the result says so.
// Thread  the program must be single-threaded. Signals that ask to end are passed on to the child.
#pragma once

#include <functional>

namespace tact::launch {

enum class Precedence { none, session };  // session: nice -20, for the session and each program in it
[[nodiscard]] const char* precedence_text(Precedence p);

// Forks; `work` runs in the child with what was reached, and its result is the child's exit code, which is
// returned. Throws StartupError.
int in_own_session(const std::function<int(Precedence)>& work);

}  // namespace tact::launch
