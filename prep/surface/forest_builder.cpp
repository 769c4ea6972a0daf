#include "prep/surface/forest_builder.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include "ipc/base/error.hpp"
#include "ipc/base/huge_pages.hpp"
#include "prep/mesh/simplify.hpp"
#include "prep/surface/forest_needs.hpp"
#include "prep/surface/range_max.hpp"

namespace tact {
namespace {

constexpr float kFar = std::numeric_limits<float>::max();
constexpr float kWider = 1.000001F;  // covers rounding at each step up

float distance(const float* a, const float* b) { return std::hypot(a[0] - b[0], a[1] - b[1], a[2] - b[2]); }

class ForestBuilder {
public:
    ForestBuilder(TriangleMesh& mesh, std::vector<Contraction> steps)
        : mesh_(mesh),
          steps_(std::move(steps)),
          leaves_(static_cast<std::uint32_t>(mesh.vertices())),
          nodes_(static_cast<std::uint32_t>(steps_.size())) {}

    BuiltForest build() {
        link();
        measure();
        order();
        out_.data.need = forest_needs(mesh_.triangle, leaves_, *ancestors_, number_, out_.data.node);
        place_triangles();
        return std::move(out_);
    }

private:
    // Indices of the arrays below: input leaf v is v, the node made by step s is leaves_ + s.
    void link() {
        child_.resize(nodes_);
        parent_.assign(std::size_t{leaves_} + nodes_, kNoForestNode);
        count_.assign(std::size_t{leaves_} + nodes_, 1);
        std::vector<std::uint32_t> now(leaves_);
        for (std::uint32_t v = 0; v < leaves_; ++v) now[v] = v;
        for (std::uint32_t s = 0; s < nodes_; ++s) {
            child_[s] = {now[steps_[s].kept], now[steps_[s].gone]};
            const std::uint32_t made = leaves_ + s;
            for (const std::uint32_t c : child_[s]) parent_[c] = made;
            count_[made] = count_[child_[s][0]] + count_[child_[s][1]];
            now[steps_[s].kept] = made;
        }
        ancestors_.emplace(parent_);
    }
    // Position of a leaf or node.
    [[nodiscard]] const float* at(std::uint32_t place) const {
        return place < leaves_ ? &mesh_.position_m[3 * std::size_t{place}]
                               : steps_[place - leaves_].position_m.data();
    }
    struct Box {  // bounding box of points
        std::array<float, 3> low{kFar, kFar, kFar}, high{-kFar, -kFar, -kFar};
        void add(const float* p) {
            for (std::size_t i = 0; i < 3; ++i) {
                low[i] = std::min(low[i], p[i]);
                high[i] = std::max(high[i], p[i]);
            }
        }
        void add(const Box& b) {
            for (std::size_t i = 0; i < 3; ++i) {
                low[i] = std::min(low[i], b.low[i]);
                high[i] = std::max(high[i], b.high[i]);
            }
        }
        // Chebyshev distance to the farthest point of the box.
        [[nodiscard]] float farthest(const float* p) const {
            float most = 0.0F;
            for (std::size_t i = 0; i < 3; ++i) most = std::max({most, high[i] - p[i], p[i] - low[i]});
            return most * kWider;
        }
    };
    // Computes reach, error and deviation of every node, from the leaves up.
    void measure() {
        std::vector<Box> box(std::size_t{leaves_} + nodes_);  // of all triangles below
        for (std::size_t t = 0; t < mesh_.triangle.size(); t += 3)
            for (std::size_t i = 0; i < 9; ++i)
                box[mesh_.triangle[t + i / 3]].add(at(mesh_.triangle[t + i % 3]));
        reach_.assign(std::size_t{leaves_} + nodes_, 0.0F);
        for (std::uint32_t v = 0; v < leaves_; ++v) reach_[v] = box[v].farthest(at(v));
        float largest = 0.0F;
        for (const float x : mesh_.position_m) largest = std::max(largest, std::abs(x));
        deviation_.assign(nodes_, 0.0F);
        error_.assign(nodes_, largest * 1e-9F);  // never 0, so that full refinement also splits flat regions
        for (std::uint32_t s = 0; s < nodes_; ++s) {
            const std::uint32_t made = leaves_ + s;
            error_[s] = std::max(error_[s], steps_[s].own_error_m);
            for (const std::uint32_t c : child_[s]) {
                deviation_[s] = std::max(
                    deviation_[s],
                    (distance(at(made), at(c)) + (c >= leaves_ ? deviation_[c - leaves_] : 0.0F)) * kWider);
                box[made].add(box[c]);
                if (c >= leaves_) error_[s] = std::max(error_[s], error_[c - leaves_]);
            }
            reach_[made] = box[made].farthest(at(made));
        }
    }
    // Spans: until a triangle vanishes, each of its corners is at any of the nodes that represent it. Computes the box
    // of these positions for a node's own triangles, then for all below it.
    void measure_spans(const std::vector<std::uint32_t>& node_of_triangle) {
        constexpr int kWalked = 64;  // beyond this depth the reach is used instead
        std::vector<std::uint32_t> place(nodes_);
        for (std::uint32_t s = 0; s < nodes_; ++s) place[number_[leaves_ + s]] = leaves_ + s;
        std::vector<Box> box(nodes_);
        for (std::size_t t = 0; t < node_of_triangle.size(); ++t) {
            if (node_of_triangle[t] == nodes_) continue;
            const std::uint32_t of = place[node_of_triangle[t]];
            Box& own = box[of - leaves_];
            for (std::size_t i = 0; i < 3; ++i) {
                std::uint32_t now = mesh_.triangle[3 * t + i];
                int left = kWalked;
                for (; now < of && left > 0; --left) {
                    own.add(at(now));
                    now = parent_[now];
                }
                if (now < of) {
                    const std::uint32_t top = ancestors_->highest(now, of);
                    const float reach = reach_of_places(top);
                    const float* const p = at(top);
                    for (const float side : {-reach, reach})
                        own.add(std::array{p[0] + side, p[1] + side, p[2] + side}.data());
                }
            }
        }
        for (std::uint32_t s = 0; s < nodes_; ++s) {
            const std::uint32_t made = leaves_ + s;
            out_.data.node[number_[made]].own_span_m = box[s].farthest(at(made));
            for (const std::uint32_t c : child_[s])
                if (c >= leaves_) box[s].add(box[c - leaves_]);
            out_.data.node[number_[made]].span_m = box[s].farthest(at(made));
        }
    }
    // All positions that represent the leaves below p lie within this distance of p, even outside their triangles.
    [[nodiscard]] float reach_of_places(std::uint32_t p) const {
        return p < leaves_ ? 0.0F : deviation_[p - leaves_];
    }
    // Numbers leaves and nodes: trees along a space-filling curve, each in preorder.
    void order() {
        std::vector<std::uint32_t> roots;
        for (std::uint32_t p = 0; p < parent_.size(); ++p)
            if (parent_[p] == kNoForestNode) roots.push_back(p);
        sort_along_curve(roots);
        out_.data.leaves = leaves_;
        out_.data.node.resize(nodes_);
        out_.order.reserve(leaves_);
        number_.assign(std::size_t{leaves_} + nodes_, kNoForestNode);
        std::uint32_t next_node = 0;
        std::vector<std::uint32_t> stack;
        for (const std::uint32_t root : roots) {
            out_.data.root_first.push_back(static_cast<std::uint32_t>(out_.order.size()));
            stack.push_back(root);
            while (!stack.empty()) {
                const std::uint32_t p = stack.back();
                stack.pop_back();
                if (p < leaves_) {
                    number_[p] = static_cast<std::uint32_t>(out_.order.size());
                    out_.order.push_back(p);
                    continue;
                }
                const std::uint32_t s = p - leaves_;
                number_[p] = next_node;
                const auto first = static_cast<std::uint32_t>(out_.order.size());
                out_.data.node[next_node++] = {
                    .position_m = steps_[s].position_m,
                    .error_m = error_[s],
                    .deviation_m = deviation_[s],
                    .reach_m = reach_[p],
                    .span_m = 0.0F,
                    .own_span_m = 0.0F,
                    .first = first,
                    .middle = first + count_[child_[s][0]],
                    .end = first + count_[p],
                    .parent = parent_[p] == kNoForestNode ? kNoForestNode : number_[parent_[p]],
                    .number = s + 1,
                    .first_triangle = 0,
                    .first_need = 0,
                    .reserved = 0};
                stack.push_back(child_[s][1]);
                stack.push_back(child_[s][0]);
            }
        }
        out_.data.root_first.push_back(leaves_);
    }
    void sort_along_curve(std::vector<std::uint32_t>& roots) const {
        std::array<float, 3> low{}, high{};
        for (std::size_t i = 0; i < 3; ++i) {
            low[i] = high[i] = mesh_.position_m[i];
            for (std::size_t v = 0; v < leaves_; ++v) {
                low[i] = std::min(low[i], mesh_.position_m[3 * v + i]);
                high[i] = std::max(high[i], mesh_.position_m[3 * v + i]);
            }
        }
        const auto key = [&](std::uint32_t p) {
            std::uint64_t code = 0;
            for (std::size_t i = 0; i < 3; ++i) {
                const float part =
                    std::clamp((at(p)[i] - low[i]) / std::max(high[i] - low[i], 1e-30F), 0.0F, 1.0F);
                const auto cell = static_cast<std::uint64_t>(part * 1048575.0F);
                for (unsigned bit = 0; bit < 20; ++bit) code |= (cell >> bit & 1U) << (3 * bit + i);
            }
            return code;
        };
        std::vector<std::pair<std::uint64_t, std::uint32_t>> keyed;
        keyed.reserve(roots.size());
        for (const std::uint32_t p : roots) keyed.emplace_back(key(p), p);
        std::sort(keyed.begin(), keyed.end());
        std::transform(keyed.begin(), keyed.end(), roots.begin(), [](const auto& k) { return k.second; });
    }
    // A triangle appears with the first merge of two of its corners, from the leaves up. Two leaves meet in the node of
    // the highest merge between them, because numbers rise towards the root; kWall separates trees.
    void place_triangles() {
        constexpr std::uint32_t kWall = UINT32_MAX;
        HugeVector<std::uint32_t> merge(leaves_, kWall);
        std::vector<std::uint32_t> node_of(nodes_ + std::size_t{1}, nodes_);
        for (std::uint32_t i = 0; i < nodes_; ++i) {
            merge[out_.data.node[i].middle] = out_.data.node[i].number;
            node_of[out_.data.node[i].number] = i;
        }
        const RangeMax highest_merge(merge);
        std::vector<std::uint32_t> node(mesh_.triangles());
        std::vector<std::uint32_t> first(nodes_ + std::size_t{2}, 0);
        for (std::size_t t = 0; t < mesh_.triangles(); ++t) {
            std::array<std::uint32_t, 3> v{};
            for (std::size_t i = 0; i < 3; ++i) v[i] = number_[mesh_.triangle[3 * t + i]];
            std::sort(v.begin(), v.end());
            const std::uint32_t soonest =
                std::min(highest_merge.of(v[0] + 1, v[1] + 1), highest_merge.of(v[1] + 1, v[2] + 1));
            node[t] = soonest == kWall ? nodes_ : node_of[soonest];
            ++first[node[t] + 1];
        }
        measure_spans(node);
        std::vector<float> position(mesh_.position_m.size());
        for (std::uint32_t v = 0; v < leaves_; ++v)
            std::copy_n(&mesh_.position_m[3 * std::size_t{out_.order[v]}], 3, &position[3 * std::size_t{v}]);
        mesh_.position_m = std::move(position);
        for (std::uint32_t& v : mesh_.triangle) v = number_[v];
        for (std::size_t i = 0; i <= nodes_; ++i) first[i + 1] += first[i];
        for (std::uint32_t i = 0; i < nodes_; ++i) out_.data.node[i].first_triangle = first[i];
        out_.data.triangle.resize(mesh_.triangles());
        for (std::uint32_t t = 0; t < node.size(); ++t)
            out_.data.triangle[first[node[t]]++] = {
                t,
                {mesh_.triangle[3 * std::size_t{t}], mesh_.triangle[3 * std::size_t{t} + 1],
                 mesh_.triangle[3 * std::size_t{t} + 2]}};
    }

    TriangleMesh& mesh_;
    const std::vector<Contraction> steps_;
    const std::uint32_t leaves_, nodes_;
    std::vector<std::array<std::uint32_t, 2>> child_;
    std::vector<std::uint32_t> parent_, count_, number_;
    std::optional<Ancestors> ancestors_;
    std::vector<float> reach_, error_, deviation_;
    BuiltForest out_;
};

}  // namespace

BuiltForest build_forest(TriangleMesh& mesh, const ForestSettings& settings, const Progress& progress) {
    if (mesh.triangles() == 0)
        throw StartupError("build the forest of a surface", "the mesh has no triangle",
                           "export the mesh again");
    constexpr double kSimplified = 0.35;  // fraction of the time; a bake of 100 000 triangles, 2026-11-23
    std::vector<Contraction> steps =
        simplify(mesh, {.locality = settings.locality}, part(progress, 0.0, kSimplified)).contraction;
    report(progress, kSimplified, "building the forest");
    return ForestBuilder(mesh, std::move(steps)).build();
}

ForestShape shape_of(const VertexForest& forest, std::span<const std::uint32_t> corner) {
    // Area of each leaf: a third of that of its triangles; cumulative along the leaves.
    std::vector<double> area(forest.leaves() + std::size_t{1}, 0.0);
    const auto at = [&](std::uint32_t v) {
        const std::array<float, 3> p = forest.leaf_position_m(v);
        return Eigen::Vector3d(p[0], p[1], p[2]);
    };
    for (std::size_t t = 0; t + 2 < corner.size(); t += 3) {
        const std::uint32_t a = corner[t], b = corner[t + 1], c = corner[t + 2];
        const double third = (at(b) - at(a)).cross(at(c) - at(a)).norm() / 6.0;
        for (const std::uint32_t v : {a, b, c}) area[v + std::size_t{1}] += third;
    }
    for (std::size_t v = 0; v < forest.leaves(); ++v) area[v + 1] += area[v];
    struct Step {
        VertexForest::Branch branch;
        std::uint32_t depth;
    };
    ForestShape shape;
    std::vector<double> width;
    std::vector<Step> stack;
    for (std::uint32_t r = 0; r < forest.roots(); ++r) stack.push_back({forest.root(r), 0});
    while (!stack.empty()) {
        const auto [b, depth] = stack.back();
        stack.pop_back();
        shape.depth = std::max(shape.depth, depth);
        if (b.is_leaf()) continue;
        const double own = area[b.end] - area[b.first];
        if (b.end - b.first >= 16 && own > 0.0)
            width.push_back(static_cast<double>(forest.node(b.node).reach_m) / std::sqrt(own));
        stack.push_back({forest.child(b, 1), depth + 1});
        stack.push_back({forest.child(b, 0), depth + 1});
    }
    shape.trees = forest.roots();
    if (width.empty()) return shape;
    for (const double w : width) shape.mean += w / static_cast<double>(width.size());
    const auto p99 = width.begin() + static_cast<std::ptrdiff_t>(width.size() - 1 - width.size() / 100);
    std::nth_element(width.begin(), p99, width.end());
    shape.p99 = *p99;
    return shape;
}

}  // namespace tact
