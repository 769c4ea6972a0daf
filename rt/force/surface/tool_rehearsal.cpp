#include "rt/force/surface/tool_rehearsal.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

#include "rt/force/surface/tool_model.hpp"

namespace tact {
namespace {

// Times of a step, of a move, of a point in a move and of queries: those measured at 2.6 GHz (TOOLS.md) times 1.25.
constexpr double kStepUs = 5.0, kMoveUs = 2.0, kMovePointUs = 0.0022, kLookUs = 1.6, kAskUs = 0.8;
constexpr double kCircleS = 0.3, kTurnRad = 0.3, kDownM_s = 0.1;
constexpr std::uint32_t kToReach = 400;  // steps until the tool touches
constexpr std::size_t kEnough = 300;     // steps of a level
constexpr double kCostly = 0.5;          // of the rare work
constexpr double kSpeedLeast = 0.05, kSpeedMost = 50.0;

struct Step {
    double work_us, measured_us;
};

// A hand that strokes about a place of the surface.
class Strokes {
public:
    Strokes(ToolModel& model, const SceneMeta& meta, const Vec3& place_m, const Vec3& up, double below_m,
            const SurfaceSettings& settings)
        : model_(model),
          meta_(meta),
          up_(up),
          across_(up.unitOrthogonal()),
          along_(up.cross(across_)),
          press_m_(ToolRehearsal::kPressN / settings.stiffness_n_m) {
        hand_.T_world_tool.p_m = meta.to_world(place_m + below_m * up);
        model.reset(hand_);
    }
    // False: the tool does not come to rest or touches nothing.
    bool approach(const Budget& budget, double step_s) {
        for (int i = 0; i < ToolContact::kSeatingMost && model_.contact().seating(); ++i)
            static_cast<void>(model_.step(hand_, budget));
        for (std::uint32_t i = 0; i < kToReach && model_.tool_touch().places == 0; ++i)
            static_cast<void>(step(budget, step_s, 0.0));
        return model_.tool_touch().places > 0;
    }
    Step step(const Budget& budget, double step_s, double speed_m_s = ToolRehearsal::kStrokeM_s) {
        Vec3& p_m = hand_.T_world_tool.p_m;
        const double phase = 2.0 * std::numbers::pi * t_s_ / kCircleS;
        const Vec3 aside_m_s = speed_m_s * (std::cos(phase) * across_ + std::sin(phase) * along_);
        const double high_m = up_.dot(meta_.to_world(model_.contact().proxy().p_m) - p_m);
        const double down_m = std::clamp(press_m_ - high_m, -kDownM_s * step_s, kDownM_s * step_s);
        p_m += step_s * aside_m_s - down_m * up_;
        hand_.T_world_tool.q =
            Quat(Eigen::AngleAxisd(kTurnRad * std::sin(2.0 * std::numbers::pi * t_s_), up_));
        hand_.twist_world.linear_m_s = aside_m_s - down_m / step_s * up_;
        t_s_ += step_s;
        const StepResult result = model_.step(hand_, budget);
        const ToolTouch& touch = model_.tool_touch();
        return {tool_work_us(touch.moves, result.load.items, touch.looked, touch.asked),
                to_us(result.load.cost)};
    }

private:
    ToolModel& model_;
    const SceneMeta& meta_;
    ToolState hand_;
    Vec3 up_, across_, along_;
    double press_m_, t_s_ = 0.0;
};

// How far the hand's point is above a place that the tool touches from above.
double height_m(const TouchTool& tool, const Vec3& up) {
    double lowest_m = 0.0;
    for (std::size_t i = 0; i < tool.points(); ++i) lowest_m = std::min(lowest_m, up.dot(tool.at_m(i)));
    return 2.0 * tool.ball_m - lowest_m;
}

double exceeded_once_in(double rare, std::vector<Step>& steps) {
    const auto place = static_cast<std::size_t>(static_cast<double>(steps.size()) * (1.0 - 1.0 / rare));
    const auto at = steps.begin() + static_cast<std::ptrdiff_t>(std::min(place, steps.size() - 1));
    std::nth_element(steps.begin(), at, steps.end(),
                     [](const Step& a, const Step& b) { return a.work_us < b.work_us; });
    return at->work_us;
}

}  // namespace

double tool_work_us(double moves, double points, double looked, double asked) noexcept {
    return kStepUs + moves * (kMoveUs + kMovePointUs * points) + kLookUs * looked + kAskUs * asked;
}

Duration ToolRehearsal::cost(float level) const noexcept {
    std::size_t above = 1;
    while (above + 1 < kLevels.size() && level > kLevels[above]) ++above;
    const double part = std::clamp(
        static_cast<double>((level - kLevels[above - 1]) / (kLevels[above] - kLevels[above - 1])), 0.0, 1.0);
    return Duration(std::llround(
        1e3 * speed * std::exp(std::lerp(std::log(work_us[above - 1]), std::log(work_us[above]), part))));
}

ToolRehearsal rehearse_tool(const SceneMeta& meta, const SurfaceMesh& mesh, const TouchTool& tool,
                            const SurfaceSettings& settings, double step_s, double most_s) {
    ToolRehearsal made;
    if (settings.mode == SurfaceMode::off_brute) return made;
    SurfaceSettings in_tree = settings;  // a step on the adaptive surface costs as much or less
    if (in_tree.mode == SurfaceMode::chr) in_tree.mode = SurfaceMode::off_tree;
    ToolModel model(meta, mesh, tool, in_tree);
    std::array<std::vector<Step>, ToolRehearsal::kLevels.size()> steps;
    const Instant end = Monotonic::now() + Duration(std::llround(1e9 * most_s));
    // Place by place, and the first one in any case, so that a short time still sees all levels.
    const auto in_time = [end](std::uint32_t place) { return place == 0 || Monotonic::now() < end; };
    for (std::uint32_t place = 0; place < ToolRehearsal::kPlaces; ++place) {
        const double part = (place + 0.5) / ToolRehearsal::kPlaces;
        const auto vertex = static_cast<std::uint32_t>(part * static_cast<double>(mesh.vertices()));
        const Vec3 up = mesh.normal(vertex);
        for (std::size_t i = 0; i < steps.size() && in_time(place); ++i) {
            const Budget budget{.fidelity = ToolRehearsal::kLevels[i]};
            Strokes strokes(model, meta, mesh.position_m(vertex), up, height_m(tool, up), in_tree);
            if (!strokes.approach(budget, step_s)) break;
            for (std::uint32_t n = 0; n < ToolRehearsal::kSteps && in_time(place); ++n)
                steps[i].push_back(strokes.step(budget, step_s));
        }
    }
    std::vector<double> ratio;
    for (std::size_t i = 0; i < steps.size(); ++i) {
        if (steps[i].size() < kEnough) return {};
        made.work_us[i] = exceeded_once_in(ToolRehearsal::kRare, steps[i]);
        for (const Step& s : steps[i])
            if (s.work_us >= kCostly * made.work_us[i]) ratio.push_back(s.measured_us / s.work_us);
        // A higher level costs no less.
        if (i > 0) made.work_us[i] = std::max(made.work_us[i], made.work_us[i - 1]);
    }
    const auto middle = ratio.begin() + static_cast<std::ptrdiff_t>(ratio.size() / 2);
    std::nth_element(ratio.begin(), middle, ratio.end());
    made.speed = std::clamp(*middle, kSpeedLeast, kSpeedMost);
    return made;
}

}  // namespace tact
