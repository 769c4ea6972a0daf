// A training task of arbitrary bytes: refused with a message of bounded length, or a plan within its bounds.
#include <cmath>

#include "gui/drilling/training/training_plan.hpp"
#include "ipc/base/error.hpp"
#include "tests/fuzz/fuzz.hpp"

namespace tact::fuzz {
namespace {

void check(const TrainingRegion& r) {
    require(r.a_mm.allFinite() && r.b_mm.allFinite() && r.a_mm.cwiseAbs().maxCoeff() <= 1e5);
    if (r.kind == TrainingRegion::Kind::sphere) require(r.radius_mm > 0.0 && r.radius_mm <= 1e3);
    if (r.kind == TrainingRegion::Kind::box) require((r.b_mm - r.a_mm).minCoeff() > 0.0);
    require(r.margin_mm >= 0.0 && r.margin_mm <= 20.0);
}

}  // namespace

bool run(std::span<const std::byte> input) {
    const std::string_view text(reinterpret_cast<const char*>(input.data()), input.size());
    TrainingPlan p;
    try {
        p = read_training_plan_text(text, "task", "/tmp");
    } catch (const StartupError& e) {
        require(std::string_view(e.what()).size() < 8192 + 4 * input.size());
        return false;
    }
    require(!p.title.empty() && p.title.size() <= 2000 && p.task.size() <= 2000);
    require(p.time_s == 0.0 || (p.time_s >= 1.0 && p.time_s <= 1e5));
    require(!p.goal.empty() || !p.thin.empty());
    require(p.goal.size() <= TrainingPlan::kRegionsMost && p.thin.size() <= TrainingPlan::kRegionsMost &&
            p.forbidden.size() <= TrainingPlan::kRegionsMost);
    for (const TrainingGoal& g : p.goal) {
        check(g.region);
        require(!g.name.empty() && g.share >= 0.01 && g.share <= 1.0);
    }
    for (const TrainingThin& t : p.thin)
        require(t.leave_mm >= 0.1 && t.leave_mm <= 10.0 && t.share >= 0.01 && t.share <= 1.0);
    for (const TrainingForbidden& f : p.forbidden) {
        check(f.region);
        require(!f.name.empty() && f.most_mm3 >= 0.0 && f.most_mm3 <= 1e6);
    }
    for (const double points : p.points) require(points >= 0.0 && points <= 1000.0);
    return true;
}

std::vector<Input> seeds() {
    std::vector<Input> all;
    for (const std::string& text :
         {std::string("title = 'T'\ntime_s = 3\n[[goal]]\nname = 'g'\nsphere = { centre_mm = [1, 2, 3], "
                      "radius_mm = 4 }\n"),
          std::string("title = 'T'\nframe = 'patient'\n[[goal]]\nname = 'g'\nbox = { from_mm = [1, 2, 3], "
                      "to_mm = [4, 5, 6] }\n"
                      "[[forbidden]]\nstructure = 'dura'\nmargin_mm = 1\n[points]\ngoal = 10\n"),
          std::string("title = 'T'\n[[thin]]\nstructure = 'sinus'\nleave_mm = 1.5\nshare = "
                      "0.1\n[[goal]]\nname = 'e'\nexpert = 'a.bone'\n")})
        all.emplace_back(std::as_bytes(std::span(text)).begin(), std::as_bytes(std::span(text)).end());
    return all;
}

}  // namespace tact::fuzz
