#include "gui/drilling/particles.hpp"

#include <algorithm>
#include <cmath>

#include "ipc/base/error.hpp"

namespace tact {
namespace {

// Moves between two readings of the clock: this fraction of a step, so that a short budget is kept as well.
constexpr std::size_t kBetweenLooks = 64, kBetweenLooksLeast = 8;
constexpr double kBetweenLooksShare = 1.0 / 32.0;
constexpr std::size_t kFetchAhead = 8;
constexpr double kFewest = 0.1;    // fraction of the particles that a step should be able to move
constexpr double kBelieved = 0.2;  // weight of a new measurement
constexpr double kPassByShare = 0.1, kGiveUpShare = 0.25;  // of the budget
constexpr std::uint32_t kRoomShare = 50;
constexpr int kRounds = 4;
constexpr double kLongestBudgetS = 10.0;
constexpr std::size_t kSamples = 128, kHeirs = 8;
constexpr double kDrawnFrom = 3.0;                       // radii of the tip
constexpr double kDrawnSpeed = 0.6;                      // of the fastest, at the tip's radius
constexpr float kFlungOut = 0.25F, kFlungAlong = 0.35F;  // of the fastest
constexpr float kScatter = 0.3F;                         // of the speed at which dust flies off

float squared(const std::array<float, 3>& v) { return v[0] * v[0] + v[1] * v[1] + v[2] * v[2]; }

std::array<float, 3> floats(const Vec3& v) {
    return {static_cast<float>(v.x()), static_cast<float>(v.y()), static_cast<float>(v.z())};
}

float distance(const std::array<float, 3>& a, const std::array<float, 3>& b) {
    return std::sqrt(squared({a[0] - b[0], a[1] - b[1], a[2] - b[2]}));
}

}  // namespace

Particles::Particles(const BoneBricks& bricks, std::span<const std::uint8_t> density,
                     const ParticleSettings& settings)
    : settings_(settings),
      cells_(bricks, density, settings.margin),
      groups_(settings.most),
      random_(settings.seed),
      most_(settings.most) {
    if (settings.most == 0 || settings.grain_levels == 0 || !(settings.fastest_m_s > 0.0) ||
        !(settings.drag_per_s >= 0.0) || !settings.gravity_m_s2.allFinite())
        throw StartupError("checking the particle settings",
                           "number, mass and maximum speed must be above zero", "correct them");
    particle_.reserve(settings.most);
    gravity_ = floats(settings.gravity_m_s2 / cells_.cell_m());
    fastest_ = static_cast<float>(settings.fastest_m_s / cells_.cell_m());
    Eigen::Index axis = 0;
    settings.gravity_m_s2.cwiseAbs().maxCoeff(&axis);
    const auto down = static_cast<std::size_t>(axis);
    down_[down] = settings.gravity_m_s2[axis] > 0.0 ? 1 : -1;
    std::size_t k = 0;
    for (std::size_t i = 0; i < 3; ++i) {
        if (i == down) continue;
        sideways_[k++][i] = 1;
        sideways_[k++][i] = -1;
    }
}

void Particles::drilled(std::uint32_t x, std::uint32_t y, std::uint32_t z, std::uint32_t levels,
                        const Vec3& velocity_m_s) noexcept {
    ledger_.drilled += levels;
    ledger_.pooled += levels;
    const Cell cell = cells_.of_voxel(x, y, z);
    const Vec3 at = Vec3(cell[0], cell[1], cell[2]).array() + 0.5;
    while (ledger_.pooled >= settings_.grain_levels) {
        const Vec3 velocity =
            velocity_m_s + static_cast<double>(kScatter) * velocity_m_s.norm() * random_.direction();
        // Dust without space stays pooled.
        if (!spawn(Matter::dust, at, velocity / cells_.cell_m(), settings_.grain_levels)) break;
        ledger_.pooled -= settings_.grain_levels;
        ledger_.carried += settings_.grain_levels;
    }
}

bool Particles::emit(Matter matter, const Vec3& at_m, const Vec3& velocity_m_s) noexcept {
    if (!at_m.allFinite() || !velocity_m_s.allFinite()) return false;
    return spawn(matter, cells_.to_cells(at_m), velocity_m_s / cells_.cell_m(), 0);
}

bool Particles::spawn(Matter matter, const Vec3& at, const Vec3& velocity, std::uint32_t mass) noexcept {
    if (particle_.size() >= most_) return false;
    const auto size = cells_.size();
    for (Eigen::Index i = 0; i < 3; ++i)
        if (!(at[i] >= 0.0) || !(at[i] < size[static_cast<std::size_t>(i)])) return false;
    const Cell wanted = {static_cast<int>(at.x()), static_cast<int>(at.y()), static_cast<int>(at.z())};
    Cell cell = wanted;
    if (!room_near(cell)) return false;
    Particle p{};
    for (std::size_t i = 0; i < 3; ++i) p.at[i] = static_cast<float>(cell[i]) + 0.5F;
    p.velocity = floats(velocity);
    p.moved_s = now_s_;
    p.mass = mass;
    p.matter = matter;
    const float speed = std::sqrt(squared(p.velocity));
    if (!(speed <= fastest_))
        for (float& v : p.velocity) v *= std::isfinite(speed) ? fastest_ / speed : 0.0F;
    cells_.set(cell, matter == Matter::dust    ? CellState::grain
                     : matter == Matter::paste ? CellState::paste
                                               : CellState::liquid);
    const auto i = static_cast<std::uint32_t>(particle_.size());
    particle_.push_back(p);
    groups_.add(i, speed_group(std::sqrt(squared(p.velocity)) / fastest_));
    return true;
}

// Its cell is free already, or is freed here if it still belongs to it.
void Particles::remove(std::uint32_t i, std::uint64_t& account) noexcept {
    ledger_.carried -= particle_[i].mass;
    account += particle_[i].mass;
    groups_.remove(i);
    const auto last = static_cast<std::uint32_t>(particle_.size() - 1);
    if (i != last) {
        particle_[i] = particle_[last];
        groups_.rename(last, i);
    }
    particle_.pop_back();
}

void Particles::bury() noexcept {
    for (std::size_t i = 0; i < particle_.size();) {
        const Particle& p = particle_[i];
        const Cell here = {static_cast<int>(p.at[0]), static_cast<int>(p.at[1]), static_cast<int>(p.at[2])};
        if (!cells_.bone(here)) {
            ++i;
            continue;
        }
        cells_.set(here, CellState::free);
        remove(static_cast<std::uint32_t>(i), ledger_.buried);
    }
}

void Particles::regroup(std::uint32_t i) noexcept {
    groups_.move_to(i, speed_group(std::sqrt(squared(particle_[i].velocity)) / fastest_));
}

void Particles::move_group(std::size_t group, std::size_t moves, std::size_t between_looks, Instant deadline,
                           ParticleStep& step) noexcept {
    for (std::size_t k = 0; k < moves && groups_.held(group) > 0; ++k) {
        if ((k + 1) % between_looks == 0 && settings_.now() >= deadline) return;
        const std::uint32_t i = groups_.next(group);
        prefetch(&particle_[groups_.next(group, kFetchAhead)]);
        const Particle& soon = particle_[groups_.next(group, kFetchAhead / 2)];
        cells_.fetch(
            {static_cast<int>(soon.at[0]), static_cast<int>(soon.at[1]), static_cast<int>(soon.at[2])});
        if (particle_[i].moved_s == now_s_) {  // slowed down in this very step
            groups_.advance(group);
            continue;
        }
        ++step.moved;
        if (move(particle_[i]) == Fate::left) {
            ++step.left;
            remove(i, ledger_.left);
            continue;
        }
        regroup(i);
        if (groups_.group(i) == group) groups_.advance(group);
    }
}

// Continues the pass over all particles, some per step, and finds those near the suction tip and in the rotating
// head.
void Particles::pass_by(const Suction& suction, const Stir& stir, Instant deadline,
                        ParticleStep& step) noexcept {
    bool sucks = suction.radius_m > 0.0 && suction.tip_m.allFinite();
    const Vec3 tip = sucks ? cells_.to_cells(suction.tip_m) : Vec3(Vec3::Zero());
    const double radius = suction.radius_m / cells_.cell_m();
    step.suction_blocked = sucks && blocked(tip, radius);
    sucks = sucks && !step.suction_blocked;
    const bool stirs = stir.radius_m > 0.0 && stir.centre_m.allFinite() && stir.spin_rad_s.allFinite();
    if (!sucks && !stirs) return;
    const auto centre = floats(tip), head = floats(stirs ? cells_.to_cells(stir.centre_m) : tip),
               spin = floats(stir.spin_rad_s);
    const auto taken2 = sucks ? static_cast<float>(radius * radius) : 0.0F,
               drawn2 = static_cast<float>(kDrawnFrom * kDrawnFrom) * taken2,
               stirred2 = stirs ? static_cast<float>(std::pow(stir.radius_m / cells_.cell_m(), 2)) : 0.0F;
    for (std::size_t looks = 1, all = particle_.size(); looks <= all && !particle_.empty(); ++looks) {
        if (looks % kBetweenLooks == 0 && looks >= kSamples && settings_.now() >= deadline) return;
        if (passed_ >= particle_.size()) passed_ = 0;
        Particle& p = particle_[passed_];
        const std::array<float, 3> way = {centre[0] - p.at[0], centre[1] - p.at[1], centre[2] - p.at[2]};
        const float away2 = squared(way);
        if (away2 <= taken2) {
            cells_.set({static_cast<int>(p.at[0]), static_cast<int>(p.at[1]), static_cast<int>(p.at[2])},
                       CellState::free);
            ++step.sucked;
            remove(static_cast<std::uint32_t>(passed_), ledger_.sucked);
            continue;
        }
        if (away2 <= drawn2) {
            const float speed = static_cast<float>(kDrawnSpeed) * fastest_ * taken2 / away2;
            for (std::size_t i = 0; i < 3; ++i) p.velocity[i] = speed * way[i] / std::sqrt(away2);
            regroup(static_cast<std::uint32_t>(passed_));
        } else if (const std::array<float, 3> off = {p.at[0] - head[0], p.at[1] - head[1], p.at[2] - head[2]};
                   squared(off) < stirred2) {
            fling(p, off, spin);
            regroup(static_cast<std::uint32_t>(passed_));
        }
        ++passed_;
    }
}

// Out of a rotating head and along its surface.
void Particles::fling(Particle& p, const std::array<float, 3>& off,
                      const std::array<float, 3>& spin) const noexcept {
    const std::array<float, 3> along = {spin[1] * off[2] - spin[2] * off[1],
                                        spin[2] * off[0] - spin[0] * off[2],
                                        spin[0] * off[1] - spin[1] * off[0]};
    const float turns = std::sqrt(squared(along)), far = std::sqrt(squared(off));
    for (std::size_t i = 0; i < 3; ++i)
        p.velocity[i] = fastest_ * (kFlungOut * (far > 0.0F ? off[i] / far : 0.0F) +
                                    kFlungAlong * (turns > 0.0F ? along[i] / turns : 0.0F));
}

float Particles::importance(const Particle& p, const std::array<float, 3>& looked_at) const noexcept {
    const float speed = std::sqrt(squared(p.velocity)) / fastest_;
    return (speed + 0.01F) / (distance(p.at, looked_at) + 1.0F);
}

// Importance below which this fraction of all particles lies, estimated from a sample.
float Particles::importance_below(double share, const std::array<float, 3>& looked_at) noexcept {
    std::array<float, kSamples> sample{};
    for (float& s : sample) s = importance(particle_[random_.below(particle_.size())], looked_at);
    const auto at = std::min(static_cast<std::size_t>(share * static_cast<double>(kSamples)), kSamples - 1);
    std::nth_element(sample.begin(), sample.begin() + static_cast<std::ptrdiff_t>(at), sample.end());
    return sample[at];
}

// To the nearest of a few others that carry bone; what finds none is left for the pool.
void Particles::hand_mass_on(std::uint32_t from) noexcept {
    Particle& p = particle_[from];
    if (p.mass == 0) return;
    Particle* heir = nullptr;
    float nearest = 0.0F;
    for (std::size_t k = 0; k < kHeirs; ++k) {
        Particle& other = particle_[random_.below(particle_.size())];
        if (&other == &p || other.mass == 0) continue;
        const float away = distance(other.at, p.at);
        if (heir != nullptr && away >= nearest) continue;
        heir = &other;
        nearest = away;
    }
    if (heir == nullptr) return;
    heir->mass += p.mass;
    p.mass = 0;
}

void Particles::give_up(std::size_t count, const Vec3& looked_at, Instant deadline,
                        ParticleStep& step) noexcept {
    const auto centre = floats(looked_at);
    // Any of the lowest 4 * count will do, so that they are found soon.
    const double share =
        std::min(4.0 * static_cast<double>(count) / static_cast<double>(particle_.size()), 1.0);
    const float limit = importance_below(share, centre);
    for (std::size_t looks = 1; looks <= particle_.size() && count > 0; ++looks) {
        if (looks % kBetweenLooks == 0 && settings_.now() >= deadline) return;
        if (given_up_ >= particle_.size()) given_up_ = 0;
        const Particle& p = particle_[given_up_];
        if (importance(p, centre) > limit) {
            ++given_up_;
            continue;
        }
        cells_.set({static_cast<int>(p.at[0]), static_cast<int>(p.at[1]), static_cast<int>(p.at[2])},
                   CellState::free);
        ++step.given_up;
        --count;
        hand_mass_on(static_cast<std::uint32_t>(given_up_));
        remove(static_cast<std::uint32_t>(given_up_), ledger_.pooled);
    }
}

ParticleStep Particles::step(double dt_s, double budget_s, const Vec3& looked_at_m, const Suction& suction,
                             const Stir& stir) noexcept {
    ParticleStep step;
    const auto after = [begin = settings_.now()](double s) {
        return begin + std::chrono::duration_cast<Duration>(std::chrono::duration<double>(s));
    };
    budget_s = std::clamp(budget_s, 0.0, kLongestBudgetS);
    const Instant deadline = after(budget_s);
    now_s_ += std::max(dt_s, 0.0);
    pass_by(suction, stir, after(kPassByShare * budget_s), step);
    const auto moves_left = [&](Instant now) { return std::max(to_s(deadline - now), 0.0) / move_s_; };
    // Space for the particles of the next step.
    const std::size_t most = std::min<std::size_t>(
        static_cast<std::size_t>(moves_left(settings_.now()) / kFewest), most_ - most_ / kRoomShare);
    if (particle_.size() > most && looked_at_m.allFinite())
        give_up(particle_.size() - most, cells_.to_cells(looked_at_m), after(kGiveUpShare * budget_s), step);
    const Instant prepared = settings_.now();
    step.held = groups_.counts();
    step.moves = moves_by_group(step.held, moves_left(prepared));
    GroupCounts moves = step.moves;
    const auto between_looks = static_cast<std::size_t>(std::clamp(
        kBetweenLooksShare * moves_left(prepared), double{kBetweenLooksLeast}, double{kBetweenLooks}));
    // Plans again with the remaining budget, because particles that slowed down used moves of their new group.
    for (int round = 0; round < kRounds; ++round) {
        const std::uint32_t before = step.moved;
        for (std::size_t j = 0; j < kSpeedGroups; ++j) move_group(j, moves[j], between_looks, deadline, step);
        const double left = moves_left(settings_.now());
        if (step.moved == before || step.moved >= particle_.size() ||
            left < static_cast<double>(between_looks))
            break;
        moves = moves_by_group(groups_.counts(), left);
    }
    const Instant end = settings_.now();
    step.alive = static_cast<std::uint32_t>(particle_.size());
    step.cost_s = to_s(end - after(0.0));
    if (step.moved >= kBetweenLooks)
        move_s_ += kBelieved * (std::clamp(to_s(end - prepared) / step.moved, 1e-9, 1e-5) - move_s_);
    step.move_s = move_s_;
    return step;
}

}  // namespace tact
