// Computes the surfaces of structures in the background: of each, a coarse one that takes a few milliseconds and serves as the last step of
// detail for now, then the finest step, then the others.
//
// Finest   has about vertices_max vertices, or the spacing kFinestSpacingA.
// Thread   its own, at low priority. Callers never wait for it; the destructor alone waits for the current slice.
// Memory   one grid (kSurfaceVoxelsMax) at a time; results stay with who takes them.
// Fails by outcome.error, once for a structure; it is not tried again.
#pragma once

#include <condition_variable>
#include <cstdint>
#include <deque>
#include <memory>
#include <mutex>
#include <string>
#include <thread>
#include <vector>

#include "gui/docking/molecular_surface.hpp"
#include "gui/render/scene_content.hpp"

namespace tact {

struct SurfaceOutcome {
    std::uint32_t structure = 0;  // index in the scene
    std::size_t step = 0;
    std::shared_ptr<const MolecularSurface> surface;
    std::string error;  // why there is none
};

class SurfaceWorker {
public:
    SurfaceWorker(std::shared_ptr<const SceneContent> content, std::size_t vertices_max);
    ~SurfaceWorker();
    SurfaceWorker(const SurfaceWorker&) = delete;
    SurfaceWorker& operator=(const SurfaceWorker&) = delete;

    // A structure that was requested before is not computed again.
    void request(std::uint32_t structure);
    // What was finished since the last call.
    [[nodiscard]] std::vector<SurfaceOutcome> take();

private:
    void work();
    void compute(std::uint32_t structure);
    bool put(SurfaceOutcome outcome);  // false: stop

    const std::shared_ptr<const SceneContent> content_;
    const std::size_t vertices_max_;
    std::mutex mutex_;
    std::condition_variable changed_;
    std::vector<bool> requested_;
    std::deque<std::uint32_t> queue_;
    std::vector<SurfaceOutcome> finished_;
    bool stop_ = false;
    std::thread thread_;
};

}  // namespace tact
