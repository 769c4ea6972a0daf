// The training session of a drilling scene: begun with the scene, fed with its changes, reported at the end.
#include <spdlog/spdlog.h>

#include <thread>

#include "gui/drilling/drilling_system.hpp"
#include "gui/drilling/training/training_pictures.hpp"
#include "ipc/base/clock.hpp"
#include "ipc/base/error.hpp"
#include "ipc/base/units.hpp"

namespace tact {
namespace {

constexpr auto kRestMost = std::chrono::seconds(1);
constexpr int kCalm = 3;  // looks in a row without a change

}  // namespace

std::optional<BurrVisibility> DrillingSystem::visibility() const {
    if (!site_) return std::nullopt;
    return BurrVisibility{site_->metrics().drilling_s, site_->metrics().seen_s};
}

void DrillingSystem::begin_training(const BoneContent& bone) {
    if (options_.training.plan.empty()) return;
    try {
        training_ =
            std::make_unique<Training>(read_training_plan(options_.training.plan), options_.training,
                                       TrainingBone{.volume = &bone.volume,
                                                    .labels = &bone.labels,
                                                    .distances = bone.distances,
                                                    .patient = bone.patient ? &*bone.patient : nullptr,
                                                    .checksum = content_->checksum});
    } catch (const StartupError& e) {
        panels_.training.problem = e.what();
        spdlog::error("{}", e.what());
    }
}

void DrillingSystem::train(const SystemContext& context) {
    if (!training_) return;
    for (const BrickChange& c : bone_.changes()) training_->brick(c.brick, c.before, c.after);
    const auto metrics = controller_.metrics();
    if (!metrics) return;
    training_->follow(context.state.now_ns, *metrics, visibility());
    panels_.training = {.on = true,
                        .title = training_->plan().title,
                        .task = training_->plan().task,
                        .begun = training_->begun(),
                        .score = training_->score(),
                        .problem = {}};
}

std::vector<TrainingPicture> DrillingSystem::pictures() {
    Vec3 middle_m;
    double radius_m = 0.0;
    Eigen::Vector3f middle_a = Eigen::Vector3f::Zero();
    if (training_->volumes().goal_ball(middle_m, radius_m))
        middle_a = ((middle_m - content_->centre_model_m) / kAngstromM).cast<float>();
    return training_pictures(*view_, *layer_, reach_a_, middle_a, static_cast<float>(radius_m / kAngstromM));
}

void DrillingSystem::let_training_rest(const SystemContext& context) {
    Controller& controller = context.controller;
    if (!training_ || !training_->begun() || !controller.attached()) return;
    context.commands.send({.kind = CommandKind::disarm}, to_ns(Monotonic::now()));
    const Instant until = Monotonic::now() + kRestMost;
    int calm = 0;
    while (calm < kCalm && Monotonic::now() < until) {
        std::this_thread::sleep_for(std::chrono::milliseconds(10));
        if (controller.poll().left) return;
        static_cast<void>(controller.read());
        context.state.now_ns = to_ns(Monotonic::now());
        follow(context);
        const auto run = static_cast<RunState>(controller.health.state);
        const bool stands = run == RunState::ready || run == RunState::fault || run == RunState::off;
        calm = stands && bone_.changes().empty() ? calm + 1 : 0;
    }
}

// The window closes: what the launcher prints of it.
nlohmann::json DrillingSystem::end_training() {
    const auto metrics = controller_.metrics();
    if (!training_ || !metrics || !training_->begun()) return nullptr;
    const nlohmann::json performance = drill_report(*metrics, content_->of<BoneContent>()->labels,
                                                    visibility(), content_->of<BoneContent>()->patient);
    const TrainingScore& score = training_->score();
    std::vector<TrainingPicture> after;
    if (layer_->bone() != nullptr) after = pictures();
    const std::string page =
        training_
            ->finish(
                content_->meta.title[0] != '\0' ? content_->meta.title : content_->path.filename().string(),
                performance, std::move(before_), std::move(after))
            .string();
    return {{"training", {{"task", training_->plan().title}, {"points", score.total}, {"report", page}}}};
}

}  // namespace tact
