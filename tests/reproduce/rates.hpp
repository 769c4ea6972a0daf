// Load balancing of the docking paper (figures 5, 7 and 8) on this machine.
//
// Set-up   all parties run on one core with the same priority (shared_core.hpp)
// Scale    a current core is some hundred times faster than that of the paper. Therefore each atom is summed many times
//          and the surface is finer (experiment_scene.hpp), so that the goal under load is about 1000 updates per
//          second.
// Goals    without load: 1.45 times the rate without adaptation (published: 800 Hz and 550 Hz), and 2.2 times
//          (published: 1200 Hz); with load: 0.92 times the rate at the coarsest rendering, which is measured first
// FIFO     if rights permit, the runs under load are repeated with the force loop at the goal rate and FIFO priority.
//          Then the load takes no time from the loop, adapted or not, and the law controls the frame rate.
// Thread   one; blocks for about a minute, a tenth of that with quick
// Fails by StartupError. Ends all child processes.
#pragma once

#include <filesystem>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "ipc/scene/mesh/progressive_mesh.hpp"
#include "tests/reproduce/law_pairs.hpp"
#include "tests/reproduce/own_session.hpp"
#include "tests/reproduce/shared_core.hpp"
#include "tests/reproduce/summary.hpp"

namespace tact::launch {

struct RatesSettings {
    SharedCoreSettings core{};
    std::string law = "elastic";  // of the adaptive runs; the law of the paper runs too
    double goal_hz = 0.0;         // force rate under load; 0: derived from a measurement
    int pairs = 1;  // pairs of runs of both laws under load, taking turns; the figures show the first one
    bool quick = false;  // shorter and not scaled: checks the program; the results are not meaningful
    Precedence precedence = Precedence::none;
};

struct Rates {
    RatesSettings settings{};
    int core = 0;
    bool finely_shared = false;  // see tick_source.hpp
    SceneScale scale{};
    ExperimentScene scene{};
    std::shared_ptr<const ProgressiveMesh> mesh{};  // surface in the scene
    double reach_hz = 0.0;                          // force rate at the coarsest rendering under load
    Run off{}, low{}, high{}, on{}, on_published{};
    std::vector<LawPair> more_pairs{};  // like `on` and `on_published`
    Run fifo_off{}, fifo_on{};          // with FIFO scheduling; empty without the rights
    // Time of an update on a fast core, from all runs with the same scheduling. It differs with FIFO, because the
    // contents of the caches differ at wake-up.
    double fast_update_s = 0.0, fifo_fast_update_s = 0.0;
    [[nodiscard]] double fast_s(const Run& run) const {
        return run.fifo ? fifo_fast_update_s : fast_update_s;
    }
    // Number of triangles of the surface at this number of vertices.
    [[nodiscard]] double triangles(double vertices) const;
    [[nodiscard]] std::vector<const Run*> runs() const;
    [[nodiscard]] std::vector<LawPair> pairs() const;
    void mark_disturbed_windows();  // after all runs
};

// Empty: a signal requested the end.
std::optional<Rates> measure_rates(const RatesSettings& settings);

// Writes rates.csv into the folder.
void write_rates(const Rates& rates, const std::filesystem::path& out);
[[nodiscard]] nlohmann::json json_of(const Rates& rates);
[[nodiscard]] std::vector<SummaryRow> summary_of(const Rates& rates);

}  // namespace tact::launch
