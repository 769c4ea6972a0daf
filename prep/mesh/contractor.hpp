// Working state of simplify(): vertices with quadrics, triangles, their adjacency, and the queue.
//
//   contractor_start.cpp   planes, borders, initial pairs
//   contractor.cpp         the loop over the queue, and the changes of a contraction
//   contractor_checks.cpp  prevents pinches, flipped triangles and folds
//   contractor_place.cpp   preserves volume and border area
//   contractor_stray.cpp   limits the largest distance
//   contractor_join.cpp    pairs without an edge: surfaces that join, small parts that vanish
#pragma once

#include <Eigen/Geometry>
#include <cstdint>
#include <vector>

#include "ipc/base/huge_pages.hpp"
#include "prep/mesh/bucket_queue.hpp"
#include "prep/mesh/opposed.hpp"
#include "prep/mesh/placement.hpp"
#include "prep/mesh/simplify.hpp"
#include "prep/mesh/turn_limits.hpp"

namespace tact {

class Contractor {
public:
    Contractor(const TriangleMesh& mesh, const SimplifySettings& settings);
    Simplified run(const Progress& progress);

private:
    static constexpr std::uint32_t kNone = UINT32_MAX;
    static constexpr std::uint32_t kBorder = 1U << 31;  // in a stamp
    static constexpr std::uint32_t kNoEdge = 1U << 31;  // in QueuedPair::u: the two share no triangle

    // One cache line: all data of a neighbour.
    struct alignas(64) Vertex {
        std::array<float, 3> p;      // scaled to the unit cube, about its centre
        Quadric q;                   // about p
        std::uint32_t stamp;         // changes with the vertex; top bit: on a border
        std::uint32_t first, count;  // its triangles in touch_; once removed: the vertex it went into, and 0
        [[nodiscard]] Eigen::Vector3f at() const { return {p[0], p[1], p[2]}; }
    };
    static_assert(sizeof(Vertex) == 64);
    using Corners = std::array<std::uint32_t, 3>;

    // A triangle at a vertex; positions are relative to the kept vertex of the pair.
    struct Wing {
        std::uint32_t triangle, next, last;  // corners in order after the vertex itself
        Eigen::Vector3f p_next, p_last;
    };
    using Star = std::vector<Wing>;
    struct Leaf {
        std::uint32_t next, last;
        std::uint32_t other;             // the vertex of the pair that it does not touch
        float turn;                      // |normal - before|
        Eigen::Vector3f normal, before;  // unit vectors; before is zero if undefined
    };
    struct Joint {  // an edge between the new vertex and w
        std::uint32_t w;
        float bend, turn;  // |n - m| of its two triangles; the larger of their turns
    };

    void scale(const TriangleMesh& mesh);
    void touch();
    void add_planes();
    void add_borders();
    void add_border(std::uint32_t u, std::uint32_t w, float boundary_weight);
    void queue_all(const Progress& progress);
    void queue_near();
    void push(std::uint32_t u, std::uint32_t v, std::uint32_t flag = 0);
    void gather(std::uint32_t u);
    [[nodiscard]] Eigen::Vector3f double_area(const Corners& c) const {
        const Eigen::Vector3f a = vertex_[c[0]].at();
        return (vertex_[c[1]].at() - a).cross(vertex_[c[2]].at() - a);
    }

    bool ahead(QueuedPair& pair, float& due);

    void fetch_lists(const QueuedPair& pair) const;
    void fetch_triangles(const QueuedPair& pair) const;
    void fetch_neighbours(const QueuedPair& pair) const;
    [[nodiscard]] bool alive(std::uint32_t v) const { return vertex_[v].count != 0; }
    [[nodiscard]] std::uint32_t heir(std::uint32_t v) const;
    bool is_due(QueuedPair& pair, float due);

    [[nodiscard]] static Quadric sum_about_first(const Vertex& u, const Vertex& v) {
        Quadric sum = v.q.about(u.at() - v.at());
        sum += u.q;
        return sum;
    }
    [[nodiscard]] float cost(std::uint32_t u, std::uint32_t v) const {
        const Vertex &a = vertex_[u], &b = vertex_[v];
        const Eigen::Vector3f across = b.at() - a.at();
        const Quadric sum = sum_about_first(a, b);
        const float error = best_place(sum, across).cost;
        if (reach_.empty()) return error;
        const float apart = std::max({0.5F * (across.norm() + reach_[u] + reach_[v]), reach_[u], reach_[v]});
        return error + locality_ * apart * apart * sum.trace();
    }
    void look(std::uint32_t self, const Eigen::Vector3f& origin, Star& star) const;
    void keep_volume(const Quadric& sum, std::uint32_t u, const Eigen::Vector3f& across, Place& place) const;
    void keep_border(const Quadric& sum, std::uint32_t u, std::uint32_t v, Place& place);
    [[nodiscard]] bool bent(std::uint32_t u, std::uint32_t v) const;
    [[nodiscard]] float square_level(const Quadric& sum, const Eigen::Vector3f& across,
                                     const Place& place) const;
    void pull_back(const Quadric& sum, const Eigen::Vector3f& across, Place& place) const;
    [[nodiscard]] float to_new_star(const Eigen::Vector3f& p, std::uint32_t u, std::uint32_t v,
                                    const Eigen::Vector3f& to, float enough) const;
    bool loses(const Quadric& sum, std::uint32_t u, std::uint32_t v, const Eigen::Vector3f& across,
               const Place& place);
    [[nodiscard]] bool topology_allows(std::uint32_t u, std::uint32_t v);
    bool turns_over(const Star& star, std::uint32_t other, const Eigen::Vector3f& from,
                    const Eigen::Vector3f& to, const Side<float>& side);
    bool folds(std::uint32_t u, std::uint32_t v, bool joining);
    [[nodiscard]] bool folds_outward(const Leaf& leaf, std::uint32_t u, std::uint32_t v);
    void measure_bend(std::uint32_t w);
    void note_bends(std::uint32_t u);
    bool spoils(std::uint32_t u, std::uint32_t v, const Eigen::Vector3f& across, const Eigen::Vector3f& to,
                bool joining = false);
    bool opposes(const Quadric& sum, std::uint32_t u, std::uint32_t v, const Eigen::Vector3f& across,
                 const Place& place);
    bool try_pair(std::uint32_t u, std::uint32_t v);
    void contract(std::uint32_t u, std::uint32_t v, const Quadric& sum, const Place& place);
    void record(std::uint32_t kept, std::uint32_t gone, float cost, float weight);
    void compact_touch();
    void drop_touch(std::uint32_t w, std::uint32_t t);
    void take_rest();

    enum class Tried { done, refused, dropped };
    Tried try_apart(QueuedPair& pair, float due);
    Tried absorb(std::uint32_t into, QueuedPair& pair, float due);
    bool small_part(std::uint32_t v, std::uint32_t apart_from);
    void drop_coincident(std::uint32_t u);
    void clear_borders(std::uint32_t u);

    const SimplifySettings settings_;
    Eigen::Vector3d centre_ = Eigen::Vector3d::Zero();
    double extent_ = 1.0;
    HugeVector<Vertex> vertex_;
    HugeVector<Corners> triangle_;     // removed: first corner is kNone
    HugeVector<std::uint32_t> touch_;  // triangles of each vertex; a list that grows moves to the end
    std::size_t touch_limit_ = 0;
    float locality_ = 0.0F;  // the square of the setting
    HugeVector<float>
        reach_;  // per vertex: distance of the farthest vertex that it represents; empty without locality
    // Per vertex: sum of the double areas that it represents, as vectors, and of their norms.
    HugeVector<Eigen::Vector4f> facing_;
    // Per vertex: the farthest point that was lost at it, and 1; all 0: none. See contractor_stray.cpp.
    using Lost = std::array<float, 4>;
    HugeVector<Lost> lost_;
    Lost lost_next_{};
    float tried_at_ = 0.0F;  // the cost at which the pair is tried; rises when it is refused
    Opposed original_;
    bool opposed_ = false;           // the reason of the last refusal
    HugeVector<std::uint8_t> bend_;  // per vertex: an upper bound, see contractor_checks.cpp
    Star star_u_, star_v_;
    std::vector<Leaf> leaf_;    // triangles that a contraction would leave at the new vertex
    std::vector<Joint> joint_;  // edges between these triangles, found by folds()
    struct Blade {
        std::uint32_t next, last;
        Eigen::Vector3f normal;
    };
    std::vector<Blade> fan_;
    HugeVector<std::uint32_t> mark_, hits_;
    std::vector<std::uint32_t> ring_;  // neighbours found by gather(); hits_[w]: triangles shared with w
    std::vector<std::uint32_t> part_;  // vertices found by small_part()
    std::uint32_t epoch_ = 0;
    std::uint32_t alive_ = 0;
    BucketQueue queue_;
    struct Waiting {
        QueuedPair pair;
        float due;
    };
    class Line {  // first in, first out
    public:
        [[nodiscard]] std::uint32_t size() const { return end_ - first_; }
        void push(const Waiting& w) { at_[end_++ % at_.size()] = w; }
        Waiting take() { return at_[first_++ % at_.size()]; }
        [[nodiscard]] const Waiting& from_end(std::uint32_t back) const {
            return at_[(end_ - 1 - back) % at_.size()];
        }

    private:
        std::array<Waiting, 32> at_{};
        std::uint32_t first_ = 0, end_ = 0;
    };
    Line popped_, due_;  // taken from the queue, memory being prefetched
    Simplified result_;
    float error_ = 0.0F;
};

}  // namespace tact
