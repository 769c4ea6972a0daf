// The figures of the frames as they are published and written down, with the memory of the process.
#pragma once

#include <string>

#include "gui/render/pass_clock.hpp"
#include "gui/window/frame_clock.hpp"
#include "ipc/topics/frames.hpp"

namespace tact {

// Frame thread. Resident memory: 0 where the kernel does not say.
[[nodiscard]] FrameMetrics frame_metrics(const FrameClock& clock, const PassClock& passes);

// JSON; the layout is that of "frames" in the report of tact run. Throws StartupError where it cannot be written.
void write_frame_report(const std::string& path, const FrameMetrics& metrics);

}  // namespace tact
