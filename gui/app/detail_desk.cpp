#include "gui/app/detail_desk.hpp"

#include <algorithm>

#include "gui/render/viridis.hpp"

namespace tact {
namespace {

// Where the controller keeps none: so much of the hand's world about the tool, as tact-rt's knob would at its top.
constexpr double kAloneWorldM = 4e-3;
// A tool that moves by less changes no cut that a person could tell.
constexpr double kStillRadii = 0.02;
constexpr int kPatienceFrames = 60;

static_assert(static_cast<int>(DetailShape::bell) == static_cast<int>(FilterForm::Shape::bell) &&
              static_cast<int>(DetailShape::multiple_frustum) ==
                  static_cast<int>(FilterForm::Shape::multiple_frustum));

void paint_scale(DetailFacts& facts) {
    for (std::size_t i = 0; i < facts.colours.size(); ++i) {
        const auto c =
            light_viridis(1.0F - (static_cast<float>(i) + 0.5F) / static_cast<float>(facts.colours.size()));
        facts.colours[i] = IM_COL32(c[0], c[1], c[2], 255);
    }
}

}  // namespace

void DetailDesk::use(std::shared_ptr<const SceneContent> content, DetailFacts& facts) {
    worker_.reset();
    wished_.reset();
    asked_.reset();
    felt_before_ = false;
    content_ = std::move(content);
    facts = {};
    facts.possible = content_->detail != nullptr;
    paint_scale(facts);
}

std::optional<DetailMesh> DetailDesk::follow(const TouchTopic* touch, bool& shown, DetailFacts& facts,
                                             std::vector<Wish>& wishes) {
    if (!facts.possible) return std::nullopt;
    facts.felt = touch != nullptr && touch->detail > 0;
    facts.full = facts.felt && touch->detail == 2;
    shown = shown || (facts.felt && !felt_before_);
    felt_before_ = facts.felt;
    DetailWish wish;
    wish.radius_m = kAloneWorldM / std::max(content_->meta.world_per_model, 1e-9);
    if (touch != nullptr)
        wish.probe_m = Vec3(touch->proxy_model_m[0], touch->proxy_model_m[1], touch->proxy_model_m[2]);
    if (facts.felt) {
        const FilterForm chosen{static_cast<FilterForm::Shape>(facts.shape), facts.width, facts.error_far};
        if (facts.changed) {
            asked_ = chosen;
            frames_asked_ = 0;
            wishes.push_back({CommandKind::set_detail_filter,
                              static_cast<double>(facts.width),
                              {},
                              static_cast<std::uint32_t>(facts.shape),
                              static_cast<double>(facts.error_far)});
        }
        wish.radius_m = static_cast<double>(touch->detail_radius_model_m);
        wish.form = {static_cast<FilterForm::Shape>(touch->detail_shape), touch->detail_width,
                     touch->detail_error_far};
        // What a person chose stays until the controller has it, or has not for a second or so.
        if (asked_ && (wish.form == *asked_ || ++frames_asked_ > kPatienceFrames)) asked_.reset();
        if (!facts.editing && !asked_) {
            facts.shape = static_cast<int>(touch->detail_shape);
            facts.width = touch->detail_width;
            facts.error_far = touch->detail_error_far;
        }
        facts.vertices = touch->detail_vertices;
        facts.triangles = touch->detail_triangles;
        facts.near_triangles = touch->near_triangles;
        facts.deviation_m = static_cast<double>(touch->deviation_model_m);
        facts.turn_s = static_cast<double>(touch->turn_s);
        facts.turn_predicted_s = static_cast<double>(touch->turn_predicted_s);
    } else {
        wish.form = {static_cast<FilterForm::Shape>(facts.shape), facts.width, facts.error_far};
    }
    facts.changed = false;
    facts.radius_m = wish.radius_m;
    if (!shown || !wish.form.possible() || !(wish.radius_m > 0.0)) {
        if (worker_) worker_->wish(std::nullopt);
        return std::nullopt;
    }
    if (!worker_) worker_ = std::make_unique<DetailWorker>(content_);
    const bool still = wished_ && wished_->radius_m == wish.radius_m && wished_->form == wish.form &&
                       (wished_->probe_m - wish.probe_m).norm() < kStillRadii * wish.radius_m;
    if (!still) wished_ = wish;
    worker_->wish(wished_);
    facts.error = worker_->error();
    std::optional<DetailMesh> made = worker_->take();
    if (made) {
        facts.finest_m = made->finest_m;
        facts.coarsest_m = made->coarsest_m;
        if (!facts.felt) {
            facts.vertices = made->vertices;
            facts.triangles = made->triangles;
            facts.deviation_m = made->deviation_m;
        }
    }
    return made;
}

}  // namespace tact
