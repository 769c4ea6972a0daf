#include "deploy/tact/station/smi.hpp"

#include <fcntl.h>
#include <unistd.h>

#include <cerrno>

#include "deploy/tact/files.hpp"
#include "ipc/base/error.hpp"

namespace tact::launch {
namespace {

constexpr off_t kSmiCount = 0x34;

}  // namespace

SmiReading read_smi_count(int core, const std::filesystem::path& root) {
    if (read_small(root / "proc/cpuinfo").find("GenuineIntel") == std::string::npos)
        return {std::nullopt, "not readable: only Intel processors have this counter"};
    const std::filesystem::path path = root / "dev/cpu" / std::to_string(core) / "msr";
    const int fd = open(path.c_str(), O_RDONLY | O_CLOEXEC);
    if (fd < 0) {
        const bool absent = errno == ENOENT || errno == ENXIO;
        return {std::nullopt,
                "not readable: " + path.string() + ": " + last_error() + (absent ? " (modprobe msr)" : "")};
    }
    std::uint64_t value = 0;
    const ssize_t got = pread(fd, &value, sizeof value, kSmiCount);
    const std::string why = got < 0 ? last_error() : "incomplete value";
    close(fd);
    if (got != static_cast<ssize_t>(sizeof value))
        return {std::nullopt, "not readable: register 0x34 of " + path.string() + ": " + why};
    return {value & 0xFFFFFFFFU, ""};
}

std::uint64_t smi_between(std::uint64_t before, std::uint64_t after) {
    return (after - before) & 0xFFFFFFFFU;
}

}  // namespace tact::launch
