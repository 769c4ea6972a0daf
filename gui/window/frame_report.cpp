#include "gui/window/frame_report.hpp"

#include <malloc.h>
#include <unistd.h>

#include <fstream>

#include "ipc/base/error.hpp"
#include "ipc/topics/frames_json.hpp"

namespace tact {
namespace {

std::uint64_t resident_bytes() {
    std::ifstream pages("/proc/self/statm");
    std::uint64_t all = 0, resident = 0;
    if (!(pages >> all >> resident)) return 0;
    return resident * static_cast<std::uint64_t>(sysconf(_SC_PAGESIZE));
}

}  // namespace

FrameMetrics frame_metrics(const FrameClock& clock, const PassClock& passes) {
    FrameMetrics f{};
    clock.fill(f);
    passes.fill(f);
    f.gl_objects = gl_names_held();
    const struct mallinfo2 heap = mallinfo2();
    f.heap_bytes = heap.uordblks + heap.hblkhd;
    f.resident_bytes = resident_bytes();
    return f;
}

void write_frame_report(const std::string& path, const FrameMetrics& metrics) {
    if (path.empty()) return;
    std::ofstream file(path, std::ios::trunc);
    file << frames_json(metrics).dump(2) << '\n';
    if (!file.flush())
        throw StartupError("writing the frame times to " + path, "the write failed",
                           "give --frames another path");
}

}  // namespace tact
