#include "tests/reference/surface_reference.hpp"

#include <Eigen/Geometry>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>

namespace tact::reference {
namespace {

Point on_segment(const Point& a, const Point& b, const Point& place) {
    const Point ab = b - a;
    const double square = ab.squaredNorm();
    const double t = square > 0.0 ? std::clamp(ab.dot(place - a) / square, 0.0, 1.0) : 0.0;
    return a + t * ab;
}

// True if the planes of the chosen triangles bear the pull (no push negative) and the rest is kept.
bool borne_by(std::vector<Touched>& touched, const std::vector<std::size_t>& chosen, const Point& pull,
              double fine, Point& move) {
    const auto n = static_cast<Eigen::Index>(chosen.size());
    Eigen::Matrix<double, 3, Eigen::Dynamic> normals(3, n);
    Eigen::VectorXd lack(n);
    for (Eigen::Index i = 0; i < n; ++i) {
        const Touched& t = touched[chosen[static_cast<std::size_t>(i)]];
        normals.col(i) = t.normal;
        lack[i] = -(t.normal.dot(pull) + t.gap);
    }
    const Eigen::VectorXd push = (normals.transpose() * normals).fullPivLu().solve(lack);
    if (!push.allFinite() || (n > 0 && push.minCoeff() < 0.0)) return false;
    move = pull + normals * push;
    for (const Touched& t : touched) {
        if (t.normal.dot(move) + t.gap < -fine) return false;
    }
    for (Touched& t : touched) t.push = 0.0;
    for (Eigen::Index i = 0; i < n; ++i) touched[chosen[static_cast<std::size_t>(i)]].push = push[i];
    return true;
}

// The move nearest to `pull` that no touched triangle forbids (normal·move >= -gap): Hildreth's method, one triangle at a
// time until nothing changes. It crawls between nearly parallel planes: then all sets of up to three are tried.
Point allowed_move(std::vector<Touched>& touched, const Point& pull) {
    for (Touched& t : touched) t.push = 0.0;
    Point move = pull;
    const double fine = 1e-9 * pull.norm();
    for (int sweep = 0; sweep < 100; ++sweep) {
        double change = 0.0;
        for (Touched& t : touched) {
            const double push = std::max(0.0, t.push - (t.normal.dot(move) + t.gap));
            change = std::max(change, std::abs(push - t.push));
            move += (push - t.push) * t.normal;
            t.push = push;
        }
        if (change <= fine) return move;
    }
    const std::size_t n = touched.size();
    for (std::size_t i = 0; i < n; ++i)
        if (borne_by(touched, {i}, pull, fine, move)) return move;
    for (std::size_t i = 0; i < n; ++i)
        for (std::size_t k = i + 1; k < n; ++k)
            if (borne_by(touched, {i, k}, pull, fine, move)) return move;
    for (std::size_t i = 0; i < n; ++i)
        for (std::size_t k = i + 1; k < n; ++k)
            for (std::size_t l = k + 1; l < n; ++l)
                if (borne_by(touched, {i, k, l}, pull, fine, move)) return move;
    return move;
}

// Triangles that may be nearer than reach.
std::vector<std::uint32_t> candidates(const Triangles& mesh, const Point& place, double reach) {
    std::vector<std::uint32_t> found;
    for (std::uint32_t t = 0; t < mesh.corner.size(); ++t) {
        const auto& corner = mesh.corner[t];
        const Point &a = mesh.vertex[corner[0]], &b = mesh.vertex[corner[1]], &c = mesh.vertex[corner[2]];
        const double size = std::max((b - a).norm(), (c - a).norm());
        if ((place - a).norm() - size <= reach) found.push_back(t);
    }
    return found;
}

std::vector<Touched> touched_at(const Triangles& mesh, const std::vector<std::uint32_t>& among,
                                const Ball& ball, const Point& place, double band) {
    std::vector<Touched> touched;
    for (const std::uint32_t t : among) {
        const auto& corner = mesh.corner[t];
        const Nearest n =
            nearest(mesh.vertex[corner[0]], mesh.vertex[corner[1]], mesh.vertex[corner[2]], place);
        const double gap = n.distance - (n.inside ? ball.radius : ball.radius - ball.margin);
        if (gap > band || !(n.distance > 0.0)) continue;
        touched.push_back({(place - n.point) / n.distance, gap, 0.0, t, n.inside});
    }
    return touched;
}

}  // namespace

Nearest nearest(const Point& a, const Point& b, const Point& c, const Point& place) {
    Nearest best;
    const Point n = (b - a).cross(c - a);
    const double square = n.squaredNorm();
    // A normal of a needle is mostly rounding: only its edges count (the product uses the same bound).
    if (square > 1e-8 * (b - a).squaredNorm() * (c - b).squaredNorm()) {
        const Point foot = place - n.dot(place - a) / square * n;
        if (n.dot((b - a).cross(foot - a)) >= 0.0 && n.dot((c - b).cross(foot - b)) >= 0.0 &&
            n.dot((a - c).cross(foot - c)) >= 0.0)
            return {foot, (place - foot).norm(), true};
    }
    best.distance = 1e300;
    for (const auto& [p, q] : {std::pair{&a, &b}, std::pair{&b, &c}, std::pair{&c, &a}}) {
        const Point point = on_segment(*p, *q, place);
        const double distance = (place - point).norm();
        if (distance < best.distance) best = {point, distance, false};
    }
    return best;
}

Judgement judge(const Triangles& mesh, const Ball& ball, const Point& place, const Point& goal, double band) {
    Judgement found;
    found.place = place;
    found.least_gap = 1e300;
    for (const auto& corner : mesh.corner)
        found.least_gap = std::min(
            found.least_gap,
            nearest(mesh.vertex[corner[0]], mesh.vertex[corner[1]], mesh.vertex[corner[2]], place).distance);
    found.least_gap -= ball.radius - ball.margin;
    found.touched = touched_at(mesh, candidates(mesh, place, ball.radius + band), ball, place, band);
    const Point move = allowed_move(found.touched, goal - place);
    for (const Touched& t : found.touched) found.lift += t.push * t.normal;
    found.push = found.lift.norm();
    found.unborne = std::max(0.0, move.norm() - ball.friction * found.push);
    return found;
}

Point descend(const Triangles& mesh, const Ball& ball, Point place, const Point& goal, double step,
              double least, int moves_max) {
    constexpr int kListed = 32;  // moves for which a list of candidates lasts
    std::vector<std::uint32_t> list;
    for (int i = 0; i < moves_max; ++i) {
        if (i % kListed == 0) list = candidates(mesh, place, ball.radius + (kListed + 2) * step);
        // Triangles that the move may reach; it is free of each if it stays inside the half-space at its nearest point.
        std::vector<Touched> near = touched_at(mesh, list, ball, place, 2.0 * step);
        // Not pushed out of a small penetration: only what moves it towards the goal counts.
        for (Touched& t : near) t.gap = std::max(t.gap, 0.0);
        Point move = allowed_move(near, goal - place);
        const double length = move.norm();
        if (length < least) break;
        if (length > step) move *= step / length;
        place += move;
    }
    return place;
}

double unrest(const Triangles& mesh, const Ball& ball, const Point& place, const Point& goal, double step,
              double least, double aside) {
    double farthest = (descend(mesh, ball, place, goal, step, least) - place).norm();
    const Point pull = (goal - place).normalized(), u = pull.unitOrthogonal(), v = pull.cross(u);
    const std::vector<std::uint32_t> list = candidates(mesh, place, ball.radius + aside);
    for (int k = 0; k < 6; ++k) {
        const double angle = k * 1.0471975512;
        const Point from = place + aside * (std::cos(angle) * u + std::sin(angle) * v);
        // A push that leaves the ball in a triangle proves nothing.
        const std::vector<Touched> in = touched_at(mesh, list, ball, from, 0.0);
        if (std::any_of(in.begin(), in.end(), [&](const Touched& t) { return t.gap < -0.5 * aside; }))
            continue;
        farthest = std::max(farthest, (descend(mesh, ball, from, goal, step, least) - place).norm());
    }
    return farthest;
}

}  // namespace tact::reference
