// One run of an experiment: controller and visual process on one core, the force loop running freely unless
// the run says otherwise, the picture drawn in software; an external number-crunching load on the same core,
// switched on part-way.
//
// Equal    the law is the only thing that differs between runs: same core, same precedence, same picture rate
// Sampled  every 5 ms, by reading the topics and the processor clocks of all parties
// Fails by StartupError; leaves no process behind
// Thread   one
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "tests/reproduce/experiment_scene.hpp"
#include "tests/reproduce/rate_rows.hpp"

namespace tact::launch {

struct Phase {
    double settle_s, free_s, resettle_s, loaded_s;  // 0: not
    [[nodiscard]] double load_on_s() const { return settle_s + free_s; }
    [[nodiscard]] double end_s() const {
        return load_on_s() + (loaded_s > 0.0 ? resettle_s + loaded_s : 0.0);
    }
};

struct Run {
    std::string name;          // "law off"
    std::string law;           // of tact-rt
    double goal_hz = 0.0;      // of the force rate; 0: tact-rt's own
    double mesh_level = -1.0;  // -1: the law's
    bool fifo = false;         // the force loop at the goal's rate with FIFO scheduling, not running freely
    double display_goal_hz = 0.0;
    Phase phase{};
    std::vector<RateSample> samples{};
    RateSummary free{}, loaded{};                             // once settled
    WorstWindow worst_start{}, worst_free{}, worst_loaded{};  // of all windows of the part
    double settled_free_s = -1.0, settled_loaded_s = -1.0;    // see settling_s()
    double load_share = 0.0;                                  // of the core, that the external load got
    // What follows from the samples; fast_s: of an update on a fast core, 0: the run's own
    // (rate_samples.hpp).
    void summarize_with(double fast_s);
};

struct SharedCoreSettings {
    int core = -1;  // -1: the last that this process may use
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
    [[nodiscard]] const std::filesystem::path& folder() const;  // scratch
    void scene(const ExperimentScene& scene);
    // Fills the samples and what follows from them. False: a signal asked to end.
    bool go(Run& run);

private:
    struct Parts;
    std::unique_ptr<Parts> parts_;
};

}  // namespace tact::launch
