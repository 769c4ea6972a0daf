// Makes the final surface of a contour with `tact-prep contour` as a child: mesh simplification belongs there.
//
// Thread   the worker's (ContourWorker); the child inherits its low priority.
// Fails by StartupError with the child's output. The file it wrote is checked before use.
#pragma once

#include "gui/render/contour_worker.hpp"

namespace tact {

inline constexpr std::uint32_t kContourVerticesMax = 300'000;

[[nodiscard]] RefineContour refine_by_child(std::shared_ptr<const SceneContent> content,
                                            const std::string& program = "tact-prep");

}  // namespace tact
