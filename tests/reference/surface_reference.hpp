// Slow reference for a ball that touches triangles: double precision, every triangle, no code shared with the product.
//
// Model     The ball's centre has to stay at rest_m or more from every triangle: the radius over the inside of the
//           triangle, the radius minus the margin over an edge or a corner. It is at rest if no small move brings it
//           nearer to the goal, or if friction holds it: the part of the pull that the touched triangles do not
//           bear is at most the coefficient times the part that they bear (Coulomb).
// Judge     one place: free or not, and the length of the pull that nothing bears
// Descend   the local minimum of the distance to the goal that a continuous slide from a place reaches, in short moves
// Unit      any, the same for all lengths
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <vector>

namespace tact::reference {

using Point = Eigen::Vector3d;

struct Triangles {
    std::vector<Point> vertex;
    std::vector<std::array<std::uint32_t, 3>> corner;
};

struct Ball {
    double radius = 0.0, margin = 0.0, friction = 0.0;
};

struct Nearest {
    Point point = Point::Zero();
    double distance = 0.0;
    bool inside = false;  // of the triangle, not on its border
};
[[nodiscard]] Nearest nearest(const Point& a, const Point& b, const Point& c, const Point& place);

struct Touched {
    Point normal = Point::Zero();  // unit, towards the ball
    double gap = 0.0;              // distance minus rest
    double push = 0.0;             // >= 0
    std::uint32_t triangle = 0;
    bool inside = false;  // over the inside of the triangle
};

struct Judgement {
    Point place = Point::Zero();
    double least_gap = 0.0;      // of all triangles: distance minus (radius minus margin)
    double push = 0.0;           // length of the sum of the pushes
    double unborne = 0.0;        // length of the move that the touched triangles leave, beyond friction
    Point lift = Point::Zero();  // sum of the pushes
    std::vector<Touched> touched;
};
// Triangles within `band` of touching count as touched.
[[nodiscard]] Judgement judge(const Triangles& mesh, const Ball& ball, const Point& place, const Point& goal,
                              double band);

// Without friction. step: longest move. Ends where a move would be shorter than `least`, or after moves_max.
[[nodiscard]] Point descend(const Triangles& mesh, const Ball& ball, Point place, const Point& goal,
                            double step, double least, int moves_max = 4000);

// Largest distance that slides from `place` and from places pushed aside by `aside` end from it: large at a place that is
// at rest but not stable.
[[nodiscard]] double unrest(const Triangles& mesh, const Ball& ball, const Point& place, const Point& goal,
                            double step, double least, double aside);

}  // namespace tact::reference
