#include "gui/drilling/burr_sight.hpp"

#include <algorithm>
#include <array>
#include <cmath>

namespace tact {
namespace {

constexpr std::size_t kRays = 5;
constexpr double kFromHead = 1.15;       // of the radius: bone that touches the head does not hide it
constexpr double kAcross = 0.6;          // of the radius: offset of the outer rays
constexpr double kBeside = 1.0;          // cells: radius of a particle
constexpr double kStep = 0.5;            // cells, along a ray through bone
constexpr double kSightStepsMost = 1e6;  // no site has this many cells

double opacity(Matter matter) {
    switch (matter) {
        case Matter::water:
            return 0.03;
        case Matter::blood:
            return 1.3;
        case Matter::dust:
        case Matter::paste:
            break;
    }
    return 2.0;
}

bool ends_in_bone(const ParticleCells& cells, Vec3 at, const Vec3& towards, double length) {
    const int steps = static_cast<int>(std::ceil(std::clamp(length / kStep, 0.0, kSightStepsMost)));
    for (int i = 0; i < steps; ++i, at += kStep * towards) {
        const Cell c = {static_cast<int>(std::floor(at.x())), static_cast<int>(std::floor(at.y())),
                        static_cast<int>(std::floor(at.z()))};
        if (!cells.inside(c)) return false;  // the site is a box, and the ray began inside
        if (cells.bone(c)) return true;
    }
    return false;
}

}  // namespace

double share_seen(const Particles& particles, const Vec3& head_m, double radius_m,
                  const Vec3& eye_m) noexcept {
    if (!head_m.allFinite() || !eye_m.allFinite() || !(radius_m > 0.0)) return 0.0;
    const ParticleCells& cells = particles.cells();
    const Vec3 head = cells.to_cells(head_m), way = cells.to_cells(eye_m) - head;
    const double radius = radius_m / cells.cell_m(), length = way.norm() - kFromHead * radius;
    if (!(length > 0.0)) return 1.0;
    const Vec3 towards = way.normalized();
    const Vec3 side = towards.unitOrthogonal(), up = towards.cross(side);
    std::array<Vec3, kRays> from;
    from.fill(head + kFromHead * radius * towards);
    from[1] += kAcross * radius * side;
    from[2] -= kAcross * radius * side;
    from[3] += kAcross * radius * up;
    from[4] -= kAcross * radius * up;

    std::array<double, kRays> dimmed{};
    const double reach2 = std::pow(kAcross * radius + kBeside, 2);
    for (const Particle& p : particles.shown()) {
        const Vec3 at =
            Vec3(static_cast<double>(p.at[0]), static_cast<double>(p.at[1]), static_cast<double>(p.at[2])) -
            from[0];
        const double along = at.dot(towards);
        if (along < 0.0 || along > length || at.squaredNorm() - along * along > reach2) continue;
        for (std::size_t k = 0; k < kRays; ++k) {
            const Vec3 off = at - along * towards - (from[k] - from[0]);
            if (off.squaredNorm() < kBeside * kBeside) dimmed[k] += opacity(p.matter);
        }
    }
    double seen = 0.0;
    for (std::size_t k = 0; k < kRays; ++k) {
        // Hardly visible: bone need not be searched.
        if (dimmed[k] < 4.0 && !ends_in_bone(cells, from[k], towards, length))
            seen += std::exp(-dimmed[k]) / kRays;
    }
    return seen;
}

}  // namespace tact
