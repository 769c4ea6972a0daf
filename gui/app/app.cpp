#include "gui/app/app.hpp"

#include <csignal>

#include <imgui.h>
#include <spdlog/spdlog.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <cmath>
#include <memory>
#include <utility>
#include <vector>

#include "gui/app/body_list.hpp"
#include "gui/app/command_sender.hpp"
#include "gui/app/contour_child.hpp"
#include "gui/app/contour_rows.hpp"
#include "gui/app/controller.hpp"
#include "gui/app/describe.hpp"
#include "gui/app/detail_desk.hpp"
#include "gui/app/drill_show.hpp"
#include "gui/app/fit_desk.hpp"
#include "gui/app/frame_clock.hpp"
#include "gui/app/grounds.hpp"
#include "gui/app/mesh_level.hpp"
#include "gui/app/picture_files.hpp"
#include "gui/app/region_checks.hpp"
#include "gui/app/scene_loader.hpp"
#include "gui/app/second_hand.hpp"
#include "gui/app/show_controller.hpp"
#include "gui/app/touch_show.hpp"
#include "gui/app/window.hpp"
#include "gui/render/scene_view.hpp"
#include "gui/stage/stage.hpp"
#include "ipc/base/error.hpp"
#include "ipc/base/units.hpp"

namespace tact {
namespace {

volatile std::sig_atomic_t stop_signal = 0;
void on_signal(int number) { stop_signal = number; }

void catch_signals() {
    struct sigaction action {};
    action.sa_handler = on_signal;
    sigaction(SIGINT, &action, nullptr);
    sigaction(SIGTERM, &action, nullptr);
    sigaction(SIGHUP, &action, nullptr);
}

// Atoms or bonds drawn as impostors where the processor draws: more take longer than a picture may
// (tests/bench/draw_bench.cpp).
constexpr std::size_t kShapesMaxInSoftware = 8000;
// A volume's ball is wider than the bone in it, and one works on a part of that.
constexpr float kBoneShown = 0.8F;
constexpr float kBurrsShown = 4.0F;  // radii about a burr that is looked at

class App {
public:
    explicit App(const GuiOptions& options)
        : options_(options),
          controller_(options.session, region_.fd()),
          commands_(region_->commands),
          window_(options.width_px, options.height_px, options.hidden) {
        region_.mark_ready();
        state_.session = options.session;
        state_.renderer = window_.renderer();
        if (options.plain) {
            view_options_.gradient = false;
            const ImVec4 ground = ImGui::ColorConvertU32ToFloat4(colour::kGround);
            view_options_.plain_ground = Eigen::Vector3f(ground.x, ground.y, ground.z);
            state_.toggles.style = static_cast<int>(SurfaceStyle::solid);
        }
        view_options_.depth_cue = options.depth_cue;
        fps_max_ = options.fps_max >= 0.0 ? options.fps_max : (window_.paced_by_display() ? 0.0 : 60.0);
        if (options.stage.mode != StereoMode::off)
            stage_ = std::make_unique<Stage>(options.stage, window_.handle(), options.hidden,
                                             window_.paced_by_display());
        if (!options.scene.empty())
            start_loading(options.scene);
        else
            state_.scene.status = "No scene yet: it comes from the controller, or give one as an argument.";
        spdlog::info("drawing with {}{}", window_.renderer(), options.hidden ? ", hidden" : "");
    }

    int run() {
        const Instant begun = Monotonic::now();
        for (bool last = false; !last;) {
            const Instant now = Monotonic::now();
            // A picture is asked for to see the scene, so the time is not over before it is there.
            const bool picture_waits = pictures_.wanted_at_end() && loader_.running();
            last = stop_signal != 0 || window_.close_wanted() || (stage_ && stage_->close_wanted()) ||
                   (options_.seconds > 0.0 && to_s(now - begun) >= options_.seconds && !picture_waits);
            frame(now, last && pictures_.wanted_at_end());
            if (!last) clock_.pace(fps_max_);
        }
        desk_.finish_saving(std::chrono::seconds(8));  // whoever asked grants ten to end
        drilling_.save(controller_, options_.report);
        if (stop_signal != 0) spdlog::info("ended by signal {}", static_cast<int>(stop_signal));
        return pictures_.failed() ? 1 : 0;
    }

private:
    void frame(Instant now, bool take_picture) {
        clock_.begin();
        window_.begin_frame(theme_);
        const bool of_series = pictures_.series_due(now, view_ != nullptr);
        sharp_ = of_series || take_picture;
        const std::int64_t now_ns = to_ns(now);
        state_.now_ns = now_ns;
        state_.history.now_s = 1e-9 * static_cast<double>(now_ns - first_ns_);
        follow_controller(now_ns);
        follow_scene();
        drilling_.follow(controller_, state_);
        handle_input();
        if (view_) follow_contours(view_->contours(), content_->scale, state_.contours);
        obey_level();
        clock_.end_part(FramePart::adapt);
        if (view_) view_->upload();
        clock_.end_part(FramePart::upload);
        if (content_)
            drilling_.move(controller_, clock_.frame_s(),
                           content_->centre_model_m + kAngstromM * camera_.eye_a().cast<double>());
        clock_.end_part(FramePart::particles);
        draw_scene(now_ns);
        if (of_series) pictures_.save_of_series(window_.picture(), drawn_view_);
        clock_.end_part(FramePart::scene);
        draw_panels();
        clock_.end_part(FramePart::panels);
        if (take_picture) {
            pictures_.save_at_end(window_.picture());
            if (stage_ && view_) pictures_.save_stage(stage_->pictures());
        }
        if (std::exchange(picture_wanted_, false)) pictures_.save_now(window_.picture());
        window_.show();
        clock_.end_part(FramePart::swap);
        if (view_) drilling_.ended(*view_, clock_.work_s());
        publish_load();
    }

    void follow_controller(std::int64_t now_ns) {
        const Controller::News news = controller_.poll();
        if (news.left) {
            spdlog::warn("the controller of session {} is gone; waiting for the next", options_.session);
            commands_.forget();
            drilling_.leave();
        }
        if (news.arrived) {
            drilling_.meet(controller_);
            spdlog::info("attached to the controller of session {}", options_.session);
            list_.forget_motion();
            second_hand_.forget();
            commands_.forget();
            std::string path = controller_.scene_path();
            if (options_.scene.empty() && !path.empty() &&
                (!content_ || content_->checksum != controller_.scene_checksum()))
                start_loading(path);
        }
        const Controller::Fresh fresh = controller_.read();
        if (fresh.bodies) list_.follow(controller_.bodies);
        if (fresh.second) second_hand_.follow(controller_.second);
        if (fresh.health) add_health(controller_.health, state_.history);
        if (controller_.have_health) commands_.update(controller_.health, now_ns);
        show_controller(controller_, commands_, state_);
    }

    void start_loading(const std::string& path) {
        if (loader_.start(path))
            state_.scene.status = "Loading " + path + " ...";
        else
            next_scene_ = path;
    }

    void follow_scene() {
        if (auto loaded = loader_.poll()) {
            if (loaded->content) {
                content_ = std::move(loaded->content);
                use_scene();
            } else {
                spdlog::error("{}", loaded->error);
                const SceneFacts before = state_.scene;
                state_.scene = content_ ? before : SceneFacts{};
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

    void use_scene() {
        if (!programs_) programs_ = std::make_unique<Programs>();
        view_ = std::make_unique<SceneView>(content_, *programs_, refine_by_child(content_));
        if (!options_.contours.empty())
            view_->contours().set(contours_of(options_.contours, content_->scale));
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
        std::vector<Pose> homes;
        for (const Structure& structure : content_->bodies) homes.push_back(structure.home());
        list_.start(homes);
        if (controller_.have_bodies) list_.follow(controller_.bodies);
        desk_.use(content_);
        detail_.use(content_, state_.detail);
        state_.scene = describe(*content_);
        show_bone();
        window_.set_title(std::string("Tact: ") + state_.scene.title);
        spdlog::info("showing {}: {} vertices, {} bodies, {} atoms", content_->path.string(),
                     view_->vertices_max(), state_.scene.bodies, state_.scene.atoms);
    }

    void home_view() {
        camera_.home();
        if (content_ && content_->bone && bone_reach_a_ > 0.0F)
            camera_.approach(Eigen::Vector3f::Zero(), kBoneShown * bone_reach_a_);
        camera_.zoom(static_cast<float>(std::log(options_.zoom) / std::log(1.0 / 0.9)));
    }

    void look_at_burr() {
        if (!content_ || !controller_.attached() || !controller_.have_drill) return;
        const DrillHand& hand = controller_.drill.hand[0];
        if (hand.kind == DrillKind::none) return;
        const Vec3 at(hand.pos_model_m[0], hand.pos_model_m[1], hand.pos_model_m[2]);
        const double radius_m = static_cast<double>(hand.radius_m) / content_->meta.world_per_model;
        camera_.approach(((at - content_->centre_model_m) / kAngstromM).cast<float>(),
                         kBurrsShown * static_cast<float>(radius_m / kAngstromM));
    }

    void show_bone() {
        try {
            drilling_.use(content_, controller_, *view_, options_.particles);
        } catch (const StartupError& e) {
            spdlog::error("{}", e.what());
            state_.scene.warning = e.what();
        }
        if (view_->bone() == nullptr) return;
        bone_reach_a_ = view_->bone()->reach_a();
        home_view();
    }

    void handle_input() {
        const ImGuiIO& io = ImGui::GetIO();
        if (!io.WantCaptureMouse) {
            const float height =
                layout_for(theme_, io.DisplaySize.x, io.DisplaySize.y, middle_card(state_.scene)).view.height;
            if (io.MouseDown[0]) camera_.rotate(io.MouseDelta.x, io.MouseDelta.y, height);
            if (io.MouseDown[1]) camera_.pan(io.MouseDelta.x, io.MouseDelta.y, height);
            if (io.MouseWheel != 0.0F && io.KeyAlt && content_)
                nudge_contour(state_.contours, content_->scale, static_cast<double>(io.MouseWheel));
            else if (io.MouseWheel != 0.0F && !io.KeyCtrl && !io.KeyShift)
                camera_.zoom(io.MouseWheel);
        }
        for (const Key key : window_.take_keys()) {
            if (io.WantTextInput) continue;
            if (key == Key::home) home_view();
            if (key == Key::burr) look_at_burr();
            if (key == Key::style) state_.toggles.style = (state_.toggles.style + 1) % 3;
            if (key == Key::picture) picture_wanted_ = true;
            if (key == Key::swap_eyes && stage_) stage_->swap_eyes();
            if (key == Key::mark) state_.wishes.push_back({CommandKind::mark, 0.0, {}});
            if (key == Key::raise && content_) nudge_contour(state_.contours, content_->scale, 1.0);
            if (key == Key::lower && content_) nudge_contour(state_.contours, content_->scale, -1.0);
            if (key == Key::help) state_.show_keys = !state_.show_keys;
            if (key == Key::escape && state_.show_keys)
                state_.show_keys = false;
            else
                fitting_key(key);
        }
    }

    void fitting_key(Key key) {
        const auto active = list_.active();
        const std::uint32_t held = active ? list_.bodies()[*active].id : 0;
        const auto wish = [&](FitAct act) { state_.fit_wishes.push_back({act, held, {}}); };
        if (key == Key::escape) wish(FitAct::revert);
        if (key == Key::accept) wish(FitAct::accept);
        if (key == Key::undo) wish(FitAct::undo);
        if (key == Key::redo) wish(FitAct::redo);
        if (key == Key::refine && held != 0) wish(FitAct::refine);
        if (key < Key::body_0 || !controller_.attached()) return;
        const auto digit = static_cast<std::size_t>(key) - static_cast<std::size_t>(Key::body_0);
        if (digit == 0) state_.wishes.push_back({CommandKind::select_body, 0.0, {}, kNoBody});
        if (digit >= 1 && digit <= list_.bodies().size())
            state_.wishes.push_back({CommandKind::select_body, 0.0, {}, list_.bodies()[digit - 1].id});
    }

    void obey_level() {
        if (!view_) return;
        const PathLevel* const path = controller_.level(kMeshPath);
        // Without a controller the surface stays as it was last told; at first that is all of it.
        const std::uint32_t most = view_->vertices_max();
        if (path != nullptr && most > 0)
            vertices_share_ = vertices_for(*path, fewest_shown(view_->vertices_min(), most), most) /
                              static_cast<double>(most);
        view_->approach_vertices(static_cast<std::uint32_t>(std::lround(vertices_share_ * most)),
                                 adapt_budget_s(clock_.frame_s()));
        state_.scene.mesh_error_m = view_->error_m();
    }

    void follow_detail() {
        const bool touched = controller_.attached() && controller_.have_touch;
        if (const auto made = detail_.follow(touched ? &controller_.touch : nullptr, state_.toggles.detail,
                                             state_.detail, state_.wishes))
            view_->show_detail(*made);
    }

    void follow_bodies(std::int64_t now_ns) {
        list_.predict(now_ns);
        const BodiesTopic* const topic =
            controller_.attached() && controller_.have_bodies ? &controller_.bodies : nullptr;
        std::vector<Command> commands;
        for (const auto& [id, hidden] : state_.hide_wishes) list_.set_hidden(id, hidden);
        for (const FitWish& wish : state_.fit_wishes) desk_.act(wish, list_, commands);
        state_.hide_wishes.clear();
        state_.fit_wishes.clear();
        desk_.follow(list_, topic, commands);
        if (topic != nullptr)
            for (const Command& command : commands) commands_.send(command, now_ns);
        desk_.describe(list_, topic, state_.fitting, state_.fit);
    }

    void draw_scene(std::int64_t now_ns) {
        const Window::Size size = window_.size();
        const Layout layout = layout_for(theme_, static_cast<float>(size.width),
                                         static_cast<float>(size.height), middle_card(state_.scene));
        const PixelRect& rect = layout.view;
        const float to_px = static_cast<float>(size.width_px) / static_cast<float>(std::max(size.width, 1));
        ViewFrame view{};
        view.x_px = static_cast<int>(rect.x * to_px);
        view.width_px = std::max(size.width_px - view.x_px, 1);
        view.height_px = std::max(static_cast<int>(rect.height * to_px), 1);
        view.y_px = size.height_px - view.height_px;
        paint_grounds(layout, to_px, size.height_px);
        if (!programs_) programs_ = std::make_unique<Programs>();
        if (!view_ || !stage_) begin_view(view);
        state_.a_per_px = static_cast<double>(camera_.a_per_px(rect.height));
        const Eigen::Matrix3f axes = camera_.orientation().toRotationMatrix();
        for (int i = 0; i < 3; ++i)
            for (int k = 0; k < 3; ++k) state_.eye_axes[i][k] = axes(k, i);
        drawn_view_ = {view.x_px, view.y_px, view.width_px, view.height_px};
        if (!view_) return;
        follow_bodies(now_ns);
        shown_.clear();
        for (const ShownBody& b : list_.bodies())
            shown_.push_back({b.T_model_body, b.structure, b.id, b.hidden});
        view.bodies = shown_;
        view.active = list_.active().value_or(shown_.size());
        const PathLevel* const force =
            controller_.have_levels ? find_path(controller_.levels, kDockingPath) : nullptr;
        view.points_felt = force != nullptr ? force->items : 0;
        if (controller_.attached() && controller_.have_tool) {
            const double* const f = controller_.tool.force_model_n;
            view.force_world_n = Vec3(f[0], f[1], f[2]);
        }
        if (content_->bone) {
            drilling_.prepare(controller_, *view_, sharp_, view);
            if (near_burr_wanted_ && controller_.have_drill && controller_.drill.hand[0].depth > 0.0F) {
                near_burr_wanted_ = false;
                look_at_burr();
            }
        } else if (controller_.attached()) {
            view.second_hand = second_hand_.at(now_ns, content_->meta);
        }
        state_.second_hand = view.second_hand.has_value();
        if (const auto pen = touching_pen(controller_, *content_)) view.second_hand = pen;
        view.T_model_tool = touching_tool(controller_, *content_);
        if (view_options_.force && content_->meta.kind == SceneKind::surface)
            view.touch = touch_marks(controller_);
        follow_detail();
        state_.second_force_n = view.second_hand ? view.second_hand->force_world_n.norm() : 0.0;
        state_.second_at_wall = view.second_hand && view.second_hand->at_wall;
        state_.force_n = view.force_world_n.norm();
        state_.arrow_a_per_n = static_cast<double>(view_->arrow_a_per_n());
        const SceneToggles& t = state_.toggles;
        view_options_.surface = t.surface;
        view_options_.detail = t.detail && t.surface;
        view_options_.backbone = t.backbone;
        view_options_.codebook = t.codebook;
        view_options_.graph = t.graph;
        view_options_.force = t.force;
        view_options_.box = t.box;
        view_options_.style = static_cast<SurfaceStyle>(t.style);
        view_options_.depth_cue = t.depth_cue;
        view_->molecules().set_look(
            {static_cast<MoleculeStyle>(t.molecule), static_cast<Colouring>(t.colouring)});
        if (stage_)
            draw_stage(view, now_ns);
        else
            view_->draw(camera_.eye(static_cast<float>(view.width_px) / static_cast<float>(view.height_px)),
                        view_options_, view);
        drilling_.drawn(*view_, state_);
        if (const std::size_t left_out = view_->molecules().left_out(); left_out != left_out_) {
            left_out_ = left_out;
            if (left_out > 0)
                spdlog::info("bodies drawn as tubes, as this renderer has no time for their atoms: {}",
                             left_out);
        }
    }

    void begin_view(const ViewFrame& view) {
        glViewport(view.x_px, view.y_px, view.width_px, view.height_px);
        if (view_options_.gradient) programs_->draw_background();
    }

    void draw_stage(ViewFrame view, std::int64_t now_ns) {
        stage_->follow(controller_.attached() && controller_.have_head ? &controller_.head : nullptr, now_ns,
                       clock_.frame_s(), {view.x_px, view.y_px, view.width_px, view.height_px});
        view.x_px = view.y_px = 0;
        view.width_px = stage_->eye_width_px();
        view.height_px = stage_->eye_height_px();
        view.bone_rays /= 2;
        for (std::size_t eye = 0; eye < 2; ++eye) {
            view.eye = eye;
            stage_->begin(eye, view_options_.plain_ground);
            begin_view(view);
            view_->draw(stage_->eye(eye, camera_, content_->meta.world_per_model,
                                    content_->meta.to_world(content_->centre_model_m), view_->radius_a()),
                        view_options_, view);
        }
        stage_->show(window_.frame_buffer());
        state_.a_per_px = 0.0;  // each eye has a scale of its own
        state_.stage = std::string("stereo: ") + stage_words(*stage_);
        state_.head_lost = stage_->head().sight() == HeadSight::lost;
    }

    void draw_panels() {
        const ImGuiIO& io = ImGui::GetIO();
        draw_dashboard(theme_, state_, io.DisplaySize.x, io.DisplaySize.y);
        window_.draw_panels();
        for (const Wish& wish : state_.wishes)
            if (!commands_.send({wish.kind,
                                 wish.value,
                                 wish.text,
                                 wish.body,
                                 {Vec3(wish.second, 0.0, 0.0), Quat::Identity()}},
                                state_.now_ns))
                spdlog::warn("a command with a text too long was not sent");
        state_.wishes.clear();
    }

    void publish_load() {
        LoadTopic load{};
        load.taken_at_ns = to_ns(Monotonic::now());
        load.frame = clock_.frame();
        load.levels_sequence = controller_.have_levels ? controller_.levels.sequence : 0;
        load.frame_s = clock_.frame_s();
        load.busy_s = clock_.work_s() - (window_.paced_by_display() ? clock_.part_s(FramePart::swap) : 0.0);
        for (std::size_t i = 0; i < static_cast<std::size_t>(FramePart::count); ++i)
            load.part_s[i] = clock_.part_s(static_cast<FramePart>(i));
        load.cpu_s = FrameClock::process_cpu_s();
        load.fps = clock_.fps();
        const bool drawn = view_ && state_.toggles.surface;
        load.vertices_drawn = drawn ? view_->vertices() : 0;
        load.triangles_drawn = drawn ? view_->triangles() : 0;
        load.vertices_max = view_ ? view_->vertices_max() : 0;
        if (view_) drilling_.add_to(load, *view_);
        region_->load.publish(load);
        state_.load = load;
        const bool levels = controller_.have_levels && controller_.attached();
        add_load(load, levels ? &controller_.levels : nullptr, state_.history);
    }

    const GuiOptions options_;
    OwnedRegion<GuiRegion> region_;
    Controller controller_;
    CommandSender commands_;
    Window window_;
    Theme theme_;
    FrameClock clock_;
    DashboardState state_;
    const std::int64_t first_ns_ = to_ns(Monotonic::now());
    double fps_max_ = 60.0;
    // OpenGL objects go before the window: members are destroyed from below.
    std::unique_ptr<Stage> stage_;  // of a stereo picture
    std::unique_ptr<Programs> programs_;
    std::shared_ptr<const SceneContent> content_;
    std::unique_ptr<SceneView> view_;
    double vertices_share_ = 1.0;  // of what all surfaces have; stays as the controller last told
    FitDesk desk_;
    DetailDesk detail_;
    DrillShow drilling_{window_.software()};
    float bone_reach_a_ = 0.0F;
    bool near_burr_wanted_ = options_.near_burr;
    BodyList list_;
    SecondHand second_hand_;
    std::vector<DrawnBody> shown_;
    ViewOptions view_options_;
    Camera camera_;
    SceneLoader loader_;
    std::string next_scene_;  // asked for while another was being read
    std::size_t left_out_ = 0;
    PictureFiles pictures_{options_.screenshot, options_.every_s, options_.stage_screenshot};
    PictureFiles::View drawn_view_;
    bool picture_wanted_ = false;
    bool sharp_ = false;  // this frame is kept: all its rays
};

}  // namespace

int run_gui(const GuiOptions& options) {
    catch_signals();
    return App(options).run();
}

}  // namespace tact
