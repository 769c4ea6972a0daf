#include "deploy/tact/servo_core.hpp"

#include <sched.h>

#include <charconv>
#include <filesystem>
#include <fstream>
#include <string>
#include <system_error>

namespace tact::launch {
namespace {

// Calls task(thread, folder) for each thread of a process until it returns false.
template <class F>
void for_threads(pid_t process, F task) {
    std::error_code gone;
    std::filesystem::directory_iterator i("/proc/" + std::to_string(process) + "/task", gone);
    for (; !gone && i != std::filesystem::directory_iterator(); i.increment(gone)) {
        const std::string name = i->path().filename().string();
        pid_t thread = 0;
        if (std::from_chars(name.data(), name.data() + name.size(), thread).ec != std::errc{}) continue;
        if (!task(thread, i->path())) return;
    }
}

}  // namespace

std::optional<int> servo_core(pid_t controller) {
    std::optional<int> core;
    for_threads(controller, [&](pid_t thread, const std::filesystem::path& folder) {
        std::string name;
        std::ifstream file(folder / "comm");
        if (!std::getline(file, name) || name != "servo") return true;
        cpu_set_t cores;
        CPU_ZERO(&cores);
        if (sched_getaffinity(thread, sizeof cores, &cores) == 0 && CPU_COUNT(&cores) == 1)
            for (int c = 0; c < CPU_SETSIZE; ++c)
                if (CPU_ISSET(static_cast<std::size_t>(c), &cores)) core = c;
        return false;
    });
    return core;
}

int keep_off_core(pid_t process, int core) {
    int moved = 0;
    if (core < 0 || core >= CPU_SETSIZE) return moved;
    for_threads(process, [&](pid_t thread, const std::filesystem::path&) {
        cpu_set_t cores;
        CPU_ZERO(&cores);
        if (sched_getaffinity(thread, sizeof cores, &cores) != 0 ||
            !CPU_ISSET(static_cast<std::size_t>(core), &cores) || CPU_COUNT(&cores) < 2)
            return true;
        CPU_CLR(static_cast<std::size_t>(core), &cores);
        if (sched_setaffinity(thread, sizeof cores, &cores) == 0) ++moved;
        return true;
    });
    return moved;
}

}  // namespace tact::launch
