#include "ipc/scene/mesh/refinement.hpp"

#include <algorithm>
#include <cmath>
#include <string>

#include "ipc/base/error.hpp"

namespace tact {
namespace {

constexpr std::uint32_t kCascadeMax = 1U << 16;  // nodes in a row; longer cascades are interrupted

}  // namespace

Refinement::Refinement(const VertexForest& forest, const RefinementSettings& settings)
    : forest_(forest),
      settings_(settings),
      frontier_(std::min(settings.nodes_max, forest.leaves())),
      mergeable_(std::min(settings.nodes_max, forest.leaves())) {
    settings_.nodes_max = std::min(settings_.nodes_max, forest.leaves());
    if (settings_.nodes_max < forest.roots())
        throw StartupError("refine a surface",
                           "its coarsest mesh has " + std::to_string(forest.roots()) +
                               " vertices, but at most " + std::to_string(settings.nodes_max) +
                               " may be active",
                           "allow more active vertices");
    state_.resize(forest.nodes(), {0, kNone});
    active_leaf_.resize(forest.leaves() / 64 + std::size_t{1});
    ask_full_.node.resize(settings_.splits_max);
    ask_rest_.node.resize(settings_.splits_max);
    ask_merge_.node.resize(settings_.merges_max);
    batch_.node.resize(settings_.splits_max);
    stack_.resize(kCascadeMax);
    begin();
}

void Refinement::begin() {
    for (std::uint32_t r = 0; r < forest_.roots(); ++r) {
        const VertexForest::Branch b = forest_.root(r);
        if (b.is_leaf())
            set_active(b.first, true);
        else
            list(frontier_, b.node);
    }
    vertices_ = forest_.roots();
    triangles_ = static_cast<std::uint32_t>(forest_.triangles_always().size());
}

float Refinement::limit_m(const ForestNode& node) const noexcept {
    return node.reach_m + settings_.filter.distance_m(node.error_m);
}

void Refinement::list(CutList& in, std::uint32_t n) noexcept {
    const ForestNode& node = forest_.node(n);
    state_[n].place = in.add(n, node.position_m, limit_m(node), node.reach_m);
}

void Refinement::unlist(CutList& in, std::uint32_t n) noexcept {
    const std::uint32_t place = state_[n].place, moved = in.remove(place, kNone);
    if (moved != kNone) state_[moved].place = place;
    state_[n].place = kNone;
}

void Refinement::set_filter(const RefineFilter& filter) noexcept {
    settings_.filter = filter;
    for (CutList* const in : {&frontier_, &mergeable_})
        for (std::uint32_t i = 0; i < in->size(); ++i) in->set_limit(i, limit_m(forest_.node(in->node(i))));
}

RefineStep Refinement::step(const Vec3& probe_m, const Vec3& velocity_m_s) noexcept {
    RefineStep out;
    if (probe_m.allFinite() && velocity_m_s.allFinite()) {
        RefineBox& box = out.path;
        for (std::size_t i = 0; i < 3; ++i) {
            const auto axis = static_cast<Eigen::Index>(i);
            const double way = velocity_m_s[axis] * settings_.look_ahead_s;
            box.centre_m[i] = static_cast<float>(std::clamp(probe_m[axis] + 0.5 * way, -1e7, 1e7));
            box.half_m[i] = static_cast<float>(std::min(0.5 * std::abs(way), 1e7));
        }
        // A merged node may be needed by a split, so merges come last, unless vertices are scarce.
        const bool merge_first = vertices_ + settings_.splits_max > settings_.nodes_max;
        if (merge_first) out.merges = merge_all(box);
        ask_full_.count = ask_rest_.count = 0;
        ask_full_.full = ask_rest_.full = false;
        frontier_.each(box, true, [&](std::uint32_t i) { ask(i, box); });
        std::uint32_t budget = settings_.splits_max;
        const Done near = split_queue(ask_full_, box, budget);
        const Done far = near == Done::out_of_budget ? near : split_queue(ask_rest_, box, budget);
        out.splits = settings_.splits_max - budget;
        if (!merge_first) out.merges = merge_all(box);
        out.full_detail = near == Done::yes;
        out.no_room = near == Done::no_room || far == Done::no_room;
        out.settled = near == Done::yes && far == Done::yes && out.splits == 0 && out.merges == 0;
    }
    out.vertices = vertices_;
    out.triangles = triangles_;
    return out;
}

std::uint32_t Refinement::descend(VertexForest::Branch b, std::uint32_t leaf) const noexcept {
    while (!b.is_leaf() && is_split(b.node)) b = forest_.child(b, leaf < forest_.node(b.node).middle ? 0 : 1);
    return b.is_leaf() ? b.first : forest_.leaves() + b.node;
}

std::uint32_t Refinement::place_of(std::uint32_t leaf) const noexcept {
    return is_active(leaf) ? leaf : descend(forest_.root(forest_.tree_of(leaf)), leaf);
}

float Refinement::deviation_m() const noexcept {
    float most = 0.0F;
    for (std::uint32_t i = 0; i < frontier_.size(); ++i)
        most = std::max(most, forest_.node(frontier_.node(i)).deviation_m);
    return most;
}

std::size_t Refinement::memory_bytes() const {
    return state_.capacity() * sizeof(State) + active_leaf_.capacity() * 8 + frontier_.bytes() +
           mergeable_.bytes() +
           4 * (ask_full_.node.capacity() + ask_rest_.node.capacity() + ask_merge_.node.capacity() +
                batch_.node.capacity() + stack_.capacity()) +
           sizeof(*this);
}

}  // namespace tact
