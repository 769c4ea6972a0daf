#include "tests/bench/bench_prep.hpp"

#include <fcntl.h>
#include <unistd.h>

#include "deploy/tact/child.hpp"
#include "deploy/tact/files.hpp"
#include "ipc/base/error.hpp"

namespace tact::launch {

nlohmann::json bench_prep() {
    const ScratchFolder scratch;
    const auto file = scratch.path() / "bench.json";
    const int fd = ::open(file.c_str(), O_WRONLY | O_CREAT | O_CLOEXEC, 0600);
    ChildSettings settings;
    settings.arguments = {"bench", "--json"};
    settings.output_fd = fd;
    Child child("tact-prep", find_program("tact-prep"), settings);
    if (fd >= 0) ::close(fd);
    const auto& ending = child.wait(std::chrono::minutes(2));
    const std::string output = read_small(file);
    auto numbers = nlohmann::json::parse(output, nullptr, false);
    if (!ending || !ending->clean() || !numbers.is_object())
        throw StartupError(
            "measure simplification",
            "tact-prep " + (ending ? ending->text() : "did not exit within two minutes") + ": " + output,
            "run tact-prep bench by hand");
    return numbers;
}

}  // namespace tact::launch
