#include "tests/reproduce/external_load.hpp"

#include <sched.h>
#include <signal.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstdint>
#include <cstdlib>
#include <cstring>
#include <vector>

#include "ipc/base/error.hpp"
#include "ipc/base/parent_death.hpp"

namespace tact::launch {
namespace {

// Sums random numbers and counts them in a table larger than the caches near the core, like a Monte Carlo simulation:
// the load uses processor time and cache.
[[noreturn]] void crunch() {
    std::vector<std::uint32_t> counts(std::size_t{1} << 21U);  // 8 MB
    std::uint64_t x = 88172645463325252ULL;
    double sum = 0.0;
    while (true) {
        for (int i = 0; i < 1'000'000; ++i) {  // xorshift64
            x ^= x << 13U;
            x ^= x >> 7U;
            x ^= x << 17U;
            sum = sum * 0.5 + static_cast<double>(x >> 11U) * 0x1p-53;
            ++counts[x % counts.size()];
        }
        if (sum + counts[0] == 0.123456789 || getppid() == 1)
            _exit(0);  // uses the results; exits if the parent is gone
    }
}

}  // namespace

ExternalLoad::ExternalLoad(int core) {
    const pid_t parent = getpid();
    pid_ = fork();
    if (pid_ < 0)
        throw StartupError("starting the external load", std::strerror(errno),
                           "raise the limit of processes (ulimit -u)");
    if (pid_ > 0) return;
    if (!end_with_parent(parent, SIGKILL)) _exit(0);
    prctl(PR_SET_NAME, "external-load");
    cpu_set_t one;
    CPU_ZERO(&one);
    CPU_SET(static_cast<std::size_t>(core), &one);
    sched_setaffinity(0, sizeof one, &one);
    crunch();
}

void ExternalLoad::stop() noexcept {
    if (pid_ <= 0) return;
    kill(pid_, SIGKILL);
    rusage used{};
    while (wait4(pid_, nullptr, 0, &used) < 0 && errno == EINTR) {
    }
    pid_ = -1;
    share_ = (static_cast<double>(used.ru_utime.tv_sec) + 1e-6 * static_cast<double>(used.ru_utime.tv_usec)) /
             std::max(to_s(Monotonic::now() - begun_at_), 1e-3);
}

}  // namespace tact::launch
