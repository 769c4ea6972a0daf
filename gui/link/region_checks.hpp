// Checks records from the controller's region, which is not trusted: invalid ones are counted and not used.
//
// Pure functions; if a record is refused, the caller keeps its last valid one.
#pragma once

#include "ipc/topics/bodies.hpp"
#include "ipc/topics/device.hpp"
#include "ipc/topics/drill.hpp"
#include "ipc/topics/head.hpp"
#include "ipc/topics/health.hpp"
#include "ipc/topics/levels.hpp"
#include "ipc/topics/mark.hpp"
#include "ipc/topics/recorders.hpp"
#include "ipc/topics/replay.hpp"
#include "ipc/topics/shapes.hpp"
#include "ipc/topics/tool.hpp"
#include "ipc/topics/touch.hpp"

namespace tact {

[[nodiscard]] bool sensible(const BodiesTopic& bodies) noexcept;
[[nodiscard]] bool sensible(const ShapesTopic& shapes) noexcept;
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
[[nodiscard]] bool sensible(const MarkTopic& mark) noexcept;
[[nodiscard]] bool sensible(const ReplayTopic& replay) noexcept;
[[nodiscard]] bool sensible(const ReplayMarks& marks) noexcept;

// The level of a path, or null.
[[nodiscard]] const PathLevel* find_path(const LevelsTopic& levels, const char* path) noexcept;

}  // namespace tact
