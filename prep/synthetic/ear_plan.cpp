#include "prep/synthetic/ear_plan.hpp"

#include <numbers>

namespace tact {
namespace {

using shape::Bar;

// Approximates the distance more closely than shape::ellipsoid, to first order.
double round_body(const Vec3& p, const Vec3& centre, const Vec3& radii) {
    const Vec3 q = (p - centre).cwiseQuotient(radii);
    const double k = q.norm();
    return k * (k - 1.0) / std::max(q.cwiseQuotient(radii).norm(), 1e-9);
}

Bar pearl(const Vec3& at, double radius) { return {at, at + Vec3(0, 0, 1e-6), radius, radius}; }

void put_ring(std::vector<Bar>& bars, const Vec3& centre, const Vec3& axis, double major, double minor) {
    const Vec3 u = axis.unitOrthogonal(), v = axis.cross(u).normalized();
    const auto at = [&](int i) -> Vec3 {
        const double a = i * std::numbers::pi / 10.0;
        return centre + major * (std::cos(a) * u + std::sin(a) * v);
    };
    for (int i = 0; i < 20; ++i) bars.push_back({at(i), at(i + 1), minor, minor});
}

void put_cochlea(std::vector<Bar>& bars) {  // two and a half turns, upward and narrowing
    const Vec3 axis = Vec3(0.6, -0.1, 0.8).normalized(), u = axis.unitOrthogonal(), v = axis.cross(u);
    const Vec3 base(8.0, 0.3, -8.2);
    const auto at = [&](int i) -> Vec3 {
        const double t = i / 40.0, a = 5.0 * std::numbers::pi * t, r = 2.9 - 2.1 * t;
        return base + r * (std::cos(a) * u + std::sin(a) * v) + 2.8 * t * axis;
    };
    for (int i = 0; i < 40; ++i) bars.push_back({at(i), at(i + 1), 0.7 - 0.006 * i, 0.7 - 0.006 * (i + 1)});
}

}  // namespace

EarPlan::EarPlan() {
    const auto of = [this](EarPart p) -> std::vector<Bar>& { return part[static_cast<std::size_t>(p)]; };
    of(EarPart::none) = {{Vec3(4.6, 0, 5.3), Vec3(5.6, 0.3, 30), 3.4, 3.9}};
    of(EarPart::facial_nerve) =
        shape::tube(std::array{Vec3(3, 3, -26), Vec3(5, 3.5, -13), Vec3(7, 5, -8), Vec3(8, 5.2, -5),
                               Vec3(4, 4.2, -2.7), Vec3(-0.5, 3, -2.3), Vec3(-2.6, 0, -1.2), Vec3(-3, -6, 0),
                               Vec3(-3.2, -13, 1), Vec3(-1, -20, 3.5), Vec3(4, -25, 9)},
                    0.75);
    of(EarPart::chorda_tympani) =
        shape::tube(std::array{Vec3(-3, -8, 0.2), Vec3(-1.5, -3, 2), Vec3(1, 1.5, 1.4), Vec3(4.5, 4.2, 0.9),
                               Vec3(8, 3, 0)},
                    0.3);
    of(EarPart::sigmoid_sinus) =
        shape::tube(std::array{Vec3(-26, 9, -4), Vec3(-17, 8, -1), Vec3(-14, 3, 1.5), Vec3(-13.5, -4, 1),
                               Vec3(-11, -11, -3), Vec3(-6, -13, -8), Vec3(-2, -9, -11)},
                    3.4);
    of(EarPart::carotid_artery) =
        shape::tube(std::array{Vec3(12, -27, -4), Vec3(11, -12, -7), Vec3(10.5, -7, -9), Vec3(13, -4, -13),
                               Vec3(14, -2, -18), Vec3(17, 2, -26)},
                    2.3);
    std::vector<Bar>& labyrinth = of(EarPart::labyrinth);
    labyrinth = {pearl(Vec3(2.5, 2.4, -6.2), 1.6)};
    put_ring(labyrinth, Vec3(-0.5, 3, -6.2), Vec3(0.2, 1, 0.1).normalized(), 2.6, 0.5);
    put_ring(labyrinth, Vec3(1, 5, -7.2), Vec3(1, 0, 0.9).normalized(), 2.6, 0.5);
    put_ring(labyrinth, Vec3(-1.6, 1.6, -7.6), Vec3(-0.7, 0.1, 0.8).normalized(), 2.6, 0.5);
    put_cochlea(labyrinth);
    of(EarPart::malleus) = {pearl(Vec3(5.4, 6.3, 0.1), 1.15),
                            {Vec3(5.4, 5.4, 0.3), Vec3(4.4, -0.8, 0.8), 0.5, 0.3}};
    of(EarPart::incus) = {pearl(Vec3(3.1, 6.4, -0.1), 1.25),
                          {Vec3(2.4, 6.5, 0.0), Vec3(0.2, 6.3, 0.4), 0.6, 0.35},
                          {Vec3(3.1, 5.6, -0.1), Vec3(3.3, 2.4, -0.5), 0.6, 0.32}};
    of(EarPart::stapes) = {pearl(Vec3(3.3, 2.1, -0.8), 0.4),
                           {Vec3(3.2, 2.1, -0.9), Vec3(2.7, 2.5, -2.4), 0.24, 0.24},
                           {Vec3(3.4, 2.0, -0.9), Vec3(3.9, 1.8, -2.4), 0.24, 0.24},
                           {Vec3(2.6, 2.5, -2.5), Vec3(3.9, 1.8, -2.5), 0.35, 0.35}};
}

double EarPlan::outside(const Vec3& p) {
    static const std::array kBodies{
        Bar{Vec3(-6, -9, 4), Vec3(-4, -19, 4.5), 9.0, 4.2},    // tip of the mastoid
        Bar{Vec3(0, -1, -2), Vec3(10, -1, -18), 9.0, 5.0},     // pyramid
        Bar{Vec3(7, 3, 10.5), Vec3(27, 4.5, 12.5), 3.0, 2.2},  // root of the zygoma
        Bar{Vec3(4, 0, 2), Vec3(5, -0.5, 11), 6.0, 5.6}};      // about the ear canal
    double d = round_body(p, Vec3(-7, -6, 3), Vec3(14, 15, 11));
    d = shape::join(d, round_body(p, Vec3(2, 10.5, 9), Vec3(19, 12.5, 2.7)), 4.0);  // squama
    for (const Bar& body : kBodies) d = shape::join(d, body.distance(p), 4.0);
    return d;
}

double EarPlan::cavity(const Vec3& p) {
    static const Bar kAditus{Vec3(3, 6.4, 0), Vec3(-5, 4.8, 2.2), 1.9, 2.2};
    double d = round_body(p, Vec3(4.2, 1, -0.5), Vec3(3.6, 6, 2.0));
    d = shape::join(d, round_body(p, Vec3(4, 6.4, 0), Vec3(4, 2.6, 2)), 1.0);
    d = shape::join(d, kAditus.distance(p), 1.0);
    return shape::join(d, round_body(p, Vec3(-6, 4, 2.5), Vec3(3.4, 3, 3)), 1.0);
}

double EarPlan::cellular(const Vec3& p) { return round_body(p, Vec3(-6.5, -5.5, 3), Vec3(13.5, 16, 11)); }

bool EarPlan::cranial(const Vec3& p) {
    return (p.y() > 4.0 && p.z() < 9.0) || (p.z() < -3.0 && p.x() < 0.0 && p.y() > -13.0);
}

}  // namespace tact
