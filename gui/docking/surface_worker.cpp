#include "gui/docking/surface_worker.hpp"

#include <sys/resource.h>
#include <unistd.h>

#include <exception>
#include <utility>

#include "gui/docking/docking_content.hpp"

namespace tact {
namespace {

// Coarse enough to take a few milliseconds, and to tell the size of the surface.
constexpr double kProbeSpacingA = 2.5;
// A finest step with so many times the vertices allowed is made again, coarser.
constexpr double kTooMany = 1.25;

}  // namespace

SurfaceWorker::SurfaceWorker(std::shared_ptr<const SceneContent> content, std::size_t vertices_max)
    : content_(std::move(content)),
      vertices_max_(vertices_max),
      requested_(docking_of(*content_).bodies.size(), false),
      thread_([this] { work(); }) {}

SurfaceWorker::~SurfaceWorker() {
    {
        const std::lock_guard lock(mutex_);
        stop_ = true;
    }
    changed_.notify_all();
    thread_.join();
}

void SurfaceWorker::request(std::uint32_t structure) {
    {
        const std::lock_guard lock(mutex_);
        if (structure >= requested_.size() || requested_[structure]) return;
        requested_[structure] = true;
        queue_.push_back(structure);
    }
    changed_.notify_all();
}

std::vector<SurfaceOutcome> SurfaceWorker::take() {
    const std::lock_guard lock(mutex_);
    return std::exchange(finished_, {});
}

bool SurfaceWorker::put(SurfaceOutcome outcome) {
    const std::lock_guard lock(mutex_);
    if (!stop_) finished_.push_back(std::move(outcome));
    return !stop_;
}

void SurfaceWorker::work() {
    // Linux applies nice values per thread. A failure is harmless; raising the value never fails.
    (void)setpriority(PRIO_PROCESS, static_cast<id_t>(gettid()), 10);
    std::unique_lock lock(mutex_);
    while (true) {
        changed_.wait(lock, [this] { return stop_ || !queue_.empty(); });
        if (stop_) return;
        const std::uint32_t structure = queue_.front();
        queue_.pop_front();
        lock.unlock();
        try {
            compute(structure);
        } catch (const Cancelled&) {
        } catch (const std::exception& e) {
            (void)put({structure, 0, nullptr, e.what()});
        }
        lock.lock();
    }
}

void SurfaceWorker::compute(std::uint32_t structure) {
    const Structure& atoms = docking_of(*content_).bodies[structure];
    const Progress going = [this](double, const char*) {
        const std::lock_guard lock(mutex_);
        return !stop_;
    };
    const auto built = [&](double spacing_a) {
        return std::make_shared<const MolecularSurface>(build_surface(atoms, spacing_a, going));
    };
    const auto give = [&](std::size_t step, std::shared_ptr<const MolecularSurface> surface) {
        return put({structure, step, std::move(surface), {}});
    };
    const auto probe = built(kProbeSpacingA);
    double finest_a = finest_spacing_a(*probe, vertices_max_);
    if (!give(kSurfaceSteps - 1, probe)) return;
    auto finest = built(finest_a);
    // A finer grid shows more folds, so it may have more vertices than the probe told.
    while (static_cast<double>(finest->vertex.size()) > kTooMany * static_cast<double>(vertices_max_)) {
        finest_a = 1.02 * finest_spacing_a(*finest, vertices_max_);
        finest = built(finest_a);
    }
    if (!give(0, std::move(finest))) return;
    for (std::size_t step = 1; step < kSurfaceSteps; ++step)
        if (!give(step, built(spacing_of_step_a(finest_a, step)))) return;
}

}  // namespace tact
