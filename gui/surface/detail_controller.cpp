#include "gui/surface/detail_controller.hpp"

#include <algorithm>

#include "gui/render/viridis.hpp"
#include "gui/surface/surface_content.hpp"

namespace tact {
namespace {

// Radius without a cut of the controller, in the hand's world: that of tact-rt at its highest level.
constexpr double kAloneWorldM = 4e-3;
// Smaller motion of the tool does not change the cut visibly.
constexpr double kStillRadii = 0.02;
constexpr int kPatienceFrames = 60;

static_assert(static_cast<int>(DetailShape::bell) == static_cast<int>(FilterForm::Shape::bell) &&
              static_cast<int>(DetailShape::multiple_frustum) ==
                  static_cast<int>(FilterForm::Shape::multiple_frustum));

void paint_scale(DetailState& state) {
    for (std::size_t i = 0; i < state.colours.size(); ++i) {
        const auto c =
            light_viridis(1.0F - (static_cast<float>(i) + 0.5F) / static_cast<float>(state.colours.size()));
        state.colours[i] = IM_COL32(c[0], c[1], c[2], 255);
    }
}

}  // namespace

void DetailController::use(std::shared_ptr<const SceneContent> content, DetailState& state) {
    worker_.reset();
    requested_.reset();
    asked_.reset();
    of_controller_before_ = false;
    content_ = std::move(content);
    state = {};
    const SurfaceContent* const surface = content_->of<SurfaceContent>();
    state.possible = surface != nullptr && surface->detail != nullptr;
    paint_scale(state);
}

std::optional<DetailMesh> DetailController::follow(const TouchTopic* touch, bool& shown, DetailState& state,
                                                   std::vector<Request>& requests) {
    if (!state.possible) return std::nullopt;
    state.felt = touch != nullptr && touch->detail > 0;
    state.full = state.felt && touch->detail == 2;
    shown = shown || (state.felt && !of_controller_before_);
    of_controller_before_ = state.felt;
    DetailRequest request;
    request.radius_m = kAloneWorldM / std::max(content_->meta.world_per_model, 1e-9);
    if (touch != nullptr)
        request.probe_m = Vec3(touch->proxy_model_m[0], touch->proxy_model_m[1], touch->proxy_model_m[2]);
    if (state.felt) {
        const FilterForm chosen{static_cast<FilterForm::Shape>(state.shape), state.width, state.error_far};
        if (state.changed) {
            asked_ = chosen;
            frames_asked_ = 0;
            requests.push_back({CommandKind::set_detail_filter,
                                static_cast<double>(state.width),
                                {},
                                static_cast<std::uint32_t>(state.shape),
                                static_cast<double>(state.error_far)});
        }
        request.radius_m = static_cast<double>(touch->detail_radius_model_m);
        request.form = {static_cast<FilterForm::Shape>(touch->detail_shape), touch->detail_width,
                        touch->detail_error_far};
        // The user's choice stays until the controller applies it, or for about a second.
        if (asked_ && (request.form == *asked_ || ++frames_asked_ > kPatienceFrames)) asked_.reset();
        if (!state.editing && !asked_) {
            state.shape = static_cast<int>(touch->detail_shape);
            state.width = touch->detail_width;
            state.error_far = touch->detail_error_far;
        }
        state.vertices = touch->detail_vertices;
        state.triangles = touch->detail_triangles;
        state.near_triangles = touch->near_triangles;
        state.deviation_m = static_cast<double>(touch->deviation_model_m);
        state.turn_s = static_cast<double>(touch->turn_s);
        state.turn_predicted_s = static_cast<double>(touch->turn_predicted_s);
    } else {
        request.form = {static_cast<FilterForm::Shape>(state.shape), state.width, state.error_far};
    }
    state.changed = false;
    state.radius_m = request.radius_m;
    if (!shown || !request.form.possible() || !(request.radius_m > 0.0)) {
        if (worker_) worker_->request(std::nullopt);
        return std::nullopt;
    }
    if (!worker_) worker_ = std::make_unique<DetailWorker>(content_);
    const bool still = requested_ && requested_->radius_m == request.radius_m &&
                       requested_->form == request.form &&
                       (requested_->probe_m - request.probe_m).norm() < kStillRadii * request.radius_m;
    if (!still) requested_ = request;
    worker_->request(requested_);
    state.error = worker_->error();
    std::optional<DetailMesh> made = worker_->take();
    if (made) {
        state.finest_m = made->finest_m;
        state.coarsest_m = made->coarsest_m;
        if (!state.felt) {
            state.vertices = made->vertices;
            state.triangles = made->triangles;
            state.deviation_m = made->deviation_m;
        }
    }
    return made;
}

}  // namespace tact
