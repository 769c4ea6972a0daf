// Load balancing of the docking paper (figures 5, 7 and 8) on this machine.
//
// Set-up   shared_core.hpp: all parties on one core with the same priority
// Scale    a current core is some hundred times faster, so every atom is summed many times and the surface is finer
//          (experiment_scene.hpp), such that the goal under load is about a thousand updates per second.
// Goals    without load 1.45 times the unadapted rate, like the published 800 Hz and 550 Hz, and 2.2 times, like the
//          published 1200 Hz; with load 0.92 of the rate with the coarsest rendering, which is measured first.
// FIFO     if rights permit, the same load again with the force loop at the goal's rate before all others: then the
//          load takes no share from the loop, adapted or not, and the law controls the frame rate
// Thread   one; blocks for about a minute, a tenth of that with quick.
// Fails by StartupError; leaves no process behind.
#pragma once

#include <filesystem>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "ipc/scene/mesh/progressive_mesh.hpp"
#include "tests/reproduce/own_session.hpp"
#include "tests/reproduce/shared_core.hpp"
#include "tests/reproduce/summary.hpp"

namespace tact::launch {

struct RatesSettings {
    SharedCoreSettings core{};
    std::string law = "elastic";  // of the adapted runs; the paper's own law runs too
    double goal_hz = 0.0;         // under load; 0: measured
    bool quick = false;           // shorter and not scaled: a check without meaningful results
    Precedence precedence = Precedence::none;
};

struct Rates {
    RatesSettings settings{};
    int core = 0;
    bool finely_shared = false;  // see tick_source.hpp
    SceneScale scale{};
    ExperimentScene scene{};
    std::shared_ptr<const ProgressiveMesh> mesh{};  // surface of the scene
    double reach_hz = 0.0;                          // with the coarsest rendering under load
    Run off{}, low{}, high{}, on{}, on_published{};
    Run fifo_off{}, fifo_on{};  // with FIFO scheduling, if rights permit; else not run
    // Time of an update on a fast core, from all runs with that scheduling; with FIFO the loop wakes up with other cache
    // contents.
    double fast_update_s = 0.0, fifo_fast_update_s = 0.0;
    [[nodiscard]] double fast_s(const Run& run) const {
        return run.fifo ? fifo_fast_update_s : fast_update_s;
    }
    // Triangles of the surface with that number of vertices.
    [[nodiscard]] double triangles(double vertices) const;
    [[nodiscard]] std::vector<const Run*> runs() const;
    void tell_disturbed_windows();  // after all runs
};

// Nothing: a signal requested the end.
std::optional<Rates> measure_rates(const RatesSettings& settings);

// Writes rates.csv into the folder.
void write_rates(const Rates& rates, const std::filesystem::path& out);
[[nodiscard]] nlohmann::json json_of(const Rates& rates);
[[nodiscard]] std::vector<SummaryRow> summary_of(const Rates& rates);

}  // namespace tact::launch
