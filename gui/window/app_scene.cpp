#include <spdlog/spdlog.h>

#include <cmath>
#include <utility>

#include "gui/docking/contour_child.hpp"
#include "gui/docking/contour_rows.hpp"
#include "gui/render/mesh_level.hpp"
#include "gui/window/app_parts.hpp"
#include "gui/window/describe.hpp"
#include "ipc/base/error.hpp"
#include "ipc/base/units.hpp"

namespace tact {
namespace {

// Atoms or bonds drawn as impostors where the processor draws: more take longer than a picture may
// (tests/bench/draw_bench.cpp).
constexpr std::size_t kShapesMaxInSoftware = 8000;
// A volume's ball is wider than the bone in it, and one works on a part of that.
constexpr float kBoneShown = 0.8F;
constexpr float kBurrsShown = 4.0F;  // radii about a burr that is looked at

}  // namespace

void GuiApp::start_loading(const std::string& path) {
    if (loader_.start(path))
        state_.scene.status = "Loading " + path + " ...";
    else
        next_scene_ = path;
}

void GuiApp::follow_scene() {
    if (auto loaded = loader_.poll()) {
        if (loaded->content) {
            content_ = std::move(loaded->content);
            use_scene(std::move(loaded->drill));
        } else {
            spdlog::error("{}", loaded->error);
            const SceneState before = state_.scene;
            state_.scene = content_ ? before : SceneState{};
            state_.scene.status = loaded->error;
        }
    }
    if (!next_scene_.empty() && !loader_.running()) start_loading(std::exchange(next_scene_, {}));
    if (!content_ || !controller_.attached()) {
        state_.scene.warning.clear();
        return;
    }
    const std::uint64_t running = controller_.scene_checksum();
    state_.scene.warning = running != 0 && running != content_->checksum && !loader_.running()
                               ? "The controller runs another scene: " + controller_.scene_path()
                               : std::string();
}

void GuiApp::use_scene(DrillStart drill) {
    if (!programs_) programs_ = std::make_unique<Programs>();
    view_ = std::make_unique<SceneView>(content_, *programs_, refine_by_child(content_));
    if (!options_.contours.empty()) view_->contours().set(contours_of(options_.contours, content_->scale));
    view_->approach_vertices(view_->vertices_max(), 1e9);  // at once: nothing is drawn yet
    vertices_share_ = 1.0;
    // What is touched is hard: only a contour lets one see what is inside.
    if (content_->meta.kind == SceneKind::surface)
        state_.toggles.style = static_cast<int>(SurfaceStyle::solid);
    if (window_.software()) view_->molecules().set_shapes_max(kShapesMaxInSoftware);
    state_.toggles.molecule = static_cast<int>(options_.look.style);
    state_.toggles.colouring = static_cast<int>(options_.look.colouring);
    begin_contours(view_->contours(), content_->scale, state_.contours);
    camera_.frame(view_->radius_a());
    bone_reach_a_ = 0.0F;
    home_view();
    begin_as_left();
    std::vector<Pose> homes;
    for (const Structure& structure : content_->bodies) homes.push_back(structure.home());
    list_.start(homes);
    if (controller_.have_bodies) list_.follow(controller_.bodies);
    fit_controller_.use(content_);
    detail_.use(content_, state_.detail);
    state_.scene = describe(*content_);
    browser_.used(content_->path, state_.browser);
    show_bone(std::move(drill));
    window_.set_title(std::string("Tact: ") + state_.scene.title);
    spdlog::info("showing {}: {} vertices, {} bodies, {} atoms", content_->path.string(),
                 view_->vertices_max(), state_.scene.bodies, state_.scene.atoms);
}

void GuiApp::home_view() {
    camera_.home();
    if (content_ && content_->bone && bone_reach_a_ > 0.0F)
        camera_.approach(Eigen::Vector3f::Zero(), kBoneShown * bone_reach_a_);
    camera_.zoom(static_cast<float>(std::log(options_.zoom) / std::log(1.0 / 0.9)));
}

// The scene is drawn and seen as when the window was closed, if it is the same one.
void GuiApp::begin_as_left() {
    const WindowState& window_state = options_.window_state;
    if (!std::exchange(as_left_wanted_, false) || window_state.scene != content_->checksum ||
        window_state.distance_a <= 0.0)
        return;
    state_.toggles.style = window_state.toggles.style;
    state_.toggles.molecule = window_state.toggles.molecule;
    state_.toggles.colouring = window_state.toggles.colouring;
    camera_.place(window_state.target_a.cast<float>(), window_state.q_eye_scene.cast<float>(),
                  static_cast<float>(window_state.distance_a));
}

void GuiApp::keep_window_state() const {
    if (options_.window_state_file.empty()) return;
    WindowState window_state;
    const Window::Size size = window_.size();
    window_state.width_px = size.width;
    window_state.height_px = size.height;
    window_state.traces = state_.strip == 1;
    window_state.span_choice = state_.span_choice;
    window_state.lateness_choice = state_.lateness_choice;
    window_state.toggles = state_.toggles;
    if (content_) {
        window_state.scene = content_->checksum;
        window_state.target_a = camera_.target_a().cast<double>();
        window_state.q_eye_scene = camera_.orientation().cast<double>();
        window_state.distance_a = static_cast<double>(camera_.distance_a());
    }
    try {
        write_window_state_file(options_.window_state_file, window_state);
    } catch (const StartupError& e) {
        spdlog::error("{}", e.what());
    }
}

void GuiApp::look_at_burr() {
    if (!content_ || !controller_.attached() || !controller_.have_drill) return;
    const DrillHand& hand = controller_.drill.hand[0];
    if (hand.kind == DrillKind::none) return;
    const Vec3 at(hand.pos_model_m[0], hand.pos_model_m[1], hand.pos_model_m[2]);
    const double radius_m = static_cast<double>(hand.radius_m) / content_->meta.world_per_model;
    camera_.approach(((at - content_->centre_model_m) / kAngstromM).cast<float>(),
                     kBurrsShown * static_cast<float>(radius_m / kAngstromM));
}

void GuiApp::show_bone(DrillStart drill) {
    try {
        drilling_.use(content_, controller_, std::move(drill), *view_, options_.particles);
    } catch (const StartupError& e) {
        spdlog::error("{}", e.what());
        state_.scene.warning = e.what();
    }
    if (view_->bone() == nullptr) return;
    bone_reach_a_ = view_->bone()->reach_a();
    home_view();
}

void GuiApp::apply_level() {
    if (!view_) return;
    const PathLevel* const path = controller_.level(kMeshPath);
    // Without a controller the surface stays as it was last told; at first that is all of it.
    const std::uint32_t most = view_->vertices_max();
    if (path != nullptr && most > 0)
        vertices_share_ =
            vertices_for(*path, fewest_shown(view_->vertices_min(), most), most) / static_cast<double>(most);
    view_->approach_vertices(static_cast<std::uint32_t>(std::lround(vertices_share_ * most)),
                             adapt_budget_s(clock_.frame_s()));
    state_.scene.mesh_error_m = view_->error_m();
}

void GuiApp::follow_detail() {
    const bool touched = controller_.attached() && controller_.have_touch;
    if (const auto made = detail_.follow(touched ? &controller_.touch : nullptr, state_.toggles.detail,
                                         state_.detail, state_.requests))
        view_->show_detail(*made);
}

void GuiApp::follow_bodies(std::int64_t now_ns) {
    list_.predict(now_ns);
    const BodiesTopic* const topic =
        controller_.attached() && controller_.have_bodies ? &controller_.bodies : nullptr;
    std::vector<Command> commands;
    for (const auto& [id, hidden] : state_.fitting.hide_requests) list_.set_hidden(id, hidden);
    for (const FitRequest& request : state_.fitting.requests) fit_controller_.act(request, list_, commands);
    state_.fitting.hide_requests.clear();
    state_.fitting.requests.clear();
    fit_controller_.follow(list_, topic, commands);
    if (topic != nullptr)
        for (const Command& command : commands) commands_.send(command, now_ns);
    fit_controller_.describe(list_, topic, state_.fitting, state_.fit);
}

}  // namespace tact
