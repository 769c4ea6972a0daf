// Moves the vertices of a simplified mesh nearer to the original, in rounds; relax() uses it. The method: relax.cpp.
// Thread   any but the servo's
#pragma once

#include <Eigen/Geometry>
#include <array>
#include <cstdint>
#include <optional>
#include <vector>

#include "prep/mesh/mesh_distance.hpp"
#include "prep/mesh/mesh_stars.hpp"
#include "prep/mesh/opposed.hpp"
#include "prep/mesh/simplify.hpp"
#include "prep/mesh/turn_limits.hpp"

namespace tact {

class Relaxer {
public:
    static constexpr std::uint32_t kSamplesPerVertex = 20;

    Relaxer(const TriangleMesh& original, Simplified& simplified);
    void hold();  // vertices stay near the original from now on
    void round();
    void store();

private:
    using Vec = Eigen::Vector3d;
    using Corners = std::array<std::uint32_t, 3>;

    struct Sample {
        Vec at, normal;  // on a border: direction of the edge
        double weight;
        std::uint32_t near;  // vertex where the search starts
        bool border;
    };
    struct Row {
        Corners corner;
        std::array<double, 3> part;
        Vec normal;
        double weight, offset;
        [[nodiscard]] bool on_border() const { return corner[1] == corner[2]; }
    };

    void take_sides();
    void take_samples();
    void take_border_samples();
    void pull(Sample& sample);
    void pull_border(Sample& sample);
    [[nodiscard]] Vec original(std::uint32_t v) const {
        return {original_.position_m[3 * std::size_t{v}], original_.position_m[3 * std::size_t{v} + 1],
                original_.position_m[3 * std::size_t{v} + 2]};
    }
    std::vector<Vec> solve();
    // relaxer_limits.cpp
    void set_limits();
    void limit_stray();
    void shorten(std::vector<Vec>& shift) const;
    [[nodiscard]] double from_border(const Vec& p) const;
    [[nodiscard]] double from_original(std::uint32_t v, const Vec& p) const {
        return star_.border()[v] != kNoIndex ? from_border(p) : grid_->squared(p);
    }
    bool move(std::uint32_t v, const Vec& to);
    bool opposes(std::uint32_t v, const Vec& from);
    [[nodiscard]] Vec double_area(const Corners& c) const {
        return (at_[c[1]] - at_[c[0]]).cross(at_[c[2]] - at_[c[0]]);
    }

    const TriangleMesh& original_;
    Simplified& simplified_;
    std::vector<std::uint32_t> went_;  // original vertex -> vertex of the simplified mesh
    std::vector<Vec> at_;
    std::vector<Corners> triangle_;
    std::vector<Vec> start_;  // normals before the first round
    MeshStars star_;
    std::vector<Sample> sample_;
    std::vector<Row> row_;
    std::vector<Side<double>> side_;  // per vertex
    std::vector<Vec> facing_;         // per vertex: sum of the double areas that it represents
    Opposed opposed_;
    double opposed_limit_m_ = 0.0;
    std::vector<std::array<Vec, 2>> border_;  // border edges of the original
    std::optional<MeshGrid> grid_;            // of the original, if vertices must stay near it
    std::vector<double> stray_;               // per vertex: allowed squared distance from the original
};

}  // namespace tact
