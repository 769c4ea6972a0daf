#include <spdlog/spdlog.h>

#include <cmath>
#include <utility>

#include "gui/render/mesh_level.hpp"
#include "gui/window/app_parts.hpp"
#include "gui/window/describe.hpp"
#include "ipc/base/error.hpp"
#include "ipc/base/units.hpp"

namespace tact {
namespace {

// A volume's ball is wider than its content, and the user works on a part of that.
constexpr float kReachShown = 0.8F;

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
            use_scene(std::move(loaded->start));
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

void GuiApp::use_scene(std::unique_ptr<SceneStart> start) {
    if (!programs_) programs_ = std::make_unique<Programs>();
    system().close();
    const SystemRow& row = system_row(content_->meta.kind);
    view_ = std::make_unique<SceneView>(content_, *programs_,
                                        row.refine != nullptr ? row.refine(content_) : RefineContour{});
    shown_ = static_cast<std::size_t>(&row - system_rows().data());
    state_.scene = describe(*content_);
    try {
        system().use(content_, std::move(start), *view_, context());
    } catch (const StartupError& e) {
        spdlog::error("{}", e.what());
        state_.scene.warning = e.what();
    }
    view_->approach_vertices(view_->vertices_max(), 1e9);  // at once: nothing is drawn yet
    vertices_share_ = resolution_share_ = 1.0;
    views_until_measured_ = kFirstMeasured;
    passes_.measure_next();
    resolution_saves_s_ = 0.0;
    state_.toggles.molecule = static_cast<int>(options_.look.style);
    state_.toggles.colouring = static_cast<int>(options_.look.colouring);
    camera_.frame(view_->radius_a());
    home_view();
    begin_as_left();
    browser_.used(content_->path, content_->meta.kind, content_->note, state_.browser);
    if (system().home_reach_a() > 0.0F) home_view();
    window_.set_title(std::string("Tact: ") + state_.scene.title);
    spdlog::info("showing {}: {} vertices", content_->path.string(), view_->vertices_max());
}

void GuiApp::home_view() {
    camera_.home();
    if (const float reach_a = content_ ? system().home_reach_a() : 0.0F; reach_a > 0.0F)
        camera_.approach(Eigen::Vector3f::Zero(), kReachShown * reach_a);
    camera_.zoom(static_cast<float>(std::log(options_.zoom) / std::log(1.0 / 0.9)));
}

// Restores style and view of the last run, if the scene is the same.
void GuiApp::begin_as_left() {
    const WindowState& window_state = options_.window_state;
    if (!std::exchange(as_left_wanted_, false)) return;
    if (options_.session_opened && options_.session_opened->scene_checksum == content_->checksum)
        system().restore(*options_.session_opened);
    if (window_state.scene != content_->checksum || window_state.distance_a <= 0.0) return;
    state_.toggles.style = window_state.toggles.style;
    state_.toggles.molecule = window_state.toggles.molecule;
    state_.toggles.colouring = window_state.toggles.colouring;
    const Vec3 origin_a = content_->centre_model_m / kAngstromM;
    const Vec3 target_a = window_state.target_a + window_state.origin_model_a.value_or(origin_a) - origin_a;
    camera_.place(target_a.cast<float>(), window_state.q_eye_scene.cast<float>(),
                  static_cast<float>(window_state.distance_a));
}

WindowState GuiApp::window_state() const {
    WindowState window_state;
    const Window::Size size = window_.size();
    window_state.width_px = size.width;
    window_state.height_px = size.height;
    window_state.traces = state_.strip == 1;
    window_state.span_choice = state_.span_choice;
    window_state.lateness_choice = state_.lateness_choice;
    window_state.toggles = state_.toggles;
    window_state.input = kept_input();
    if (content_) {
        window_state.scene = content_->checksum;
        window_state.origin_model_a = content_->centre_model_m / kAngstromM;
        window_state.target_a = camera_.target_a().cast<double>();
        window_state.q_eye_scene = camera_.orientation().cast<double>();
        window_state.distance_a = static_cast<double>(camera_.distance_a());
    }
    return window_state;
}

void GuiApp::keep_window_state() const {
    if (options_.window_state_file.empty()) return;
    try {
        write_window_state_file(options_.window_state_file, window_state());
    } catch (const StartupError& e) {
        spdlog::error("{}", e.what());
    }
}

void GuiApp::apply_level() {
    if (!view_) return;
    const PathLevel* const path = controller_.level(kMeshPath);
    // Without a controller the surface keeps its last level; initially full detail.
    const std::uint32_t most = view_->vertices_max();
    if (path != nullptr && most > 0)
        vertices_share_ =
            vertices_for(*path, fewest_shown(view_->vertices_min(), most), most) / static_cast<double>(most);
    view_->approach_vertices(static_cast<std::uint32_t>(std::lround(vertices_share_ * most)),
                             adapt_budget_s(clock_.frame_s()));
    if (const PathLevel* const resolution = controller_.level(kResolutionPath))
        resolution_share_ = static_cast<double>(resolution->level);
    if (controller_.have_levels && controller_.levels.sequence != levels_applied_) {
        levels_applied_ = controller_.levels.sequence;
        passes_.measure_soon();
    }
    state_.scene.mesh_error_m = view_->error_m();
}

}  // namespace tact
