// Slow reference for a rigid body of balls that touches triangles: double precision, no code shared with the product.
//
// Model     Each ball keeps to the rule of surface_reference.hpp. The body's moves are twists (displacement, radius of gyration
//           times rotation) about its hand point; a ball at lever l touched along n bears (n, l x n / gyration).
// Judge     at rest if what the touched triangles can bear, pushing only, leaves of the pull no more than friction holds: at
//           most the coefficient times what they bear, as one wrench (Coulomb)
// Unit      any, the same for all lengths
#pragma once

#include <functional>
#include <vector>

#include "tests/reference/surface_reference.hpp"

namespace tact::reference {

using Twist = Eigen::Matrix<double, 6, 1>;

struct ToolJudgement {
    double deepest = 0.0;  // of all balls: radius minus margin, minus the distance of the nearest triangle
    double borne = 0.0;    // length of what the touched triangles bear
    double unborne = 0.0;  // length of what is left of the pull, beyond friction
    Twist left = Twist::Zero();  // of the pull, friction included
    std::size_t touches = 0;
};

// near(place, reach): all triangles that come within reach of a place. levers: of the balls, in world axes. pull: the twist from
// the pose to the goal. Triangles within `band` of touching can bear.
[[nodiscard]] ToolJudgement judge_tool(const std::function<Triangles(const Point&, double)>& near,
                                       const Ball& ball, const Point& hand, const std::vector<Point>& levers,
                                       double gyration, const Twist& pull, double band);

// The smallest length of pull + sum of w_i bears_i with all w_i >= 0 (Lawson, Hanson 1974), and of the sum.
struct Borne {
    Twist left = Twist::Zero();
    double borne = 0.0;
};
[[nodiscard]] Borne borne(const std::vector<Twist>& bears, const Twist& pull);

}  // namespace tact::reference
