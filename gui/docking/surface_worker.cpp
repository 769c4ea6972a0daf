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
    double finest_a = finest_spacing_a(build_surface(atoms, kProbeSpacingA, going), vertices_max_);
    for (std::size_t i = 0; i < kSurfaceSteps; ++i) {
        const std::size_t step = i == 0 ? kSurfaceSteps - 1 : i - 1;
        auto surface = std::make_shared<MolecularSurface>(
            build_surface(atoms, spacing_of_step_a(finest_a, step), going));
        // A finer grid shows more folds, so the finest step may have more vertices than the probe told.
        while (step == 0 &&
               static_cast<double>(surface->vertex.size()) > kTooMany * static_cast<double>(vertices_max_)) {
            finest_a = finest_spacing_a(*surface, vertices_max_) * 1.02;
            *surface = build_surface(atoms, finest_a, going);
        }
        if (!put({structure, step, std::move(surface), {}})) return;
    }
}

}  // namespace tact
