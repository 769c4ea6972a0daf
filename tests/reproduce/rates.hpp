// The docking paper's load balancing (its figures 5, 7 and 8), run again on this machine.
//
// Set-up   shared_core.hpp: all parties on one core with the same precedence
// Scale    today's core is some hundred times faster, so every atom is felt many times and the surface is
//          finer (experiment_scene.hpp), such that the goal under load is about a thousand updates a second.
// Goals    without load 1.45 times the unadapted rate, as the seed's 800 is of its 550, and 2.2 times, as its
//          1200; with load 0.92 of what the coarsest picture would reach, measured before.
// FIFO     where rights allow it, the same load once more with the force loop at the goal's rate before
//          all others: then the load takes no share from it, adapted or not, and what the law holds is
//          the picture's rate
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
    std::string law = "elastic";  // of the adapted runs; the seed's own is run beside it
    double goal_hz = 0.0;         // under load; 0: from the measurement
    bool quick = false;           // shorter, not scaled: shows that everything works, not what it is worth
    Precedence precedence = Precedence::none;
};

struct Rates {
    RatesSettings settings{};
    int core = 0;
    bool finely_shared = false;  // see tick_source.hpp
    SceneScale scale{};
    ExperimentScene scene{};
    std::shared_ptr<const ProgressiveMesh> mesh{};  // the surface of the scene
    double reach_hz = 0.0;                          // with the coarsest picture under load
    Run off{}, low{}, high{}, on{}, on_seed{};
    Run fifo_off{}, fifo_on{};  // with FIFO scheduling, where rights allow it; else not run
    // Of an update on a fast core, from all runs with that scheduling: one that comes first wakes to other
    // caches.
    double fast_update_s = 0.0, fifo_fast_update_s = 0.0;
    [[nodiscard]] double fast_s(const Run& run) const {
        return run.fifo ? fifo_fast_update_s : fast_update_s;
    }
    // Triangles of the surface with so many vertices.
    [[nodiscard]] double triangles(double vertices) const;
    [[nodiscard]] std::vector<const Run*> runs() const;
    void tell_disturbed_windows();  // once all runs are there
};

// Nothing: a signal asked to end.
std::optional<Rates> measure_rates(const RatesSettings& settings);

// rates.csv in that folder.
void write_rates(const Rates& rates, const std::filesystem::path& out);
[[nodiscard]] nlohmann::json json_of(const Rates& rates);
[[nodiscard]] std::vector<SummaryRow> summary_of(const Rates& rates);

}  // namespace tact::launch
