#include "gui/docking/fit_worker.hpp"

#include "gui/docking/docking_content.hpp"

#include <sys/resource.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <exception>
#include <iterator>

#include "ipc/base/units.hpp"

namespace tact {

namespace {

bool bent_apart(std::span<const float> a, std::span<const float> b) {
    for (std::size_t k = 0; k < std::max(a.size(), b.size()); ++k) {
        const float x = k < a.size() ? a[k] : 0.0F, y = k < b.size() ? b[k] : 0.0F;
        if (std::abs(static_cast<double>(x) - static_cast<double>(y)) > 0.01 * kAngstromM) return true;
    }
    return false;
}

}  // namespace

bool moved(std::span<const FitBody> a, std::span<const FitBody> b) {
    return !std::equal(a.begin(), a.end(), b.begin(), b.end(), [](const FitBody& x, const FitBody& y) {
        return x.id == y.id && x.structure == y.structure &&
               (x.T_model_body.p_m - y.T_model_body.p_m).norm() <= 0.01 * kAngstromM &&
               x.T_model_body.q.angularDistance(y.T_model_body.q) <= 0.01 * kDegreeRad &&
               !bent_apart(x.amplitude_m, y.amplitude_m);
    });
}

FitWorker::FitWorker(std::shared_ptr<const SceneContent> content, Duration pause)
    : content_(std::move(content)), pause_(pause), thread_([this] { work(); }) {}

FitWorker::~FitWorker() {
    {
        const std::lock_guard lock(mutex_);
        stop_ = true;
    }
    changed_.notify_all();
    thread_.join();
}

void FitWorker::request(std::span<const FitBody> bodies, std::optional<double> contour, bool residues) {
    {
        const std::lock_guard lock(mutex_);
        residues_ = residues;
        contour_ = contour.value_or(content_->meta.contour);
        requested_.clear();
        std::copy_if(bodies.begin(), bodies.end(), std::back_inserter(requested_),
                     [&](const FitBody& b) { return b.structure < docking_of(*content_).bodies.size(); });
    }
    changed_.notify_all();
}

bool FitWorker::take(FitOutcome& outcome) {
    const std::lock_guard lock(mutex_);
    if (outcome_.number == outcome.number) return false;
    outcome = outcome_;
    return true;
}

// The bodies as they are bent, at their places.
struct FitWorker::Placed {
    std::vector<Structure> structure;
    std::vector<PlacedStructure> at;

    Placed(const DockingContent& docking, std::span<const FitBody> bodies) {
        for (const FitBody& b : bodies)
            structure.push_back(
                bent_structure(docking.bodies[b.structure], docking.modes_of(b.structure), b.amplitude_m));
        for (std::size_t i = 0; i < bodies.size(); ++i) at.push_back({&structure[i], bodies[i].T_model_body});
    }
};

bool FitWorker::stopping() {
    const std::lock_guard lock(mutex_);
    return stop_;
}

void FitWorker::work() {
    // Linux applies nice values per thread. A failure is harmless; raising the value never fails.
    (void)setpriority(PRIO_PROCESS, static_cast<id_t>(gettid()), 10);
    std::vector<FitBody> places;
    double contour = 0.0;
    std::unique_lock lock(mutex_);
    const auto changed = [&] { return moved(requested_, places) || contour_ != contour; };
    while (true) {
        changed_.wait(lock, [&] {
            return stop_ || (!requested_.empty() && (changed() || (residues_ && !outcome_.residues_current)));
        });
        if (stop_) return;
        places = requested_;
        contour = contour_;
        const bool residues = residues_;
        const std::uint64_t number = outcome_.number + 1;
        lock.unlock();
        const Placed placed(docking_of(*content_), places);
        FitOutcome outcome = compute(places, placed, contour);
        outcome.number = number;
        lock.lock();
        outcome.residues = std::move(outcome_.residues);
        outcome_ = std::move(outcome);
        double busy_s = 10.0 * outcome_.compute_s;
        if (residues && outcome_.good) {
            lock.unlock();
            const Instant begun = Monotonic::now();
            std::vector<std::vector<ResidueFit>> found = residues_of(placed, contour);
            busy_s += 2.0 * to_s(Monotonic::now() - begun);
            lock.lock();
            outcome_.residues = std::move(found);
            outcome_.residues_current = !changed();
            ++outcome_.number;
        }
        const Duration rest =
            std::max(pause_, std::chrono::nanoseconds(static_cast<std::int64_t>(1e9 * busy_s)));
        if (changed_.wait_for(lock, rest, [&] { return stop_; })) return;
    }
}

FitSettings FitWorker::settings(double contour) const {
    return {.resolution_m = content_->meta.resolution_m,
            .contour = contour,
            .background = content_->meta.map_background,
            .sigma = content_->meta.map_sigma};
}

FitOutcome FitWorker::compute(std::vector<FitBody> bodies, const Placed& placed, double contour) const {
    FitOutcome outcome;
    const Instant begun = Monotonic::now();
    outcome.contour = contour;
    outcome.resolution_m = content_->meta.resolution_m;
    outcome.body = std::move(bodies);
    try {
        FitOfBodies fit = fit_of_bodies(content_->grid, placed.at, settings(contour));
        outcome.all = fit.all;
        outcome.of = std::move(fit.body);
        outcome.good = true;
    } catch (const std::exception& e) {
        outcome.error = e.what();
    }
    outcome.compute_s = to_s(Monotonic::now() - begun);
    return outcome;
}

std::vector<std::vector<ResidueFit>> FitWorker::residues_of(const Placed& placed, double contour) {
    std::vector<std::vector<ResidueFit>> all;
    std::vector<PlacedStructure> order = placed.at;
    for (std::size_t i = 0; i < order.size() && !stopping(); ++i) {
        std::swap(order[0], order[i]);  // residue_fit measures the first
        all.push_back(residue_fit(content_->grid, order, settings(contour), kResidueWindow));
        std::swap(order[0], order[i]);
    }
    return all;
}

}  // namespace tact
