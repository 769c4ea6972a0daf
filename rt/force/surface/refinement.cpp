#include "rt/force/surface/refinement.hpp"

#include <algorithm>
#include <cmath>
#include <string>

#include "ipc/base/error.hpp"

namespace tact {
namespace {

constexpr std::uint32_t kCascadeMax = 1U << 16;  // of places: longer cascades end in the middle

}  // namespace

Refinement::Refinement(const VertexForest& forest, const RefineSettings& settings)
    : forest_(forest), settings_(settings), near_(settings.near_max) {
    settings_.nodes_max = std::min(settings_.nodes_max, forest.leaves());
    if (settings_.nodes_max < forest.roots())
        throw StartupError("refine a surface",
                           "its coarsest mesh has " + std::to_string(forest.roots()) +
                               " vertices, and no more than " + std::to_string(settings.nodes_max) +
                               " may be active",
                           "allow more active vertices");
    if (settings_.nodes_max > 1U << 28)
        throw StartupError("refine a surface", "more than 2^28 active vertices are asked for",
                           "allow fewer active vertices");
    // A surface has two triangles a vertex; edges with more than two triangles bring more.
    const std::uint64_t triangles = std::min<std::uint64_t>(
        forest.triangles_always().size() + 3 * std::uint64_t{settings_.nodes_max}, forest.triangles());
    record_.resize(2 * std::size_t{settings_.nodes_max} + 2);
    key_.resize(record_.size());
    size_.resize(record_.size());
    triangle_.resize(static_cast<std::size_t>(triangles));
    leaves_.resize(triangle_.size());
    splittable_.reserve(settings_.nodes_max);
    mergeable_.reserve(settings_.nodes_max);
    stack_.resize(kCascadeMax);
    begin();
}

void Refinement::begin() {
    for (std::uint32_t r = 0; r < forest_.roots(); ++r) fill(r, forest_.root(r), kNone);
    vertices_ = forest_.roots();
    record_used_ = vertices_ + vertices_ % 2;
    for (std::uint32_t r = 0; r < forest_.roots(); ++r)
        if (record_[r].node != kNoForestNode) list(splittable_, r);
    for (const ForestTriangle& t : forest_.triangles_always()) {
        const std::uint32_t s = take_triangle(t);
        for (std::uint32_t k = 0; k < 3; ++k) put(4 * s + k, forest_.tree_of(t.leaf[k]));
    }
}

void Refinement::fill(std::uint32_t record, const VertexForest::Branch& branch,
                      std::uint32_t parent) noexcept {
    const std::uint32_t parent_number = parent == kNone ? kNone : key_[parent].number;
    if (branch.is_leaf()) {
        record_[record] = {forest_.leaf_position_m(branch.first), kNoForestNode, parent, kNone, kNone, kNone};
        key_[record] = {branch.first, branch.end, 0, parent_number};
        size_[record] = {};
    } else {
        const ForestNode& node = forest_.node(branch.node);
        record_[record] = {node.position_m, branch.node, parent, kNone, kNone, kNone};
        key_[record] = {branch.first, branch.end, node.number, parent_number};
        size_[record] = {node.reach_m, node.error_m};
        // If it is split, then soon: call for what that needs.
        __builtin_prefetch(&node + 1);
        __builtin_prefetch(&node + (node.middle - branch.first));
        __builtin_prefetch(forest_.first_triangle_of(branch.node));
    }
}

std::uint32_t Refinement::take_pair() noexcept {
    const std::uint32_t first = free_pair_;
    if (first == kNone) {
        record_used_ += 2;
        return record_used_ - 2;
    }
    free_pair_ = record_[first].head;
    return first;
}

void Refinement::release_pair(std::uint32_t first) noexcept {
    record_[first].head = free_pair_;
    free_pair_ = first;
}

std::uint32_t Refinement::take_triangle(const ForestTriangle& triangle) noexcept {
    std::uint32_t s = free_triangle_;
    if (s != kNone)
        free_triangle_ = triangle_[s].next[0];
    else
        s = triangle_used_++;
    triangle_[s].number = triangle.number;
    triangle_[s].seen = 0;
    leaves_[s].leaf = triangle.leaf;
    ++triangles_;
    return s;
}

void Refinement::release_triangle(std::uint32_t s) noexcept {
    triangle_[s].number = kNone;
    triangle_[s].next[0] = free_triangle_;
    free_triangle_ = s;
    --triangles_;
}

void Refinement::put(std::uint32_t corner, std::uint32_t record) noexcept {
    Triangle& t = triangle_[corner / 4];
    t.at[corner % 4] = record;
    t.next[corner % 4] = record_[record].head;
    record_[record].head = corner;
}

void Refinement::unlink(std::uint32_t corner, std::uint32_t record) noexcept {
    std::uint32_t* link = &record_[record].head;
    while (*link != corner) link = &triangle_[*link / 4].next[*link % 4];
    *link = triangle_[corner / 4].next[corner % 4];
}

void Refinement::set_limits(Entry& entry) const noexcept {
    const Size& size = size_[entry.record];
    entry.limit_m = size.reach_m + settings_.filter.distance_m(size.error_m);
    entry.full_limit_m = size.reach_m + settings_.filter.radius_m();
}

void Refinement::list(List& in, std::uint32_t record) noexcept {
    record_[record].listed = static_cast<std::uint32_t>(in.size());
    in.push_back({record_[record].position_m, 0.0F, 0.0F, record, kNone, 0});
    set_limits(in.back());
}

void Refinement::unlist(List& in, std::uint32_t record) noexcept {
    const std::uint32_t place = record_[record].listed;
    if (place == kNone) return;
    in[place] = in.back();
    record_[in[place].record].listed = place;
    in.pop_back();
    record_[record].listed = kNone;
}

void Refinement::set_filter(const RefineFilter& filter) noexcept {
    settings_.filter = filter;
    for (Entry& e : splittable_) set_limits(e);
    for (Entry& e : mergeable_) set_limits(e);
}

std::uint32_t Refinement::merge_all(const Box& box) noexcept {
    std::uint32_t merges = 0;
    std::size_t left = mergeable_.size();
    for (; left > 0 && merges < settings_.merges_max; --left) {
        if (merge_cursor_ >= mergeable_.size()) merge_cursor_ = 0;
        Entry& e = mergeable_[merge_cursor_];
        if (box.distance_m(e.position_m) < e.limit_m || blocked(e)) {
            ++merge_cursor_;
            continue;
        }
        merge(e.record);  // another entry comes to its place, and its parent may have been added
        ++merges;
        left = std::min(left + 1, mergeable_.size() + 1);
    }
    return merges;
}

Refinement::Done Refinement::split_all(const Box& box, bool full, std::uint32_t& budget) noexcept {
    Done all = Done::yes;
    for (std::size_t i = 0; i < splittable_.size();) {
        const Entry& e = splittable_[i];
        const float distance = box.distance_m(e.position_m);
        if (!(distance < (full ? e.full_limit_m : e.limit_m))) {
            ++i;
            continue;
        }
        const Done done = split_with_forced(e.record, budget);  // another entry comes to its place
        if (done == Done::out_of_budget) return done;
        if (done == Done::no_room) {
            all = done;
            ++i;
        }
    }
    return all;
}

RefineStep Refinement::step(const Vec3& probe_m, const Vec3& velocity_m_s) noexcept {
    RefineStep out;
    if (probe_m.allFinite() && velocity_m_s.allFinite()) {
        Box box{};
        for (std::size_t i = 0; i < 3; ++i) {
            const auto axis = static_cast<Eigen::Index>(i);
            const double way = velocity_m_s[axis] * settings_.look_ahead_s;
            box.centre_m[i] = static_cast<float>(std::clamp(probe_m[axis] + 0.5 * way, -1e7, 1e7));
            box.half_m[i] = static_cast<float>(std::min(0.5 * std::abs(way), 1e7));
        }
        out.merges = merge_all(box);
        std::uint32_t budget = settings_.splits_max;
        const Done near = split_all(box, true, budget);
        const Done far = near == Done::out_of_budget ? near : split_all(box, false, budget);
        out.splits = settings_.splits_max - budget;
        out.full_detail = near == Done::yes;
        out.no_room = near == Done::no_room || far == Done::no_room;
        out.settled = near == Done::yes && far == Done::yes && out.splits == 0 && out.merges == 0;
        collect(box, out.full_detail);
    }
    out.vertices = vertices_;
    out.triangles = triangles_;
    return out;
}

void Refinement::collect(const Box& box, bool full_detail) noexcept {
    NearTriangles& to = near_.back();
    ++steps_;
    to.step = steps_;
    to.full_detail = full_detail;
    to.complete = true;
    to.count = 0;
    const auto near_m = static_cast<float>(settings_.near_m);
    for (std::size_t i = 0; i < 3; ++i) {
        to.low_m[i] = box.centre_m[i] - box.half_m[i] - near_m;
        to.high_m[i] = box.centre_m[i] + box.half_m[i] + near_m;
    }
    const auto seen = static_cast<std::uint32_t>(steps_);
    // A leaf is taken where its parent reaches the box: that holds its triangles too.
    const auto reaches = [&](std::uint32_t record) {
        const Record& r = record_[record];
        return r.node == kNoForestNode || box.distance_m(r.position_m) <= near_m + size_[record].reach_m;
    };
    std::uint32_t top = 0;
    for (std::uint32_t root = 0; root < forest_.roots() && to.complete; ++root) {
        stack_[top++] = root;
        while (top > 0) {
            const std::uint32_t now = stack_[--top];
            if (!reaches(now)) continue;
            const Record& r = record_[now];
            if (!r.at_cut()) {
                if (top + 2 > stack_.size()) {
                    to.complete = false;
                    continue;
                }
                stack_[top++] = r.child;
                stack_[top++] = r.child + 1;
                continue;
            }
            for (std::uint32_t c = r.head; c != kNone; c = triangle_[c / 4].next[c % 4]) {
                Triangle& t = triangle_[c / 4];
                if (t.seen == seen) continue;
                t.seen = seen;
                if (to.count == to.triangle.size()) {
                    to.complete = false;
                    break;
                }
                to.triangle[to.count++] = {
                    {record_[t.at[0]].position_m, record_[t.at[1]].position_m, record_[t.at[2]].position_m},
                    t.number};
            }
        }
    }
    near_.publish();
}

std::size_t Refinement::memory_bytes() const {
    return record_.capacity() * (sizeof(Record) + sizeof(Key) + sizeof(Size)) +
           triangle_.capacity() * (sizeof(Triangle) + sizeof(Leaves)) +
           (splittable_.capacity() + mergeable_.capacity()) * sizeof(Entry) + 4 * stack_.capacity() +
           3 * settings_.near_max * sizeof(NearTriangle) + sizeof(*this);
}

}  // namespace tact
