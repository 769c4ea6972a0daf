// Motion of a single particle.
//
// Flight   gravity and drag over the time since its last move, then from cell to cell along its path until bone or
//          another particle stops it in the last free cell.
// Rest     a resting particle falls when the cell below it is free. It topples where an adjacent cell and the one
//          below that are free: liquids always, dust every other time (so its piles are about as steep as they are
//          wide), paste seldom. A liquid on top of particles spreads sideways.
// Paste    dust that meets a liquid, or the reverse: the moving particle becomes paste at once, the other one at its
//          next move, from the state of its cell. Blood stays blood. Water runs off paste, or all of it would become
//          paste.
#include <algorithm>
#include <cmath>

#include "gui/drilling/particles.hpp"

namespace tact {
namespace {

constexpr float kLongestS = 0.1F;  // longer waits move for this long
constexpr int kCellsMost = 96;     // of one flight
constexpr float kToppleDust = 0.5F, kTopplePaste = 0.05F;
constexpr float kSlides = 0.4F;         // fraction of speed that a liquid keeps along an obstacle
constexpr float kSlowestShare = 2e-3F;  // of the fastest: slower particles rest

CellState state_of(Matter matter) {
    switch (matter) {
        case Matter::dust:
            return CellState::grain;
        case Matter::paste:
            return CellState::paste;
        case Matter::water:
        case Matter::blood:
            break;
    }
    return CellState::liquid;
}

bool liquid(Matter matter) { return matter == Matter::water || matter == Matter::blood; }

Cell cell_of(const std::array<float, 3>& at) {
    return {static_cast<int>(std::floor(at[0])), static_cast<int>(std::floor(at[1])),
            static_cast<int>(std::floor(at[2]))};
}

Cell sum(const Cell& a, const Cell& b) { return {a[0] + b[0], a[1] + b[1], a[2] + b[2]}; }

}  // namespace

void Particles::carry(Particle& p, const Cell& from, const Cell& to) noexcept {
    cells_.set(from, CellState::free);
    cells_.set(to, state_of(p.matter));
    // A random position in the cell, or piles would show the grid.
    for (std::size_t i = 0; i < 3; ++i)
        p.at[i] = static_cast<float>(to[i]) + 0.1F + 0.8F * static_cast<float>(random_.uniform());
}

Particles::Fate Particles::move(Particle& p) noexcept {
    const auto waited = static_cast<float>(now_s_ - p.moved_s);
    p.moved_s = now_s_;
    const Cell here = cell_of(p.at);
    if (liquid(p.matter) && cells_.state(here) == CellState::paste) {
        if (p.matter == Matter::water) p.matter = Matter::paste;
        cells_.set(here, state_of(p.matter));
    }
    if (p.velocity == std::array<float, 3>{}) return settle(p, here);
    return fly(p, std::min(waited, kLongestS));
}

Particles::Fate Particles::fly(Particle& p, float dt_s) noexcept {
    const float kept = 1.0F / (1.0F + static_cast<float>(settings_.drag_per_s) * dt_s);
    float speed2 = 0.0F;
    for (std::size_t i = 0; i < 3; ++i) {
        p.velocity[i] = (p.velocity[i] + gravity_[i] * dt_s) * kept;
        speed2 += p.velocity[i] * p.velocity[i];
    }
    if (speed2 > fastest_ * fastest_) {
        const float slower = fastest_ / std::sqrt(speed2);
        for (float& v : p.velocity) v *= slower;
    }
    const Cell from = cell_of(p.at);
    Cell at = from, turn{};
    std::array<float, 3> next{}, each{};  // fractions of the path: to the next cell border, and between two
    std::array<float, 3> end{};
    for (std::size_t i = 0; i < 3; ++i) {
        const float way = p.velocity[i] * dt_s;
        end[i] = p.at[i] + way;
        turn[i] = way > 0.0F ? 1 : -1;
        each[i] = way != 0.0F ? 1.0F / std::abs(way) : 1e30F;
        const float border = static_cast<float>(at[i] + (way > 0.0F ? 1 : 0));
        next[i] = way != 0.0F ? (border - p.at[i]) / way : 1e30F;
    }
    for (int crossed = 0; crossed < kCellsMost; ++crossed) {
        const std::size_t axis =
            next[0] < next[1] ? (next[0] < next[2] ? 0 : 2) : (next[1] < next[2] ? 1 : 2);
        if (next[axis] > 1.0F) break;
        Cell to = at;
        to[axis] += turn[axis];
        if (!cells_.inside(to)) {
            cells_.set(from, CellState::free);
            return Fate::left;
        }
        if (!cells_.free(to)) {
            if (at != from) carry(p, from, at);
            land(p, at, to);
            return Fate::stays;
        }
        at = to;
        next[axis] += each[axis];
    }
    if (cell_of(end) == at) {
        if (at != from) {
            cells_.set(from, CellState::free);
            cells_.set(at, state_of(p.matter));
        }
        p.at = end;
    } else if (at != from) {  // rounding at a border, or too long a path
        carry(p, from, at);
    }
    return Fate::stays;
}

// `hit` stopped the particle in `at`.
void Particles::land(Particle& p, const Cell& at, const Cell& hit) noexcept {
    const CellState other = cells_.state(hit);
    if (p.matter == Matter::dust && other == CellState::liquid) {
        p.matter = Matter::paste;
        cells_.set(at, CellState::paste);
        cells_.set(hit, CellState::paste);
    } else if (p.matter == Matter::water && other == CellState::grain) {
        p.matter = Matter::paste;
        cells_.set(at, CellState::paste);
    }
    if (!liquid(p.matter)) {
        p.velocity = {};
        return;
    }
    float speed2 = 0.0F;
    for (std::size_t i = 0; i < 3; ++i) {
        p.velocity[i] *= hit[i] != at[i] ? 0.0F : kSlides;
        speed2 += p.velocity[i] * p.velocity[i];
    }
    if (speed2 < kSlowestShare * kSlowestShare * fastest_ * fastest_) p.velocity = {};
}

Particles::Fate Particles::settle(Particle& p, Cell at) noexcept {
    const Cell below = sum(at, down_);
    if (!cells_.inside(below)) {
        cells_.set(at, CellState::free);
        return Fate::left;
    }
    const auto fall = [&] {
        for (std::size_t i = 0; i < 3; ++i)
            p.velocity[i] = static_cast<float>(down_[i]) * 4.0F * kSlowestShare * fastest_;
    };
    if (cells_.free(below)) {
        carry(p, at, below);
        fall();
        return Fate::stays;
    }
    const bool flows = liquid(p.matter);
    if (!flows &&
        random_.uniform() >= static_cast<double>(p.matter == Matter::dust ? kToppleDust : kTopplePaste))
        return Fate::stays;
    const bool on_particles = !cells_.bone(below);
    const std::size_t first = random_.next() & 3U;
    for (std::size_t k = 0; k < 4; ++k) {
        const Cell side = sum(at, sideways_[(first + k) & 3U]), under = sum(side, down_);
        if (!cells_.inside(side) || !cells_.free(side)) continue;
        if (cells_.inside(under) && cells_.free(under)) {
            carry(p, at, under);
            fall();
            return Fate::stays;
        }
        if (flows && on_particles) {
            carry(p, at, side);
            return Fate::stays;
        }
    }
    return Fate::stays;
}

// Finds a free cell, at most two away.
bool Particles::room_near(Cell& at) noexcept {
    if (cells_.inside(at) && cells_.free(at)) return true;
    for (int attempt = 0; attempt < 40; ++attempt) {
        const std::uint64_t reach = attempt < 12 ? 1 : 2;
        Cell c = at;
        for (int& x : c) x += static_cast<int>(random_.below(2 * reach + 1)) - static_cast<int>(reach);
        if (!cells_.inside(c) || !cells_.free(c)) continue;
        at = c;
        return true;
    }
    return false;
}

// True if more than half of the tip is in bone.
bool Particles::blocked(const Vec3& tip, double radius) const noexcept {
    int bone = 0, looked = 0;
    for (int x = -2; x <= 2; ++x)
        for (int y = -2; y <= 2; ++y)
            for (int z = -2; z <= 2; ++z) {
                if (x * x + y * y + z * z > 5) continue;
                const Vec3 at = tip + radius / 2.25 * Vec3(x, y, z);
                const Cell c = {static_cast<int>(std::floor(at.x())), static_cast<int>(std::floor(at.y())),
                                static_cast<int>(std::floor(at.z()))};
                ++looked;
                bone += cells_.inside(c) && cells_.bone(c) ? 1 : 0;
            }
    return 2 * bone > looked;
}

}  // namespace tact
