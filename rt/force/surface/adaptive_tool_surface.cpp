#include "rt/force/surface/adaptive_tool_surface.hpp"

#include "ipc/base/clock.hpp"
#include "ipc/base/error.hpp"
#include "ipc/topics/command.hpp"

namespace tact {
namespace {

constexpr double kTurnLearns = 0.05;  // filter weight of each slow update

}  // namespace

AdaptiveToolSurface::AdaptiveToolSurface(const SurfaceMesh& full, const VertexForest& forest, double tool_m,
                                         double world_per_model)
    : surface_(full, forest,
               {.least_m = tool_m + kLeastM / world_per_model, .most_m = tool_m + kMostM / world_per_model}) {
}

void AdaptiveToolSurface::slow_update(const Vec3& velocity_m_s) noexcept {
    const Whereabouts& now = whereabouts_.newest();
    if (!now.valid) return;
    const Instant begin = Monotonic::now();
    refined_ = surface_.slow_update(now.proxy_m, velocity_m_s, now.fidelity, now.form);
    const double took_s = to_s(Monotonic::now() - begin);
    turn_s_ += (turns_ == 0 ? 1.0 : kTurnLearns) * (took_s - turn_s_);
    if (turns_++ % kDeviationEvery == 0) deviation_m_ = surface_.deviation_m();
    published_.back() = {refined_, deviation_m_, now.fidelity, turn_s_};
    published_.publish();
}

void AdaptiveToolSurface::is_at(const Vec3& proxy_m, float fidelity) noexcept {
    whereabouts_.back() = {proxy_m, fidelity, form_, true};
    whereabouts_.publish();
    news_ = published_.newest();
}

bool AdaptiveToolSurface::order(const ModelOrder& order) noexcept {
    const bool filter = order.kind == ModelOrder::Kind::setting &&
                        static_cast<CommandKind>(order.command) == CommandKind::set_detail_filter;
    if (!filter || order.body > 0xFFU) return false;
    const FilterForm form{static_cast<FilterForm::Shape>(order.body), static_cast<float>(order.value),
                          static_cast<float>(order.T_model_body.p_m.x())};
    if (!form.possible()) return false;
    form_ = form;
    return true;
}

SurfaceDetail AdaptiveToolSurface::detail() const noexcept {
    return {.valid = true,
            .full = news_.step.full_detail,
            .radius_m = surface_.radius_m(news_.fidelity),
            .shape = static_cast<DetailShape>(form_.shape),
            .width = form_.width,
            .error_far = form_.error_far,
            .deviation_m = static_cast<double>(news_.deviation_m),
            .vertices = news_.step.vertices,
            .triangles = news_.step.triangles,
            .near_triangles = static_cast<std::uint32_t>(surface_.predicted_triangles(news_.fidelity)),
            .turn_s = news_.turn_s,
            .turn_predicted_s = surface_.predicted_s(news_.fidelity)};
}

std::unique_ptr<AdaptiveToolSurface> tended_surface(const SurfaceMesh& full, const VertexForest* forest,
                                                    double tool_m, double world_per_model) {
    if (forest == nullptr)
        throw StartupError("touching a surface in mode chr", "the scene has no forest",
                           "bake it without --no-forest, or choose mode off-tree");
    return std::make_unique<AdaptiveToolSurface>(full, *forest, tool_m, world_per_model);
}

}  // namespace tact
