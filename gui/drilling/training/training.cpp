#include "gui/drilling/training/training.hpp"

#include <ctime>
#include <utility>

#include "ipc/base/error.hpp"
#include "ipc/base/state_folder.hpp"

namespace tact {
namespace {

std::string date_now() {
    const std::time_t now = std::time(nullptr);
    std::tm local{};
    localtime_r(&now, &local);
    char text[32];
    return std::strftime(text, sizeof text, "%Y-%m-%d %H:%M", &local) > 0 ? text : "";
}

}  // namespace

Training::Training(TrainingPlan plan, TrainingOptions options, const TrainingBone& bone)
    : plan_(std::move(plan)), options_(std::move(options)), labels_(*bone.labels), volumes_(plan_, bone) {}

void Training::follow(std::int64_t now_ns, const DrillMetricsRow& metrics,
                      const std::optional<BurrVisibility>& visibility) {
    if (begun_ns_ < 0 && metrics.drilling_s > 0.0) begun_ns_ = now_ns;
    const double time_s = begun_ns_ < 0 ? 0.0 : 1e-9 * static_cast<double>(now_ns - begun_ns_);
    score_ = training_score(plan_, volumes_.sums(), metrics, labels_, visibility, time_s);
}

std::filesystem::path Training::finish(const std::string& scene, const nlohmann::json& performance,
                                       std::vector<TrainingPicture> before,
                                       std::vector<TrainingPicture> after) const {
    if (!begun()) return {};
    std::filesystem::path folder = options_.folder;
    if (folder.empty() && !state_folder().empty()) folder = state_folder() / "training";
    if (folder.empty())
        throw StartupError("writing the training report", "neither XDG_STATE_HOME nor HOME is set",
                           "give a folder: --training-folder");
    return write_training(folder, {.trainee = options_.trainee,
                                   .scene = scene,
                                   .date = date_now(),
                                   .plan = &plan_,
                                   .score = score_,
                                   .performance = performance,
                                   .before = std::move(before),
                                   .after = std::move(after)});
}

}  // namespace tact
