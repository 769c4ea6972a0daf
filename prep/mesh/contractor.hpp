// The working state of simplify(): vertices with quadrics, triangles, who touches whom, and the queue.
#pragma once

#include <Eigen/Geometry>
#include <cstdint>
#include <vector>

#include "ipc/base/huge_pages.hpp"
#include "prep/mesh/bucket_queue.hpp"
#include "prep/mesh/quadric.hpp"
#include "prep/mesh/simplify.hpp"

namespace tact {

class Contractor {
public:
    Contractor(const TriangleMesh& mesh, const SimplifySettings& settings);
    Simplified run(const Progress& progress);

private:
    // One cache line: what a look at a neighbour needs.
    struct alignas(64) Vertex {
        std::array<float, 3> p;      // scaled to the unit cube, about its centre
        Quadric q;                   // about p
        std::uint32_t stamp;         // rises when the vertex changes; the top bit: on a border
        std::uint32_t first, count;  // its triangles, in touch_
        [[nodiscard]] Eigen::Vector3f at() const { return {p[0], p[1], p[2]}; }
    };
    static_assert(sizeof(Vertex) == 64);
    using Corners = std::array<std::uint32_t, 3>;

    // A triangle at a vertex as seen from it; positions are relative to the kept vertex of the pair.
    struct Wing {
        std::uint32_t triangle, next, last;  // corners in order after the vertex itself
        Eigen::Vector3f p_next, p_last;
    };
    using Star = std::vector<Wing>;
    struct Place {
        Eigen::Vector3f shift;  // from the kept vertex
        float cost;
    };

    void scale(const TriangleMesh& mesh);
    void touch();
    void add_planes();
    void add_border(std::uint32_t u, std::uint32_t w);
    void queue_all(const Progress& progress);
    void push(std::uint32_t u, std::uint32_t v);
    void gather(std::uint32_t u);

    bool ahead(QueuedPair& pair, float& due);
    void fetch_lists(const QueuedPair& pair) const;
    void fetch_triangles(const QueuedPair& pair) const;
    void fetch_neighbours(const QueuedPair& pair) const;
    [[nodiscard]] bool current(const QueuedPair& pair) const {
        return vertex_[pair.u].stamp + vertex_[pair.v].stamp == pair.stamp;
    }

    [[nodiscard]] Place best(const Quadric& sum, const Eigen::Vector3f& across) const;
    [[nodiscard]] static Quadric sum_about_first(const Vertex& u, const Vertex& v);
    void look(std::uint32_t self, const Eigen::Vector3f& origin, Star& star) const;
    void keep_volume(const Quadric& sum, std::uint32_t u, const Eigen::Vector3f& across, Place& place) const;
    [[nodiscard]] bool topology_allows(std::uint32_t u, std::uint32_t v);
    bool turns_over(const Star& star, std::uint32_t other, const Eigen::Vector3f& from,
                    const Eigen::Vector3f& to);
    [[nodiscard]] bool folds() const;
    bool try_pair(std::uint32_t u, std::uint32_t v);
    void contract(std::uint32_t u, std::uint32_t v, const Quadric& sum, const Place& place);
    void compact_touch();
    void drop_touch(std::uint32_t w, std::uint32_t t);
    void take_rest();

    const SimplifySettings settings_;
    Eigen::Vector3d centre_ = Eigen::Vector3d::Zero();
    double extent_ = 1.0;
    HugeVector<Vertex> vertex_;
    HugeVector<Corners> triangle_;     // dead: first corner is kNone
    HugeVector<std::uint32_t> touch_;  // triangles of each vertex; a list that grows moves to the end
    std::size_t touch_limit_ = 0;
    Star star_u_, star_v_;
    struct Leaf {
        std::uint32_t next, last;
        Eigen::Vector3f normal;
    };
    std::vector<Leaf> leaf_;  // the triangles that a contraction would leave
    HugeVector<std::uint32_t> mark_, hits_;
    std::vector<std::uint32_t> ring_;  // neighbours found by gather(); hits_[w]: triangles shared with w
    std::uint32_t epoch_ = 0;
    std::uint32_t alive_ = 0;
    BucketQueue queue_;
    struct Waiting {
        QueuedPair pair;
        float due;
    };
    std::array<Waiting, 16> waiting_{};  // taken from the queue, their memory on its way
    std::uint32_t waiting_first_ = 0, waiting_end_ = 0;
    Simplified result_;
    float error_ = 0.0F;
};

}  // namespace tact
