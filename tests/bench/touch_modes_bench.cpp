// Time of a contact step of the servo in the modes off-tree and chr: a ball or a block of 1000 points slides over a
// rough sphere along the same path.
//
// Path      around the sphere with a slow up-and-down motion, 1 mm deep; the hand moves at 55 or 500 mm/s (Fast)
// Mesh      92,480 triangles; two million if the environment variable TACT_BENCH_LARGE is set, ten million if it is 10m
// Update    the same thread runs the slow update of chr in every fourth step. Live: steps are 1 ms apart, and a second
//           thread runs the slow update every 4 ms, as in tact-rt.
// Metrics   servo_us: time of a step, the minimum of two passes (Live: one pass); adaptive: fraction of the steps on
//           the adaptive surface; tend_us: time of one slow_update(); near_predicted: predicted number of triangles of
//           the adaptive surface at full fidelity
// Measured  see rt/force/surface/README.md
#include <benchmark/benchmark.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <cstdlib>
#include <numeric>
#include <string_view>
#include <thread>
#include <type_traits>
#include <vector>

#include "prep/surface/bake_surface.hpp"
#include "prep/synthetic/made_tool.hpp"
#include "prep/synthetic/rough_sphere.hpp"
#include "rt/force/surface/tool_model.hpp"

namespace tact {
namespace {

constexpr int kSteps = 3000, kSlowUpdateEvery = 4;

struct Baked {
    double ball_m = 0.05;
    std::vector<std::byte> bytes = bake(ball_m);
    SceneFile file = SceneFile::from_bytes(bytes, "sphere.tact");

    static std::vector<std::byte> bake(double& ball_m) {
        SceneWriter out;
        SurfaceInput input;
        const char* const large = std::getenv("TACT_BENCH_LARGE");
        input.mesh = rough_sphere(large == nullptr ? 68 : std::string_view(large) == "10m" ? 707 : 316);
        input.tool = made_tool("block");
        input.tool_sampling.points = 1000;
        input.picture = false;
        ball_m *= bake_surface(std::move(input), out).meta.world_per_model;
        return out.to_bytes();
    }
};

ToolState tool_at(const Baked& on, const Vec3& middle, double radius_m, double speed_m_s, int i) {
    const auto place = [&](double t) {
        const double angle = speed_m_s * t / on.ball_m, up = 0.4 * std::sin(0.1 * angle);
        const Vec3 out(std::cos(up) * std::sin(angle), std::sin(up), std::cos(up) * std::cos(angle));
        return Vec3(middle + (on.ball_m + radius_m - 1e-3 + std::max(0.0, 0.005 - 0.02 * t)) * out);
    };
    ToolState tool;
    tool.T_world_tool.p_m = place(1e-3 * i);
    tool.twist_world.linear_m_s = (place(1e-3 * i + 1e-6) - place(1e-3 * i)) * 1e6;
    return tool;
}

double percentile(std::vector<double> us, double fraction) {
    std::sort(us.begin(), us.end());
    return us.empty() ? 0.0 : us[static_cast<std::size_t>(fraction * static_cast<double>(us.size() - 1))];
}

std::unique_ptr<SurfaceModel> load(const SurfaceModel* /*kind*/, const Baked& baked, double radius_m,
                                   SurfaceMode mode) {
    return load_surface_model(baked.file, {.radius_m = radius_m, .mode = mode});
}
std::unique_ptr<ToolModel> load(const ToolModel* /*kind*/, const Baked& baked, double /*radius_m*/,
                                SurfaceMode mode) {
    return load_tool_model(baked.file, {.mode = mode});
}
bool adaptive_step(const SurfaceModel& model) { return model.regime() == TouchRegime::adaptive; }
bool adaptive_step(const ToolModel& model) { return model.regime() == TouchRegime::adaptive; }
double predicted_triangles(const SurfaceModel& model) {
    return model.adaptive() == nullptr ? 0.0 : model.adaptive()->predicted_triangles(1.0F);
}
double predicted_triangles(const ToolModel& /*model*/) { return 0.0; }

template <class Model>
void run(benchmark::State& state, SurfaceMode mode, double speed_m_s, bool live) {
    static const Baked baked;
    // For the block, half its height.
    const double radius_m =
        std::is_same_v<Model, ToolModel> ? 4e-3 : 1e-3 * static_cast<double>(state.range(0));
    std::vector<double> servo_us(kSteps, 1e300), slow_update_us;
    double adaptive = 0.0, predicted = 0.0;
    const int passes = live ? 1 : 2;
    for (auto _ : state) {
        for (int pass = 0; pass < passes; ++pass) {
            const auto model = load(static_cast<const Model*>(nullptr), baked, radius_m, mode);
            const Vec3 middle = read_meta(baked.file).to_world(Vec3::Zero());
            std::atomic<int> now{0}, stop{0};
            const auto slow_update = [&](int i) {
                const Instant begin = Monotonic::now();
                model->slow_update(tool_at(baked, middle, radius_m, speed_m_s, i), {});
                slow_update_us.push_back(to_us(Monotonic::now() - begin));
            };
            std::thread updater;
            if (live && model->has_slow_update()) {
                updater = std::thread([&] {
                    for (auto next = std::chrono::steady_clock::now(); stop == 0;) {
                        slow_update(now);
                        next = std::max(next + std::chrono::milliseconds(kSlowUpdateEvery),
                                        std::chrono::steady_clock::now());
                        std::this_thread::sleep_until(next);
                    }
                });
            }
            model->reset(tool_at(baked, middle, radius_m, speed_m_s, 0));
            auto next = std::chrono::steady_clock::now();
            for (int i = 0; i < kSteps; ++i) {
                now = i;
                if (!live && i % kSlowUpdateEvery == 0) slow_update(i);
                const ToolState tool = tool_at(baked, middle, radius_m, speed_m_s, i);
                const Instant begin = Monotonic::now();
                (void)model->step(tool, {.fidelity = 1.0F});
                auto& least = servo_us[static_cast<std::size_t>(i)];
                least = std::min(least, to_us(Monotonic::now() - begin));
                adaptive += adaptive_step(*model) ? 1.0 / (kSteps * passes) : 0.0;
                next += std::chrono::milliseconds(1);
                if (live) std::this_thread::sleep_until(next);
            }
            stop = 1;
            if (updater.joinable()) updater.join();
            predicted = predicted_triangles(*model);
        }
    }
    state.counters["servo_us_p50"] = percentile(servo_us, 0.5);
    state.counters["servo_us_p99"] = percentile(servo_us, 0.99);
    state.counters["servo_us_p999"] = percentile(servo_us, 0.999);
    state.counters["tend_us_p50"] = percentile(slow_update_us, 0.5);
    state.counters["tend_us_p99"] = percentile(slow_update_us, 0.99);
    state.counters["adaptive"] = adaptive;
    state.counters["near_predicted"] = predicted;
}

void Tree(benchmark::State& state) { run<SurfaceModel>(state, SurfaceMode::off_tree, 0.055, false); }
void Chr(benchmark::State& state) { run<SurfaceModel>(state, SurfaceMode::chr, 0.055, false); }
void TreeFast(benchmark::State& state) { run<SurfaceModel>(state, SurfaceMode::off_tree, 0.5, false); }
void ChrFast(benchmark::State& state) { run<SurfaceModel>(state, SurfaceMode::chr, 0.5, false); }
void ChrFastLive(benchmark::State& state) { run<SurfaceModel>(state, SurfaceMode::chr, 0.5, true); }
void ToolTree(benchmark::State& state) { run<ToolModel>(state, SurfaceMode::off_tree, 0.055, false); }
void ToolChr(benchmark::State& state) { run<ToolModel>(state, SurfaceMode::chr, 0.055, false); }
BENCHMARK(Tree)->Arg(0)->Arg(1)->Arg(3)->Arg(20)->Iterations(1)->Unit(benchmark::kMillisecond);
BENCHMARK(Chr)->Arg(0)->Arg(1)->Arg(3)->Arg(20)->Iterations(1)->Unit(benchmark::kMillisecond);
BENCHMARK(TreeFast)->Arg(0)->Arg(1)->Arg(3)->Arg(20)->Iterations(1)->Unit(benchmark::kMillisecond);
BENCHMARK(ChrFast)->Arg(0)->Arg(1)->Arg(3)->Arg(20)->Iterations(1)->Unit(benchmark::kMillisecond);
BENCHMARK(ChrFastLive)->Arg(1)->Arg(3)->Iterations(1)->Unit(benchmark::kMillisecond);
BENCHMARK(ToolTree)->Iterations(1)->Unit(benchmark::kMillisecond);
BENCHMARK(ToolChr)->Iterations(1)->Unit(benchmark::kMillisecond);

// Effect of the knob, the maximum number of moves per step: time of a step at each level on the same fast path, and
// deviation of the force from the full level.
void Level(benchmark::State& state) {
    static const Baked baked;
    const double radius_m = 1e-3 * static_cast<double>(state.range(0));
    const auto fidelity = 0.01F * static_cast<float>(state.range(1));
    std::vector<double> us, off_n, error_n, predicted_n;
    double lagging = 0.0;
    for (auto _ : state) {
        const auto model = load_surface_model(baked.file, {.radius_m = radius_m}),
                   reference = load_surface_model(baked.file, {.radius_m = radius_m});
        const Vec3 middle = read_meta(baked.file).to_world(Vec3::Zero());
        for (int i = 0; i < kSteps; ++i) {
            const ToolState tool = tool_at(baked, middle, radius_m, 0.5, i);
            if (i == 0) {
                model->reset(tool);
                reference->reset(tool);
            }
            predicted_n.push_back(reference->predict(fidelity).error);
            const StepResult full = reference->step(tool, {.fidelity = 1.0F});
            const Instant begin = Monotonic::now();
            const StepResult now = model->step(tool, {.fidelity = fidelity});
            us.push_back(to_us(Monotonic::now() - begin));
            off_n.push_back((now.wrench_world.force_n - full.wrench_world.force_n).norm());
            error_n.push_back(now.load.error);
            lagging += model->contact().state == ContactState::lagging ? 1.0 / kSteps : 0.0;
        }
    }
    state.counters["us_p50"] = percentile(us, 0.5);
    state.counters["us_p999"] = percentile(us, 0.999);
    state.counters["n_off_p50"] = percentile(off_n, 0.5);
    state.counters["n_off_p99"] = percentile(off_n, 0.99);
    state.counters["n_off_max"] = percentile(off_n, 1.0);
    state.counters["error_n_p99"] = percentile(error_n, 0.99);
    state.counters["predicted_n_p99"] = percentile(predicted_n, 0.99);
    state.counters["lagging"] = lagging;
}
// A block of 1000 points at a speed in mm/s, without deadline: time (minimum of three passes), moves and queries of a step, and the share of settled steps.
void ToolSpeed(benchmark::State& state) {
    static const Baked baked;
    constexpr int kPasses = 3;
    const double speed_m_s = 1e-3 * static_cast<double>(state.range(0)),
                 friction = 0.01 * static_cast<double>(state.range(1));
    std::vector<double> us(kSteps, 1e300), moves, looked, asked;
    double settled = 0.0, gliding = 0.0, error_n = 0.0;
    for (auto _ : state) {
        for (int pass = 0; pass < kPasses; ++pass) {
            const auto model = load_tool_model(baked.file, {.friction = friction});
            const Vec3 middle = read_meta(baked.file).to_world(Vec3::Zero());
            for (int i = 0; i < kSteps; ++i) {
                const ToolState tool = tool_at(baked, middle, 4e-3, speed_m_s, i);
                if (i == 0) model->reset(tool);
                const Instant begin = Monotonic::now();
                const StepResult result = model->step(tool, {.fidelity = 1.0F});
                auto& least = us[static_cast<std::size_t>(i)];
                least = std::min(least, to_us(Monotonic::now() - begin));
                if (pass > 0) continue;
                const ToolTouch& touch = model->tool_touch();
                moves.push_back(touch.moves);
                looked.push_back(touch.looked);
                asked.push_back(touch.asked);
                settled += touch.state == ContactState::settled ? 1.0 / kSteps : 0.0;
                gliding += touch.state == ContactState::gliding ? 1.0 / kSteps : 0.0;
                error_n += result.load.error / kSteps;
            }
        }
    }
    for (const auto& [name, values] : {std::pair<const char*, const std::vector<double>*>{"us", &us},
                                       {"moves", &moves},
                                       {"triangles", &looked},
                                       {"distances", &asked}}) {
        state.counters[std::string(name) + "_p50"] = percentile(*values, 0.5);
        state.counters[std::string(name) + "_p99"] = percentile(*values, 0.99);
        state.counters[std::string(name) + "_p999"] = percentile(*values, 0.999);
    }
    state.counters["us_mean"] = std::accumulate(us.begin(), us.end(), 0.0) / kSteps;
    state.counters["settled"] = settled;
    state.counters["gliding"] = gliding;
    state.counters["error_n_mean"] = error_n;
}
BENCHMARK(ToolSpeed)->ArgsProduct({{55, 220}, {0, 20}})->Iterations(1)->Unit(benchmark::kMillisecond);

BENCHMARK(Level)->ArgsProduct({{0, 3, 20}, {5, 25, 50, 100}})->Iterations(1)->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace tact
