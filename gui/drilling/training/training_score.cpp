#include "gui/drilling/training/training_score.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>

namespace tact {
namespace {

using State = TrainingItem::State;

constexpr double kSpillFree = 0.05, kSpillMost = 0.5;  // of the goals' bone
constexpr double kForceShareMost = 0.2, kSeenShare = 0.8;

template <class... T>
std::string text(const char* format, T... values) {
    char line[160];
    std::snprintf(line, sizeof line, format, values...);
    return line;
}

double within_one(double share) { return std::isfinite(share) ? std::clamp(share, 0.0, 1.0) : 0.0; }

std::string clock_text(double seconds) {
    const auto s = static_cast<long>(std::min(seconds, 1e6));
    return text("%ld:%02ld", s / 60, s % 60);
}

std::uint64_t injuries_of(const std::string& structure, const DrillMetricsRow& f,
                          const BoneLabelsView& labels) {
    std::uint64_t injuries = 0;
    for (std::size_t i = 0; i < labels.structure.size() && i + 1 < f.structure.size(); ++i)
        if (labels.structure[i].name == structure) injuries += f.structure[i + 1].injuries;
    return injuries;
}

std::string share_text(double share, double asked) {
    return text("%.0f %% of %.0f %%", std::floor(100.0 * share), 100.0 * asked);
}

class Sum {
public:
    Sum(const TrainingPlan& plan, TrainingScore& score) : plan_(plan), score_(score) {}
    void add(TrainingPart part, double share) {
        const double of = plan_.points[static_cast<std::size_t>(part)];
        if (of > 0.0) score_.part.push_back({part, within_one(share) * of, of});
    }
    void finish() const {
        double of = 0.0;
        for (const TrainingPoints& p : score_.part) {
            score_.total += p.points;
            of += p.of;
        }
        score_.total = of > 0.0 ? 100.0 * score_.total / of : 0.0;
    }

private:
    const TrainingPlan& plan_;
    TrainingScore& score_;
};

}  // namespace

TrainingScore training_score(const TrainingPlan& plan, const TrainingSums& sums, const DrillMetricsRow& f,
                             const BoneLabelsView& labels, const std::optional<BurrVisibility>& visibility,
                             double time_s) {
    TrainingScore score;
    score.time_s = time_s;
    Sum points(plan, score);
    double goal = 0.0, thin = 0.0;
    for (std::size_t i = 0; i < plan.goal.size(); ++i) {
        const double share = sums.goal[i].share(), asked = plan.goal[i].share;
        goal += within_one(share / asked);
        score.item.push_back(
            {share >= asked ? State::done : State::open, plan.goal[i].name, share_text(share, asked)});
    }
    for (std::size_t i = 0; i < plan.thin.size(); ++i) {
        const double share = sums.thin[i].share(), asked = plan.thin[i].share;
        const bool injured = injuries_of(plan.thin[i].structure, f, labels) > 0;
        thin += injured ? 0.0 : within_one(share / asked);
        score.item.push_back({injured          ? State::failed
                              : share >= asked ? State::done
                                               : State::open,
                              plan.thin[i].structure + " thinned",
                              injured ? "opened" : share_text(share, asked)});
    }
    score.work = (goal + thin) / static_cast<double>(plan.goal.size() + plan.thin.size());
    if (!plan.goal.empty()) points.add(TrainingPart::goal, goal / static_cast<double>(plan.goal.size()));
    if (!plan.thin.empty()) points.add(TrainingPart::thin, thin / static_cast<double>(plan.thin.size()));
    if (!plan.goal.empty()) {
        const double spill = static_cast<double>(std::max<std::int64_t>(sums.outside_taken, 0)) /
                             static_cast<double>(sums.any_goal.levels);
        points.add(TrainingPart::outside,
                   score.work * within_one((kSpillMost - spill) / (kSpillMost - kSpillFree)));
        score.item.push_back({spill <= kSpillFree ? State::done : State::failed, "bone outside the goal",
                              text("%.1f mm³", 1e9 * f.level_m3 * static_cast<double>(sums.outside_taken))});
    }
    double care = 1.0;
    for (std::size_t i = 0; i < plan.forbidden.size(); ++i) {
        const double mm3 = 1e9 * f.level_m3 * static_cast<double>(sums.forbidden[i].taken);
        const bool broken = mm3 > plan.forbidden[i].most_mm3;
        care *= broken ? 0.5 : 1.0;
        score.item.push_back({broken ? State::failed : State::done, plan.forbidden[i].name + " left",
                              mm3 > 0.0 ? text("%.2f mm³ taken", mm3) : "untouched"});
    }
    const bool critical = std::any_of(labels.structure.begin(), labels.structure.end(),
                                      [](const BoneStructure& s) { return s.critical; });
    if (critical) {
        care *= std::pow(0.5, static_cast<double>(f.injuries));
        score.item.push_back(
            {f.injuries > 0 ? State::failed : State::done, "no structure injured",
             f.injuries == 0 ? "" : text("%llu injured", static_cast<unsigned long long>(f.injuries))});
    }
    if (critical || !plan.forbidden.empty()) points.add(TrainingPart::structures, score.work * care);
    const double excess = f.drilling_s > 0.0 ? f.excess_s / f.drilling_s : 0.0;
    points.add(TrainingPart::force, score.work * (1.0 - excess / kForceShareMost));
    if (visibility && visibility->drilling_s > 0.0)
        points.add(TrainingPart::sight,
                   score.work * visibility->seen_s / visibility->drilling_s / kSeenShare);
    if (plan.time_s > 0.0) {
        points.add(TrainingPart::time, score.work * (2.0 - time_s / plan.time_s));
        const bool ready = score.work > 1.0 - 1e-9;
        score.item.push_back({time_s > plan.time_s ? State::failed
                              : ready              ? State::done
                                                   : State::open,
                              "time", clock_text(time_s) + " of " + clock_text(plan.time_s)});
    }
    points.finish();
    return score;
}

}  // namespace tact
