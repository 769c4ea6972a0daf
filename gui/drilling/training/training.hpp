// A training session in progress: follows the bone and the trainee, keeps the score, writes the report.
//
// Time     begins when the burr first turns
// Frame    brick() for each change, then follow(), once a frame
// Thread   frame thread
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "gui/drilling/training/training_report.hpp"

namespace tact {

struct TrainingOptions {
    std::filesystem::path plan;    // empty: no training
    std::filesystem::path folder;  // of reports; empty: in the user's state folder
    std::string trainee;
};

class Training {
public:
    // Throws StartupError if the scene does not have what the plan asks for. The bone must outlive it.
    Training(TrainingPlan plan, TrainingOptions options, const TrainingBone& bone);
    Training(const Training&) = delete;
    Training& operator=(const Training&) = delete;

    void brick(std::uint32_t brick, std::span<const std::uint8_t> before,
               std::span<const std::uint8_t> after) {
        volumes_.brick(brick, before, after);
    }
    void follow(std::int64_t now_ns, const DrillMetricsRow& metrics,
                const std::optional<BurrVisibility>& visibility);

    [[nodiscard]] const TrainingPlan& plan() const { return plan_; }
    [[nodiscard]] const TrainingScore& score() const { return score_; }
    [[nodiscard]] const TrainingVolumes& volumes() const { return volumes_; }
    [[nodiscard]] bool begun() const { return begun_ns_ >= 0; }
    // Writes the report; returns its page, or nothing if the burr never turned.
    std::filesystem::path finish(const std::string& scene, const nlohmann::json& performance,
                                 std::vector<TrainingPicture> before,
                                 std::vector<TrainingPicture> after) const;

private:
    TrainingPlan plan_;
    TrainingOptions options_;
    const BoneLabelsView& labels_;
    TrainingVolumes volumes_;
    TrainingScore score_;
    std::int64_t begun_ns_ = -1;
};

}  // namespace tact
