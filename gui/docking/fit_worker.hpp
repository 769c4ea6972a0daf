// Computes the fit of the bodies to the map in the background, because it takes longer than a frame.
//
// Thread   its own, at low priority. It processes the newest request, at most once a second, for at most a tenth of
//          the time, and only after something changed.
#pragma once

#include <condition_variable>
#include <cstdint>
#include <memory>
#include <mutex>
#include <optional>
#include <span>
#include <string>
#include <thread>
#include <vector>

#include "gui/render/scene_content.hpp"
#include "ipc/base/clock.hpp"
#include "ipc/scene/fit/fit_metrics.hpp"
#include "ipc/scene/fit/residue_fit.hpp"

namespace tact {

// A body of the scene: its structure's index in the content, and its pose.
struct FitBody {
    std::uint32_t id = 0;
    std::uint16_t structure = 0;
    Pose T_model_body;
    std::vector<float> amplitude_m{};  // bent along the modes of its structure; empty: straight
};

struct FitOutcome {
    bool good = false;
    std::string error;           // if not good
    FitMetrics all;              // of all bodies together
    std::vector<FitBody> body;   // the measured bodies and their poses
    std::vector<FitMetrics> of;  // one per body
    double resolution_m = 0.0;
    double compute_s = 0.0;
    double contour = 0.0;      // that the fractions inside refer to
    std::uint64_t number = 0;  // increases with every outcome
    // One list per body once they were asked for; of older places while residues_current is false.
    std::vector<std::vector<ResidueFit>> residues;
    bool residues_current = false;
};

class FitWorker {
public:
    static constexpr Duration kPause = std::chrono::seconds(1);
    static constexpr int kResidueWindow = 9;
    // The content needs a map and bodies.
    explicit FitWorker(std::shared_ptr<const SceneContent> content, Duration pause = kPause);
    ~FitWorker();
    FitWorker(const FitWorker&) = delete;
    FitWorker& operator=(const FitWorker&) = delete;

    // Ignores bodies of structures that the content does not have. contour: level that counts as inside; none: the scene's.
    // residues: also the fit of each residue, which takes longer and comes in a second outcome.
    void request(std::span<const FitBody> bodies, std::optional<double> contour = {}, bool residues = false);
    // Returns true if there is one newer than outcome.number.
    [[nodiscard]] bool take(FitOutcome& outcome);

private:
    void work();
    struct Placed;
    [[nodiscard]] FitSettings settings(double contour) const;
    [[nodiscard]] FitOutcome compute(std::vector<FitBody> bodies, const Placed& placed, double contour) const;
    [[nodiscard]] std::vector<std::vector<ResidueFit>> residues_of(const Placed& placed, double contour);
    [[nodiscard]] bool stopping();

    const std::shared_ptr<const SceneContent> content_;
    const Duration pause_;
    std::mutex mutex_;
    std::condition_variable changed_;
    std::vector<FitBody> requested_;
    double contour_ = 0.0;  // requested
    bool residues_ = false;
    FitOutcome outcome_;
    bool stop_ = false;
    std::thread thread_;
};

// True if the difference shows in the numbers: other bodies, or a hundredth of an ångström or of a degree.
[[nodiscard]] bool moved(std::span<const FitBody> a, std::span<const FitBody> b);

}  // namespace tact
