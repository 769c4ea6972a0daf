// Cached triangle lists around the tool points near a surface: a query of a cached list is cheaper than a tree search.
//
// List      the triangles of all leaves whose boxes overlap a ball about the point; valid as long as the requested ball
//           lies inside it
// Found     in the tree over the full mesh, or in an adaptive surface's tree if that contains the ball (same leaves), or
//           among all triangles (brute), then again in each step
// Seen      what the last query found of each sixteen of them (seen_triangles.hpp): a later query passes over those that are too far,
//           and a move that they leave free needs none
// Room      kLists lists of kEach triangles; the least recently used one is replaced. Denser triangles are searched each
//           time.
// Unit      metres of the model.  Thread  constructed anywhere (allocates); then servo, TACT_RT.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <vector>

#include "ipc/base/pose.hpp"
#include "ipc/base/rt.hpp"
#include "ipc/scene/mesh/surface_mesh.hpp"
#include "rt/force/surface/all_triangles.hpp"
#include "rt/force/surface/near_surface.hpp"
#include "rt/force/surface/seen_triangles.hpp"

namespace tact {

class ToolLists {
public:
    static constexpr std::size_t kLists = 256, kEach = 8 * kLooks, kLeavesMost = 1024;

    struct Near {
        // `count` triangles, padded to a multiple of kLooks by repetition.
        const std::uint32_t* triangle = nullptr;
        std::size_t count = 0;
        double radius_m = 0.0;          // contains every triangle nearer than this; 0: too many
        SeenTriangles* seen = nullptr;  // of each kLooks triangles; null: the list is not kept
    };

    ToolLists(const SurfaceMesh& mesh, std::uint32_t points, bool brute)
        : mesh_(mesh),
          all_(mesh),
          brute_(brute),
          list_of_(points, kLists),
          list_(kLists),
          triangle_(kLists * kEach),
          leaf_(kLeavesMost),
          found_(4 * kLeavesMost + kLooks),
          seen_(kLists * kBlocks) {}

    // near: of an adaptive surface, valid during the step; may be null.
    void begin_step(const NearSurface* near) noexcept TACT_RT {
        adaptive_ = near;
        elsewhere_ = false;
        if (!brute_) return;
        for (List& l : list_) l.radius_m = -1.0;
    }
    // True if a ball outside the adaptive surface was requested in this step.
    [[nodiscard]] bool elsewhere() const noexcept TACT_RT { return elsewhere_; }

    [[nodiscard]] Near near(std::uint32_t point, const Vec3& place_m, double radius_m) noexcept TACT_RT {
        ++clock_;
        const std::size_t known = list_of_[point];
        if (known < kLists && list_[known].point == point) {
            List& l = list_[known];
            const double left_m = l.radius_m - (place_m - l.place_m).norm();
            if (left_m >= radius_m) {
                l.used = clock_;
                return {&triangle_[known * kEach], l.count, left_m, &seen_[known * kBlocks]};
            }
        }
        // As wide as the last list was dense: a list that does not fit is searched in vain.
        const double fits_m = std::sqrt(kFills / per_square_);
        for (const double list_m : {std::clamp(fits_m, radius_m, kWider * radius_m), radius_m}) {
            std::size_t count = 0;
            if (!find(place_m, list_m, count)) continue;
            per_square_ = static_cast<double>(count + 1) / (list_m * list_m);
            if (count > kEach && list_m > radius_m) continue;
            if (count > kEach) return {found_.data(), count, radius_m, nullptr};
            return keep(point, place_m, list_m, count);
        }
        return {};
    }

    // What is known of a point that goes from one place to another: lower bounds of its distance. Triangles at least far_m away
    // from both places are not looked at closely. Negative: nothing is known.
    [[nodiscard]] SeenTriangles::Clearance clearance_m(std::uint32_t point, const Vec3& begin_m,
                                                       const Vec3& end_m, double far_m) noexcept TACT_RT {
        constexpr SeenTriangles::Clearance kUnknown{-1.0, -1.0};
        const std::size_t at = list_of_[point];
        if (at >= kLists || list_[at].point != point) return kUnknown;
        List& l = list_[at];
        // Triangles that are not in the list.
        SeenTriangles::Clearance least;
        least.begin_m = l.radius_m - (begin_m - l.place_m).norm();
        least.way_m = std::min(least.begin_m, l.radius_m - (end_m - l.place_m).norm());
        if (!(least.way_m > 0.0)) return kUnknown;
        for (std::size_t b = 0; b * kLooks < l.count; ++b) {
            const SeenTriangles& seen = seen_[at * kBlocks + b];
            if (seen.least_m < 0.0) return kUnknown;
            const double begin = seen.coarse_m(begin_m), way = std::min(begin, seen.coarse_m(end_m));
            const SeenTriangles::Clearance c =
                way >= far_m ? SeenTriangles::Clearance{begin, way} : seen.clearance_m(begin_m, end_m);
            least.begin_m = std::min(least.begin_m, c.begin_m);
            least.way_m = std::min(least.way_m, c.way_m);
        }
        l.used = ++clock_;
        return least;
    }

private:
    static constexpr std::size_t kBlocks = kEach / kLooks;
    struct List {
        std::uint32_t point = 0;
        std::size_t count = 0;
        std::uint64_t used = 0;
        double radius_m = -1.0;
        Vec3 place_m = Vec3::Zero();
    };
    static constexpr double kWider = 2.0, kFills = 0.6 * kEach;

    // False: too many triangles.
    bool find(const Vec3& place_m, double radius_m, std::size_t& count) noexcept TACT_RT {
        if (brute_) {
            if (!all_.near(place_m, radius_m, std::span(found_).first(4 * kLeavesMost), count)) return false;
        } else {
            const bool in_adaptive = adaptive_ != nullptr && adaptive_->holds(place_m, radius_m);
            elsewhere_ |= adaptive_ != nullptr && !in_adaptive;
            std::size_t leaves = 0;
            if (!(in_adaptive ? adaptive_->mesh() : mesh_).leaves_near(place_m, radius_m, leaf_, leaves))
                return false;
            count = spell_out(leaves);
        }
        for (std::size_t i = count; i % kLooks != 0; ++i) found_[i] = found_[0];
        return true;
    }
    std::size_t spell_out(std::size_t leaves) noexcept TACT_RT {
        std::size_t count = 0;
        for (std::size_t l = 0; l < leaves; ++l) {
            const std::uint32_t first = SurfaceNode::leaf_first(leaf_[l]);
            for (std::uint32_t k = 0; k < SurfaceNode::leaf_count(leaf_[l]); ++k) found_[count++] = first + k;
        }
        return count;
    }
    Near keep(std::uint32_t point, const Vec3& place_m, double radius_m, std::size_t count) noexcept TACT_RT {
        std::size_t at = list_of_[point];
        if (at >= kLists || list_[at].point != point) {
            at = 0;
            for (std::size_t i = 1; i < kLists; ++i) {
                if (list_[i].used < list_[at].used) at = i;
            }
        }
        list_of_[point] = at;
        list_[at] = {point, count, clock_, radius_m, place_m};
        const std::size_t filled = (count + kLooks - 1) / kLooks * kLooks;
        std::copy_n(found_.begin(), filled, triangle_.begin() + static_cast<std::ptrdiff_t>(at * kEach));
        for (std::size_t b = 0; b < kBlocks; ++b) seen_[at * kBlocks + b].least_m = -1.0;
        return {&triangle_[at * kEach], count, radius_m, &seen_[at * kBlocks]};
    }

    SurfaceMesh mesh_;  // a view
    AllTriangles all_;
    bool brute_;
    const NearSurface* adaptive_ = nullptr;
    bool elsewhere_ = false;
    std::vector<std::size_t> list_of_;  // index of each point's list; kLists: none
    std::vector<List> list_;
    std::vector<std::uint32_t> triangle_, leaf_, found_;
    std::vector<SeenTriangles> seen_;
    std::uint64_t clock_ = 0;
    double per_square_ = 1e-300;  // triangles of the last list over the square of its radius
};

}  // namespace tact
