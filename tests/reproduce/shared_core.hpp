// One run of an experiment: controller and visual process on one core, with software rendering and a free-running force
// loop unless the run specifies otherwise; an external computing load on the same core, which starts during the run.
//
// Equal    runs differ only in the law: same core, same priority, same frame-rate limit
// Sampled  every 5 ms, from the topics and the processor clocks of all parties
// Fails by StartupError. Ends all child processes.
// Thread   one
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "tests/reproduce/experiment_scene.hpp"
#include "tests/reproduce/rate_rows.hpp"

namespace tact::launch {

struct Phase {
    double settle_s, free_s, resettle_s, loaded_s;  // 0: no such phase
    [[nodiscard]] double load_on_s() const { return settle_s + free_s; }
    [[nodiscard]] double end_s() const {
        return load_on_s() + (loaded_s > 0.0 ? resettle_s + loaded_s : 0.0);
    }
};

struct Run {
    std::string name;          // for example "law off"
    std::string law;           // governor law of tact-rt
    double goal_hz = 0.0;      // force rate; 0: default of tact-rt
    double mesh_level = -1.0;  // -1: set by the law
    bool fifo = false;         // force loop at the goal rate with FIFO scheduling instead of free running
    double display_goal_hz = 0.0;
    Phase phase{};
    std::vector<RateSample> samples{};
    RateSummary free{}, loaded{};                             // after settling
    WorstWindow worst_start{}, worst_free{}, worst_loaded{};  // over all windows of each part
    double settled_free_s = -1.0, settled_loaded_s = -1.0;    // see settling_s()
    double load_share = 0.0;  // fraction of the core used by the external load
    // Evaluates the samples. fast_s: time of an update on a fast core (rate_samples.hpp); 0: determined from this run.
    void summarize_with(double fast_s);
};

struct SharedCoreSettings {
    int core = -1;  // -1: the last core permitted to this process
    double fps_max = 20.0;
};

class SharedCore {
public:
    explicit SharedCore(const SharedCoreSettings& settings);
    SharedCore(const SharedCore&) = delete;
    SharedCore& operator=(const SharedCore&) = delete;
    ~SharedCore();

    [[nodiscard]] int core() const;
    [[nodiscard]] bool finely_shared() const;                   // see tick_source.hpp
    [[nodiscard]] const std::filesystem::path& folder() const;  // for temporary files
    void scene(const ExperimentScene& scene);
    // Runs and fills in samples and results. False: a signal requested the end.
    bool execute(Run& run);

private:
    struct Parts;
    std::unique_ptr<Parts> parts_;
};

}  // namespace tact::launch
