// What the controller's region holds is not trusted: a record is used when it makes sense, else counted.
//
// Pure functions; a record that is refused leaves the caller's old one in use.
#pragma once

#include "ipc/topics/bodies.hpp"
#include "ipc/topics/device.hpp"
#include "ipc/topics/drill.hpp"
#include "ipc/topics/head.hpp"
#include "ipc/topics/health.hpp"
#include "ipc/topics/levels.hpp"
#include "ipc/topics/recorders.hpp"
#include "ipc/topics/tool.hpp"
#include "ipc/topics/touch.hpp"

namespace tact {

[[nodiscard]] bool sensible(const BodiesTopic& bodies) noexcept;
[[nodiscard]] bool sensible(const ToolTopic& tool) noexcept;
[[nodiscard]] bool sensible(const TouchTopic& touch) noexcept;
[[nodiscard]] bool sensible(const DrillTopic& drill) noexcept;
[[nodiscard]] bool sensible(const HeadTopic& head) noexcept;
[[nodiscard]] bool sensible(const TrackerTopic& tracker) noexcept;
[[nodiscard]] bool sensible(const DevicesTopic& devices) noexcept;
[[nodiscard]] bool sensible(const HealthTopic& health) noexcept;
[[nodiscard]] bool sensible(const LatenessTopic& lateness) noexcept;
[[nodiscard]] bool sensible(const LevelsTopic& levels) noexcept;
[[nodiscard]] bool sensible(const RecordersTopic& recorders) noexcept;

// The level of a path, or null.
[[nodiscard]] const PathLevel* find_path(const LevelsTopic& levels, const char* path) noexcept;

}  // namespace tact
