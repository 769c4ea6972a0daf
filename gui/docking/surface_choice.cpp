#include "gui/docking/surface_choice.hpp"

#include <algorithm>
#include <utility>

#include "gui/docking/docking_content.hpp"

namespace tact {

SurfaceChoices::SurfaceChoices(std::shared_ptr<const SceneContent> content, std::size_t vertices_max)
    : content_(std::move(content)),
      vertices_max_(vertices_max / std::max<std::size_t>(docking_of(*content_).bodies.size(), 1)),
      structures_(docking_of(*content_).bodies.size()) {}

void SurfaceChoices::follow() {
    if (!worker_) return;
    for (SurfaceOutcome& outcome : worker_->take()) {
        OfStructure& of = structures_[outcome.structure];
        if (outcome.surface) {
            // A view at rest shows the finest.
            if (std::all_of(of.step.begin(), of.step.begin() + static_cast<std::ptrdiff_t>(outcome.step),
                            [](const auto& finer) { return !finer; }))
                ++computed_;
            of.step[outcome.step] = std::move(outcome.surface);
        } else {
            of.failed = true;
            error_ = std::move(outcome.error);
        }
    }
}

SurfaceChoice SurfaceChoices::choose(std::uint32_t structure, float level, std::size_t vertices_most) {
    if (!worker_) worker_ = std::make_unique<SurfaceWorker>(content_, vertices_max_);
    worker_->request(structure);
    const OfStructure& of = structures_[structure];
    SurfaceChoice choice;
    for (std::size_t step = kSurfaceSteps; step-- > 0;) {
        if (!of.step[step]) continue;
        const MolecularSurface& at_hand = *of.step[step];
        choice.triangles_most = at_hand.index.size() / 3;
        const bool coarsest = step + 1 == kSurfaceSteps;
        if (!coarsest && kSurfaceShares[step] > 1.001F * level) continue;
        if (at_hand.vertex.size() > vertices_most) {
            choice.too_large = true;
            continue;
        }
        choice.surface = of.step[step];
        choice.step = step;
    }
    std::size_t wanted = 0;
    while (wanted + 1 < kSurfaceSteps && kSurfaceShares[wanted] > 1.001F * level) ++wanted;
    choice.awaited = !of.failed && !of.step[wanted] && !choice.too_large;
    return choice;
}

}  // namespace tact
