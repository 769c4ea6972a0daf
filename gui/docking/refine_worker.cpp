#include "gui/docking/refine_worker.hpp"

#include "gui/docking/docking_content.hpp"

#include <sys/resource.h>
#include <unistd.h>

#include <exception>

namespace tact {

void RefineWorker::start(const FitBody& body) {
    cancelled_ = false;
    outcome_ = std::async(std::launch::async, [this, body] { return work(body); });
}

std::optional<RefineOutcome> RefineWorker::poll() {
    if (!running() || outcome_.wait_for(std::chrono::seconds(0)) != std::future_status::ready)
        return std::nullopt;
    return outcome_.get();
}

RefineOutcome RefineWorker::work(const FitBody& body) {
    (void)setpriority(PRIO_PROCESS, static_cast<id_t>(gettid()), 10);  // this thread, on Linux
    RefineOutcome outcome{body, {}, {}};
    try {
        const SceneMeta& meta = content_->meta;
        if (!map_) map_ = std::make_unique<DensityMap>(content_->grid, meta.map_background, meta.map_sigma);
        outcome.result = refine(*map_, docking_of(*content_).bodies.at(body.structure), body.T_model_body, {},
                                [this](std::uint32_t, double) { return !cancelled_.load(); });
    } catch (const std::exception& e) {
        outcome.error = e.what();
    }
    return outcome;
}

}  // namespace tact
