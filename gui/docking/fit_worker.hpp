// Computes the fit of the bodies in the map beside the frame loop, as it takes longer than a frame.
//
// Thread   one of its own, at low priority. It works on the newest request, at most once a second, never more
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
#include "ipc/base/clock.hpp"
#include "ipc/scene/fit/fit_metrics.hpp"

namespace tact {

// A body of the scene: which of the content's structures, and where.
struct FitBody {
    std::uint32_t id = 0;
    std::uint16_t structure = 0;
    Pose T_model_body;
};

struct FitOutcome {
    bool good = false;
    std::string error;           // where not good
    FitMetrics all;              // of all bodies together
    std::vector<FitBody> body;   // those that were measured, where they were
    std::vector<FitMetrics> of;  // each of them by itself
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

    // Bodies of structures that the content does not have are left out.
    void request(std::span<const FitBody> bodies);
    // True when there is one newer than outcome.number.
    [[nodiscard]] bool take(FitOutcome& outcome);

private:
    void work();
    [[nodiscard]] FitOutcome compute(std::vector<FitBody> bodies) const;

    const std::shared_ptr<const SceneContent> content_;
    const Duration pause_;
    std::mutex mutex_;
    std::condition_variable changed_;
    std::vector<FitBody> requested_;
    FitOutcome outcome_;
    bool stop_ = false;
    std::thread thread_;
};

// Whether a difference can be seen in the numbers: other bodies, or a hundredth of an ångström or of a
// degree.
[[nodiscard]] bool moved(std::span<const FitBody> a, std::span<const FitBody> b);

}  // namespace tact
