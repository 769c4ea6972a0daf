// Bone dust, water, blood and paste around the burr: particles that fly freely in empty space and follow the rules of
// a sandpile where they touch, one per cell, moved within a time budget.
//
// Step     the number of moves is the budget left after suction over the measured cost of a move. It is divided
//          among groups of speed (speed_groups.hpp); each particle moves for the time since its own last move. If
//          less than a tenth could move, the least important are given up: slow ones, far from the point looked at.
// Rules    particle_rules.cpp: flight with drag, rest, toppling, spreading of liquids, dust and water to paste,
//          suction.
// Mass     in levels of bone density (255 per solid voxel). Removed bone is pooled until it makes a grain; Ledger
//          accounts for all of it, and its sum is constant. A particle that is given up hands its mass to one nearby, or
//          to the pool: fewer and heavier grains, and no bone is lost.
// Frame    model, metres; cells internally
// Thread   one; no allocation after construction
#pragma once

#include <algorithm>
#include <cstdint>
#include <span>
#include <vector>

#include "gui/drilling/particle_cells.hpp"
#include "gui/drilling/speed_groups.hpp"
#include "ipc/base/clock.hpp"
#include "ipc/base/random.hpp"

namespace tact {

enum class Matter : std::uint8_t { dust, water, blood, paste };

struct Particle {
    std::array<float, 3> at, velocity;  // cells, cells per second
    double moved_s;                     // time of the last move, on the clock of the steps
    std::uint32_t mass;                 // levels of bone; 0: none
    Matter matter;
};

struct ParticleSettings {
    std::uint32_t most = 200000;
    std::uint32_t margin = 16;                  // cells around the volume that belong to the site
    Vec3 gravity_m_s2 = Vec3(0.0, -9.81, 0.0);  // its largest component is down for resting particles
    double fastest_m_s = 1.0;                   // v_max
    double drag_per_s = 4.0;                    // in flight
    std::uint16_t grain_levels = 255;           // of dust
    std::uint64_t seed = 1;
    Instant (*now)() = [] { return Monotonic::now(); };
};

struct Suction {
    Vec3 tip_m = Vec3::Zero();
    double radius_m = 0.0;  // removes particles within it, attracts them from three times as far. 0: off
};

// A rotating head among the particles: those inside are carried out along its rotation.
struct Stir {
    Vec3 centre_m = Vec3::Zero();
    double radius_m = 0.0;  // 0: none
    Vec3 spin_rad_s = Vec3::Zero();
};

struct Ledger {  // levels of bone
    std::uint64_t drilled = 0, pooled = 0, carried = 0, sucked = 0, left = 0,
                  buried = 0;  // in bone that came back
    [[nodiscard]] bool balances() const noexcept {
        return drilled == pooled + carried + sucked + left + buried;
    }
};

struct ParticleStep {
    std::uint32_t alive = 0, moved = 0;
    std::uint32_t sucked = 0, left = 0,
                  given_up = 0;         // in this step: by suction, out of the site, as least important
    GroupCounts held{}, moves{};        // by group, as planned
    bool suction_blocked = false;       // the tip is in bone
    double cost_s = 0.0, move_s = 0.0;  // total; per move, as estimated for the next step
};

class Particles {
public:
    Particles(const BoneBricks& bricks, std::span<const std::uint8_t> density,
              const ParticleSettings& settings);

    // `levels` of bone were removed at a voxel; the dust flies off with this velocity and some scatter.
    void drilled(std::uint32_t x, std::uint32_t y, std::uint32_t z, std::uint32_t levels,
                 const Vec3& velocity_m_s) noexcept;
    // Adds one particle. Returns false if there is no space nearby, or the maximum is reached.
    bool emit(Matter matter, const Vec3& at_m, const Vec3& velocity_m_s) noexcept;
    // Removes the particles where bone came back.
    void bury() noexcept;
    ParticleStep step(double dt_s, double budget_s, const Vec3& looked_at_m, const Suction& suction,
                      const Stir& stir = {}) noexcept;
    // Limits the number shown, within the limit of the settings. The next steps discard the least important excess
    // within their budgets; until then shown() omits as many.
    void keep_at_most(std::uint32_t most) noexcept { most_ = std::min(most, settings_.most); }

    [[nodiscard]] std::span<const Particle> all() const noexcept { return particle_; }
    [[nodiscard]] std::span<const Particle> shown() const noexcept {
        return all().first(std::min<std::size_t>(particle_.size(), most_));
    }
    [[nodiscard]] Vec3 place_m(const Particle& p) const noexcept {
        return cells_.to_model(
            Vec3(static_cast<double>(p.at[0]), static_cast<double>(p.at[1]), static_cast<double>(p.at[2])));
    }
    [[nodiscard]] const ParticleCells& cells() const noexcept { return cells_; }
    [[nodiscard]] const Ledger& ledger() const noexcept { return ledger_; }

private:
    enum class Fate : std::uint8_t { stays, left };

    bool spawn(Matter matter, const Vec3& at, const Vec3& velocity, std::uint32_t mass) noexcept;
    void remove(std::uint32_t i, std::uint64_t& account) noexcept;
    void move_group(std::size_t group, std::size_t moves, std::size_t between_looks, Instant deadline,
                    ParticleStep& step) noexcept;
    void pass_by(const Suction& suction, const Stir& stir, Instant deadline, ParticleStep& step) noexcept;
    void fling(Particle& p, const std::array<float, 3>& off, const std::array<float, 3>& spin) const noexcept;
    void hand_mass_on(std::uint32_t from) noexcept;
    void give_up(std::size_t count, const Vec3& looked_at, Instant deadline, ParticleStep& step) noexcept;
    [[nodiscard]] float importance(const Particle& p, const std::array<float, 3>& looked_at) const noexcept;
    [[nodiscard]] float importance_below(double share, const std::array<float, 3>& looked_at) noexcept;
    void regroup(std::uint32_t i) noexcept;

    // particle_rules.cpp
    Fate move(Particle& p) noexcept;
    Fate fly(Particle& p, float dt_s) noexcept;
    Fate settle(Particle& p, Cell at) noexcept;
    void land(Particle& p, const Cell& at, const Cell& hit) noexcept;
    void carry(Particle& p, const Cell& from, const Cell& to) noexcept;
    [[nodiscard]] bool room_near(Cell& at) noexcept;
    [[nodiscard]] bool blocked(const Vec3& tip, double radius) const noexcept;

    ParticleSettings settings_;
    ParticleCells cells_;
    SpeedGroups groups_;
    std::vector<Particle> particle_;
    SeededRandom random_;
    Ledger ledger_;
    std::array<float, 3> gravity_{};  // cells / s2
    Cell down_{};
    std::array<Cell, 4> sideways_{};
    float fastest_ = 1.0F;  // cells / s
    std::uint32_t most_;
    double now_s_ = 0.0;
    double move_s_ = 100e-9;                 // measured, per move
    std::size_t passed_ = 0, given_up_ = 0;  // where the passes over all continue
};

}  // namespace tact
