// Computes the fit of the bodies in the map beside the frame loop, as it takes longer than a frame.
//
// Thread   one of its own, at low priority. It works on the newest wish, at most once a second, never more
//          than a tenth of the time, and not again while nothing has moved.
#pragma once

#include <condition_variable>
#include <cstdint>
#include <memory>
#include <mutex>
#include <span>
#include <string>
#include <thread>
#include <vector>

#include "gui/render/scene_content.hpp"
#include "ipc/assets/fit_metrics.hpp"
#include "ipc/base/clock.hpp"

namespace tact {

struct FitOutcome {
    bool good = false;
    std::string error;  // where not good
    FitMetrics metrics;
    double resolution_m = 0.0;
    bool resolution_assumed = false;  // three voxels, as the scene does not say
    double compute_s = 0.0;
    std::uint64_t number = 0;  // rises with every outcome
};

class FitWorker {
public:
    static constexpr Duration kPause = std::chrono::seconds(1);
    // The content needs a map and bodies.
    explicit FitWorker(std::shared_ptr<const SceneContent> content, Duration pause = kPause);
    ~FitWorker();
    FitWorker(const FitWorker&) = delete;
    FitWorker& operator=(const FitWorker&) = delete;

    void wish(std::span<const Pose> T_model_body);
    // True when there is one newer than outcome.number.
    [[nodiscard]] bool take(FitOutcome& outcome);

private:
    void work();
    [[nodiscard]] FitOutcome compute(const std::vector<Pose>& places) const;

    const std::shared_ptr<const SceneContent> content_;
    const Duration pause_;
    std::mutex mutex_;
    std::condition_variable changed_;
    std::vector<Pose> wished_;
    FitOutcome outcome_;
    bool stop_ = false;
    std::thread thread_;
};

// Whether a difference between two poses can be seen in the numbers: a hundredth of an ångström or of a
// degree.
[[nodiscard]] bool moved(std::span<const Pose> a, std::span<const Pose> b);

}  // namespace tact
