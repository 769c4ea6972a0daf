// The final surface of a contour, made by `tact-prep contour` as a child: what simplifies meshes belongs
// there.
//
// Thread   the worker's (ContourWorker); the child has its low priority.
// Fails by StartupError with what the child said. Nothing of what it wrote is believed unchecked.
#pragma once

#include "gui/render/contour_worker.hpp"

namespace tact {

inline constexpr std::uint32_t kContourVerticesMax = 300'000;

[[nodiscard]] RefineContour refine_by_child(std::shared_ptr<const SceneContent> content,
                                            const std::string& program = "tact-prep");

}  // namespace tact
