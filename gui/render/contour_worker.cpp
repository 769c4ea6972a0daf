#include "gui/render/contour_worker.hpp"

#include <sys/resource.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <exception>
#include <utility>

namespace tact {

ContourWorker::ContourWorker(std::shared_ptr<const SceneContent> content, RefineContour refine, Duration rest)
    : content_(std::move(content)), refine_(std::move(refine)), rest_(rest), thread_([this] { work(); }) {}

ContourWorker::~ContourWorker() {
    {
        const std::lock_guard lock(mutex_);
        stop_ = true;
    }
    changed_.notify_all();
    thread_.join();
}

void ContourWorker::request(std::size_t contour, std::optional<double> level) {
    if (contour >= kContoursMax) return;
    if (level && !std::isfinite(*level)) level.reset();
    {
        const std::lock_guard lock(mutex_);
        Contour& c = contour_[contour];
        if (c.requested == level) return;
        c.requested = level;
        ++c.request;
        c.requested_at = Monotonic::now();
        if (!level) c.news.reset();
    }
    changed_.notify_all();
}

void ContourWorker::set_vertices_max(std::uint32_t vertices) {
    const std::lock_guard lock(mutex_);
    vertices_max_ = std::min(vertices, kPlainVerticesMax);
}

std::optional<ContourOutcome> ContourWorker::take(std::size_t contour) {
    const std::lock_guard lock(mutex_);
    if (contour >= kContoursMax) return std::nullopt;
    return std::exchange(contour_[contour].news, std::nullopt);
}

void ContourWorker::work() {
    // Linux applies nice values per thread. A failure is harmless; raising the value never fails.
    (void)setpriority(PRIO_PROCESS, static_cast<id_t>(gettid()), 10);
    std::unique_lock lock(mutex_);
    while (!stop_) {
        const auto fresh = std::find_if(contour_.begin(), contour_.end(),
                                        [](const Contour& c) { return c.requested && c.shown != c.request; });
        if (fresh != contour_.end()) {
            extract(static_cast<std::size_t>(fresh - contour_.begin()), lock);
            continue;
        }
        const auto plain = std::find_if(contour_.begin(), contour_.end(), [this](const Contour& c) {
            return refine_ && c.requested && c.refined != c.request;
        });
        if (plain == contour_.end()) {
            changed_.wait(lock);
            continue;
        }
        Instant newest{};
        for (const Contour& c : contour_) newest = std::max(newest, c.requested_at);
        const Duration left = newest + rest_ - Monotonic::now();
        if (left > Duration::zero())
            changed_.wait_for(lock, left);
        else
            refine(static_cast<std::size_t>(plain - contour_.begin()), lock);
    }
}

void ContourWorker::extract(std::size_t contour, std::unique_lock<std::mutex>& lock) {
    Contour& c = contour_[contour];
    const double level = *c.requested;
    const std::uint64_t request = c.request;
    StrideLimits limits;
    limits.vertices_max = vertices_max_;
    const std::uint32_t stride = c.stride > 0 ? c.stride : first_stride(content_->grid, limits);
    lock.unlock();
    ContourOutcome outcome;
    outcome.level = level;
    outcome.stride = stride;
    const Instant begun = Monotonic::now();
    try {
        auto mesh =
            std::make_shared<PlainMesh>(extract_contour(grid(stride), level, [this](double, const char*) {
                const std::lock_guard inner(mutex_);
                return !stop_;
            }));
        outcome.extract_s = to_s(Monotonic::now() - begun);
        const double full = static_cast<double>(mesh->vertex.size()) * stride * stride;
        outcome.vertices_full = static_cast<std::uint32_t>(std::min(full, 1e9));
        outcome.plain = std::move(mesh);
    } catch (const Cancelled&) {
        lock.lock();
        return;
    } catch (const std::exception& e) {
        outcome.error = e.what();
    }
    lock.lock();
    c.shown = request;
    if (!outcome.plain) {
        c.refined = request;
    } else {
        const std::size_t vertices = outcome.plain->vertex.size();
        c.stride = next_stride(content_->grid, stride, outcome.extract_s, vertices, limits);
        // A mesh far too large is not even shown if a coarser one can be extracted at once.
        if (vertices > 2 * std::size_t{limits.vertices_max} && c.stride > stride) c.shown = request - 1;
        if (outcome.plain->empty()) c.refined = request;
    }
    if (c.requested && c.shown == request) c.news = std::move(outcome);
}

void ContourWorker::refine(std::size_t contour, std::unique_lock<std::mutex>& lock) {
    Contour& c = contour_[contour];
    const double level = *c.requested;
    const std::uint64_t request = c.request;
    std::array<std::uint64_t, kContoursMax> before{};
    for (std::size_t i = 0; i < kContoursMax; ++i) before[i] = contour_[i].request;
    lock.unlock();
    const auto stop = [&] {
        const std::lock_guard inner(mutex_);
        for (std::size_t i = 0; i < kContoursMax; ++i)
            if (contour_[i].request != before[i]) return true;
        return stop_;
    };
    ContourOutcome outcome;
    outcome.level = level;
    const Instant begun = Monotonic::now();
    bool cancelled = false;
    try {
        outcome.mesh = refine_(level, stop);
        if (outcome.mesh) outcome.vertices_full = outcome.mesh->vertices();
    } catch (const Cancelled&) {
        cancelled = true;
    } catch (const std::exception& e) {
        outcome.error = e.what();
    }
    outcome.extract_s = to_s(Monotonic::now() - begun);
    lock.lock();
    if (cancelled || c.request != request) return;
    c.refined = request;
    if (c.news && !outcome.mesh)
        c.news->error = std::move(outcome.error);  // the plain mesh was not taken yet and is still needed
    else
        c.news = std::move(outcome);
}

const DensityGrid& ContourWorker::grid(std::uint32_t stride) {
    if (stride <= 1) return content_->grid;
    if (thin_stride_ != stride) {
        thin_ = thinned(content_->grid, stride);
        thin_stride_ = stride;
    }
    return thin_;
}

}  // namespace tact
