#include "tests/bench/bench_particles.hpp"

#include <fcntl.h>
#include <unistd.h>

#include <cstdio>

#include "deploy/tact/child.hpp"
#include "deploy/tact/files.hpp"
#include "ipc/base/error.hpp"

namespace tact::launch {

nlohmann::json bench_particles_by_child() {
    std::filesystem::path gui;
    try {
        gui = find_program("tact-gui");
    } catch (const StartupError& e) {
        std::fprintf(stderr, "tact: cannot measure particles: %s\n", e.what());
        return nlohmann::json::object();
    }
    const ScratchFolder scratch;
    const auto file = scratch.path() / "bench.json";
    const int fd = ::open(file.c_str(), O_WRONLY | O_CREAT | O_CLOEXEC, 0600);
    ChildSettings settings;
    settings.arguments = {"--bench-particles"};
    settings.output_fd = fd;
    Child child("tact-gui", gui, settings);
    if (fd >= 0) ::close(fd);
    const auto& ending = child.wait(std::chrono::minutes(3));
    const std::string output = read_small(file);
    auto numbers = nlohmann::json::parse(output, nullptr, false);
    if (!ending || !ending->clean() || !numbers.is_object())
        throw StartupError(
            "measure particles",
            "tact-gui " + (ending ? ending->text() : "did not exit within three minutes") + ": " + output,
            "run tact-gui --bench-particles by hand");
    return numbers;
}

}  // namespace tact::launch
