// The surfaces of structures that have been computed, and which of their steps of detail a frame draws.
//
// Thread   frame thread.
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "gui/docking/surface_worker.hpp"

namespace tact {

// `surface` null: none is at hand, or none within the limit (too_large).
struct SurfaceChoice {
    std::shared_ptr<const MolecularSurface> surface;
    std::size_t step = 0;
    bool awaited = false;            // a better one is being computed
    bool too_large = false;          // a finer one is at hand, or would be chosen, but for the limit
    std::size_t triangles_most = 0;  // of the finest at hand
};

class SurfaceChoices {
public:
    SurfaceChoices(std::shared_ptr<const SceneContent> content, std::size_t vertices_max);

    // Takes what was computed. Call it once a frame.
    void follow();
    // The finest step not above `level` (in (0, 1]) and with at most `vertices_most` vertices. The first call for a structure has its
    // surfaces computed.
    [[nodiscard]] SurfaceChoice choose(std::uint32_t structure, float level, std::size_t vertices_most);
    // Rises with every surface finer than those before it.
    [[nodiscard]] std::uint64_t computed() const { return computed_; }
    [[nodiscard]] const std::string& error() const { return error_; }  // the newest

private:
    struct OfStructure {
        std::array<std::shared_ptr<const MolecularSurface>, kSurfaceSteps> step;
        bool failed = false;
    };
    std::shared_ptr<const SceneContent> content_;
    std::size_t vertices_max_;  // of the finest step of a structure
    std::vector<OfStructure> structures_;
    std::uint64_t computed_ = 0;
    std::string error_;
    std::unique_ptr<SurfaceWorker> worker_;  // begun by the first choice
};

}  // namespace tact
