// Frame metrics as published and reported, with the memory of the process.
#pragma once

#include <string>

#include "gui/render/pass_clock.hpp"
#include "gui/window/frame_clock.hpp"
#include "ipc/topics/frames.hpp"

namespace tact {

// Frame thread. Resident memory: 0 if the kernel does not report it.
[[nodiscard]] FrameMetrics frame_metrics(const FrameClock& clock, const PassClock& passes);

// JSON, with the layout of "frames" in the report of tact run. Throws StartupError if it cannot be written.
void write_frame_report(const std::string& path, const FrameMetrics& metrics);

}  // namespace tact
