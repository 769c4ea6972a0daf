#include "gui/docking/fit_history.hpp"

#include <algorithm>
#include <utility>

#include "ipc/base/units.hpp"

namespace tact {
namespace {

constexpr double kStill = 0.01, kTremble = 1.0;  // ångström, and degrees

bool same(const Pose& a, const Pose& b, double within) {
    return (a.p_m - b.p_m).norm() <= within * kAngstromM && a.q.angularDistance(b.q) <= within * kDegreeRad;
}

// The moves of `to` that differ from the poses in `from`.
FitHistory::Places difference(const FitHistory::Places& from, const FitHistory::Places& to,
                              double within = kStill) {
    FitHistory::Places moves;
    for (const FitHistory::Move& m : to) {
        const auto at =
            std::find_if(from.begin(), from.end(), [&](const FitHistory::Move& f) { return f.id == m.id; });
        if (at != from.end() && !same(at->T_model_body, m.T_model_body, within)) moves.push_back(m);
    }
    return moves;
}

bool differ(const FitHistory::Places& a, const FitHistory::Places& b) { return !difference(a, b).empty(); }

// A device trembles in the hand while it holds a body that undo() moved. Without a larger limit the tremble would be
// a gesture, and undo() could never go back twice.
bool differ(const FitHistory::Places& a, const FitHistory::Places& b, bool resumed) {
    return !difference(a, b, resumed ? kTremble : kStill).empty();
}

}  // namespace

void FitHistory::clear() { *this = FitHistory(); }

void FitHistory::observe(std::span<const Move> now, const Boundary& boundary) {
    if (begun_ && (boundary.grips < boundary_.grips || boundary.placements < boundary_.placements)) clear();
    if (!begun_) {
        begun_ = true;
        boundary_ = boundary;
        base_.assign(now.begin(), now.end());
        accepted_ = base_;
    }
    if (patience_ > 0) {
        boundary_ = boundary;
        if (boundary.placements < awaited_ && --patience_ > 0) return;
        patience_ = 0;
        resumed_ = true;
        now_.assign(now.begin(), now.end());
        base_ = now_;
        return;
    }
    if (!(boundary == boundary_)) {
        boundary_ = boundary;
        // The new gesture began between two observations: the old one ended at the last observed poses, except for
        // bodies that a command has placed since.
        commit();
        if (resumed_) base_ = now_;  // the next gesture begins from the tremble
        resumed_ = false;
        now_.assign(now.begin(), now.end());
        commit();
        return;
    }
    now_.assign(now.begin(), now.end());
}

void FitHistory::commit() {
    if (!differ(now_, base_, resumed_)) {
        // Bodies added meanwhile belong to the base.
        if (!now_.empty() && !(resumed_ && now_.size() == base_.size())) base_ = now_;
        return;
    }
    done_.push_back(std::exchange(base_, now_));
    if (done_.size() > kGesturesMax) done_.pop_front();
    undone_.clear();
}

std::size_t FitHistory::undoable() const { return done_.size() + (differ(now_, base_, resumed_) ? 1 : 0); }

FitHistory::Places FitHistory::undo() {
    commit();
    if (done_.empty()) return {};
    undone_.push_back(base_);
    Places to = std::move(done_.back());
    done_.pop_back();
    return go(to);
}

FitHistory::Places FitHistory::redo() {
    commit();
    if (undone_.empty()) return {};
    done_.push_back(base_);
    Places to = std::move(undone_.back());
    undone_.pop_back();
    return go(to);
}

FitHistory::Places FitHistory::revert() {
    commit();
    if (!begun_ || !differ(base_, accepted_)) return {};
    done_.push_back(base_);
    undone_.clear();
    return go(accepted_);
}

FitHistory::Places FitHistory::go(const Places& to) {
    Places moves = difference(now_, to);
    if (!moves.empty()) {
        awaited_ = (patience_ > 0 ? awaited_ : boundary_.placements) + moves.size();
        patience_ = kPatience;
        base_ = now_ = to;
    }
    return moves;
}

void FitHistory::accept() {
    commit();
    accepted_ = base_;
    done_.clear();
    undone_.clear();
}

bool FitHistory::snapshot(const std::string& name, const Places& places) {
    const bool known =
        std::any_of(snapshots_.begin(), snapshots_.end(), [&](const Snapshot& s) { return s.name == name; });
    if (known || snapshots_.size() >= kSnapshotsMax || places.empty()) return false;
    snapshots_.push_back({name, places});
    return true;
}

FitHistory::Places FitHistory::restore(const std::string& name) {
    const auto found =
        std::find_if(snapshots_.begin(), snapshots_.end(), [&](const Snapshot& s) { return s.name == name; });
    commit();
    if (found == snapshots_.end() || !differ(base_, found->places)) return {};
    done_.push_back(base_);
    undone_.clear();
    return go(found->places);
}

const FitHistory::Places& FitHistory::places_of(const std::string& snapshot) const {
    static const Places kNone;
    const auto found = std::find_if(snapshots_.begin(), snapshots_.end(),
                                    [&](const Snapshot& s) { return s.name == snapshot; });
    return found == snapshots_.end() ? kNone : found->places;
}

std::vector<std::string> FitHistory::snapshots() const {
    std::vector<std::string> names;
    for (const Snapshot& s : snapshots_) names.push_back(s.name);
    return names;
}

}  // namespace tact
