#include "gui/drilling/bench_particles.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>
#include <utility>
#include <vector>

#include "gui/drilling/particles.hpp"

namespace tact {
namespace {

constexpr double kBenchStep_s = 0.01;
constexpr double kBenchPlenty_s = 10.0;
constexpr std::uint32_t kBenchNamed = 100000;  // its keys also stand without a number

// Most particles rest where they fell.
class BenchSite {
public:
    explicit BenchSite(std::uint32_t most)
        : most_(most), density_(bricks_.bytes(), 0), particles_(bricks_, fill_bone(), {.most = most}) {
        for (int i = 0; i < 400 && particles_.all().size() < most - most / 50; ++i) {
            come();
            static_cast<void>(particles_.step(kBenchStep_s, kBenchPlenty_s, Vec3::Zero(), {}));
        }
    }
    ParticleStep step(double budget_s) {
        come();
        return particles_.step(kBenchStep_s, budget_s, bricks_.to_model(Vec3(128, 64, 64)), {});
    }

private:
    std::span<const std::uint8_t> fill_bone() {
        for (std::uint32_t z = 0; z < 128; ++z)
            for (std::uint32_t y = 0; y < 40; ++y)
                for (std::uint32_t x = 0; x < 256; ++x) density_[bricks_.voxel(x, y, z)] = 200;
        return density_;
    }
    // Adds the next hundredth.
    void come() {
        std::size_t left = most_ / 100;
        for (std::size_t misses = 0; left > 0 && misses < 1000 && particles_.all().size() < most_;) {
            const double far = 90.0 * random_.uniform(), angle = 2.0 * std::numbers::pi * random_.uniform();
            const Vec3 at(128.0 + far * std::cos(angle), 42.0 + layers_ * random_.uniform(),
                          64.0 + 0.6 * far * std::sin(angle));
            const auto matter = static_cast<Matter>(random_.below(3));
            const bool made = particles_.emit(matter, bricks_.to_model(at), random_.within(0.3));
            made ? --left : ++misses;
        }
    }

    std::uint32_t most_;
    double layers_ =
        std::max(6.0, 6.0 * most_ / kBenchNamed);  // layers in which they appear, with room for all
    BoneBricks bricks_{.size = {256, 128, 128}, .voxel_m = 3e-4};
    std::vector<std::uint8_t> density_;
    Particles particles_;
    SeededRandom random_{1};
};

}  // namespace

nlohmann::json bench_particles(const ParticlesBenchSettings& settings) {
    nlohmann::json all;
    for (const std::uint32_t most : settings.counts) {
        BenchSite site(most);
        const double budget_s = settings.budget_s * most / kBenchNamed;
        std::vector<double> off, step_us;
        double moved = 0.0, seconds = 0.0, alive = 0.0;
        for (int i = 0; i < settings.steps; ++i) {
            const ParticleStep step = site.step(budget_s);
            moved += step.moved;
            seconds += step.cost_s;
            alive += step.alive;
            step_us.push_back(1e6 * step.cost_s);
            if (step.moved < step.alive - step.alive / 50)
                off.push_back(std::abs(step.cost_s / budget_s - 1.0));
        }
        const double steps = std::max(settings.steps, 1);
        nlohmann::json of = {{"particle_ns_each", 1e9 * seconds / std::max(moved, 1.0)},
                             {"particle_moves", moved / steps},
                             {"particles_alive", alive / steps}};
        std::sort(step_us.begin(), step_us.end());
        for (const auto& [name, p] : {std::pair{"p50", 0.5}, {"p99", 0.99}, {"p999", 0.999}, {"max", 1.0}}) {
            const double rank = std::ceil(p * static_cast<double>(step_us.size()) - 1e-9);
            if (!step_us.empty())
                of["particle_step_us_" + std::string(name)] =
                    step_us[static_cast<std::size_t>(std::max(rank, 1.0)) - 1];
        }
        if (!off.empty()) {
            double sum = 0.0;
            for (const double e : off) sum += e;
            std::sort(off.begin(), off.end());
            of["particle_budget_error"] = sum / static_cast<double>(off.size());
            of["particle_budget_error_p99"] = off[off.size() * 99 / 100];
        }
        for (const auto& [key, value] : of.items()) {
            all[key + "_" + std::to_string(most)] = value;
            if (most == kBenchNamed) all[key] = value;
        }
    }
    return all;
}

}  // namespace tact
