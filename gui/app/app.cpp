#include "gui/app/app.hpp"

#include <csignal>

#include <imgui.h>
#include <spdlog/spdlog.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <cmath>
#include <future>
#include <memory>
#include <vector>

#include "gui/app/command_sender.hpp"
#include "gui/app/contour_child.hpp"
#include "gui/app/controller.hpp"
#include "gui/app/describe.hpp"
#include "gui/app/fit_worker.hpp"
#include "gui/app/frame_clock.hpp"
#include "gui/app/mesh_level.hpp"
#include "gui/app/png.hpp"
#include "gui/app/pose_predictor.hpp"
#include "gui/app/region_checks.hpp"
#include "gui/app/window.hpp"
#include "gui/render/scene_view.hpp"
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

constexpr std::size_t kEventsKept = 100;
constexpr std::size_t kEventsPerFrame = 64;
// Atoms or bonds drawn as impostors where the processor draws: more take longer than a picture may
// (tests/bench/draw_bench.cpp).
constexpr std::size_t kShapesMaxInSoftware = 8000;

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
            const bool picture_waits = !options_.screenshot.empty() && loading_.valid();
            last = stop_signal != 0 || window_.close_wanted() ||
                   (options_.seconds > 0.0 && to_s(now - begun) >= options_.seconds && !picture_waits);
            frame(now, last && !options_.screenshot.empty());
            if (!last) clock_.pace(fps_max_);
        }
        if (stop_signal != 0) spdlog::info("ended by signal {}", static_cast<int>(stop_signal));
        return picture_failed_ ? 1 : 0;
    }

private:
    void frame(Instant now, bool take_picture) {
        clock_.begin();
        window_.begin_frame(theme_);
        const std::int64_t now_ns = to_ns(now);
        state_.now_ns = now_ns;
        state_.history.now_s = 1e-9 * static_cast<double>(now_ns - first_ns_);
        follow_controller(now_ns);
        follow_scene();
        handle_input();
        obey_level();
        clock_.end_part(FramePart::adapt);
        if (view_) view_->upload();
        clock_.end_part(FramePart::upload);
        draw_scene(now_ns);
        clock_.end_part(FramePart::scene);
        draw_panels();
        clock_.end_part(FramePart::panels);
        if (take_picture) save_picture(options_.screenshot);
        if (picture_wanted_) save_picture(picture_name());
        window_.show();
        clock_.end_part(FramePart::swap);
        publish_load();
    }

    void follow_controller(std::int64_t now_ns) {
        const Controller::News news = controller_.poll();
        if (news.left) {
            spdlog::warn("the controller of session {} is gone; waiting for the next", options_.session);
            commands_.forget();
        }
        if (news.arrived) {
            spdlog::info("attached to the controller of session {}", options_.session);
            for (PosePredictor& p : predictors_) p.clear();
            commands_.forget();
            std::string path = controller_.scene_path();
            if (options_.scene.empty() && !path.empty() &&
                (!content_ || content_->checksum != controller_.scene_checksum()))
                start_loading(path);
        }
        const Controller::Fresh fresh = controller_.read();
        if (fresh.bodies) {
            for (std::uint32_t i = 0; i < controller_.bodies.count; ++i) {
                const BodyPlace& b = controller_.bodies.body[i];
                Quat q(b.quat_model_body_xyzw[3], b.quat_model_body_xyzw[0], b.quat_model_body_xyzw[1],
                       b.quat_model_body_xyzw[2]);
                predictors_[i].add(
                    controller_.bodies.taken_at_ns,
                    {Vec3(b.pos_model_m[0], b.pos_model_m[1], b.pos_model_m[2]), q.normalized()});
            }
        }
        if (fresh.health) add_health(controller_.health);
        if (controller_.have_health) commands_.update(controller_.health, now_ns);
        EventTopic event;
        for (std::size_t i = 0; i < kEventsPerFrame && controller_.next_event(event); ++i) {
            EventLine line = describe(event);
            // What repeats, such as a limit that is reached again and again, must not push the rest out.
            if (!state_.events.empty() && state_.events.front().code == line.code &&
                line.grade == Grade::watch) {
                line.count = state_.events.front().count + 1;
                state_.events.front() = std::move(line);
                continue;
            }
            state_.events.push_front(std::move(line));
            if (state_.events.size() > kEventsKept) state_.events.pop_back();
        }
        state_.attached = controller_.attached();
        state_.link_text = controller_.status_text();
        state_.have_health = controller_.have_health;
        state_.have_levels = controller_.have_levels;
        state_.health = controller_.health;
        state_.levels = controller_.levels;
        state_.refused_records = controller_.refused();
        state_.events_missed = controller_.events_missed();
        state_.command_text = commands_.text();
        using Stage = CommandSender::Stage;
        state_.command_grade = commands_.stage() == Stage::done   ? Grade::good
                               : commands_.stage() == Stage::sent ? Grade::unknown
                                                                  : Grade::watch;
    }

    void add_health(const HealthTopic& h) {
        History& to = state_.history;
        to.rate_hz.add(to.now_s, h.force_rate_hz);
        to.lateness_p50_s.add(to.now_s, 1e-9 * static_cast<double>(h.lateness_p50_ns));
        to.lateness_p99_s.add(to.now_s, 1e-9 * static_cast<double>(h.lateness_p99_ns));
        to.lateness_max_s.add(to.now_s, 1e-9 * static_cast<double>(h.lateness_max_ns));
        to.cycle_cost_s.add(to.now_s, 1e-9 * static_cast<double>(h.cycle_cost_p50_ns));
    }

    void start_loading(const std::string& path) {
        if (loading_.valid()) return;  // the newest is asked for again when this one is done
        state_.scene.status = "Loading " + path + " ...";
        loading_ = std::async(std::launch::async, [path] { return load_scene(path); });
        loading_path_ = path;
    }

    void follow_scene() {
        if (loading_.valid() && loading_.wait_for(std::chrono::seconds(0)) == std::future_status::ready) {
            try {
                content_ = loading_.get();
                use_scene();
            } catch (const StartupError& e) {
                spdlog::error("{}", e.what());
                const SceneFacts before = state_.scene;
                state_.scene = content_ ? before : SceneFacts{};
                state_.scene.status = e.what();
            }
        }
        if (!content_ || !controller_.attached()) {
            state_.scene.warning.clear();
            return;
        }
        const std::uint64_t running = controller_.scene_checksum();
        state_.scene.warning = running != 0 && running != content_->checksum && !loading_.valid()
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
        view_->molecules().set_look(options_.look);
        if (window_.software()) view_->molecules().set_shapes_max(kShapesMaxInSoftware);
        camera_.frame(view_->radius_a());
        fit_.reset();
        outcome_ = FitOutcome{};
        state_.fit = FitFacts{};
        if (content_->grid.count() == 0 || content_->grid.values.empty() || content_->bodies.empty())
            state_.fit.status = "The scene has no map or no structure to compare.";
        else
            fit_ = std::make_unique<FitWorker>(content_);
        state_.scene = describe(*content_);
        window_.set_title(std::string("Tact: ") + state_.scene.title);
        spdlog::info("showing {}: {} vertices, {} bodies, {} atoms", content_->path.string(),
                     view_->vertices_max(), state_.scene.bodies, state_.scene.atoms);
    }

    void handle_input() {
        const ImGuiIO& io = ImGui::GetIO();
        if (!io.WantCaptureMouse) {
            const float height = layout_for(theme_, io.DisplaySize.x, io.DisplaySize.y).view.height;
            if (io.MouseDown[0]) camera_.rotate(io.MouseDelta.x, io.MouseDelta.y, height);
            if (io.MouseDown[1]) camera_.pan(io.MouseDelta.x, io.MouseDelta.y, height);
            if (io.MouseWheel != 0.0F && !io.KeyAlt && !io.KeyCtrl && !io.KeyShift)
                camera_.zoom(io.MouseWheel);
        }
        for (const Key key : window_.take_keys()) {
            if (io.WantTextInput) continue;
            if (key == Key::home) camera_.home();
            if (key == Key::style) state_.toggles.style = (state_.toggles.style + 1) % 3;
            if (key == Key::picture) picture_wanted_ = true;
            if (key == Key::help) state_.show_keys = !state_.show_keys;
            if (key == Key::escape) state_.show_keys = false;
        }
    }

    void obey_level() {
        if (!view_) return;
        const PathLevel* const path = controller_.attached() && controller_.have_levels
                                          ? find_path(controller_.levels, kMeshPath)
                                          : nullptr;
        // Without a controller the surface stays as it was last told; at first that is all of it.
        const std::uint32_t most = view_->vertices_max();
        if (path != nullptr && most > 0)
            vertices_share_ = vertices_for(*path, view_->vertices_min(), most) / static_cast<double>(most);
        view_->approach_vertices(static_cast<std::uint32_t>(std::lround(vertices_share_ * most)),
                                 adapt_budget_s(clock_.frame_s()));
        state_.scene.mesh_error_m = view_->error_m();
    }

    std::size_t body_count() const { return std::min(content_->bodies.size(), kBodiesMax); }

    void place_bodies(std::int64_t now_ns) {
        places_.clear();
        state_.fit.pose_known = false;
        for (std::size_t i = 0; i < body_count(); ++i) {
            const bool live =
                controller_.have_bodies && i < controller_.bodies.count && predictors_[i].known();
            places_.push_back(live ? predictors_[i].at(now_ns) : content_->bodies[i].home());
        }
        const std::size_t active = active_body();
        if (active < places_.size() && controller_.have_bodies) {
            state_.fit.pose_known = true;
            state_.fit.from_file_m = (places_[active].p_m - content_->bodies[active].home_com_model_m).norm();
            state_.fit.from_file_rad = rotation_vector_rad(places_[active].q).norm();
        }
    }

    void follow_fit() {
        if (!fit_) return;
        fit_->wish(places_);
        if (!fit_->take(outcome_)) return;
        FitFacts& f = state_.fit;
        f.known = outcome_.good;
        f.status = outcome_.error;
        f.cc_zero = outcome_.metrics.cc_zero;
        f.cc_mean = outcome_.metrics.cc_mean;
        f.mean_density_sigma = outcome_.metrics.mean_density_sigma;
        f.fraction_inside = outcome_.metrics.fraction_inside;
        f.region_voxels = outcome_.metrics.region_voxels;
        f.resolution_m = outcome_.resolution_m;
        f.resolution_assumed = outcome_.resolution_assumed;
        f.region = kFitRegion;
    }

    std::size_t active_body() const { return controller_.have_bodies ? controller_.bodies.active : 0; }

    void draw_scene(std::int64_t now_ns) {
        const Window::Size size = window_.size();
        const Layout layout =
            layout_for(theme_, static_cast<float>(size.width), static_cast<float>(size.height));
        const PixelRect& rect = layout.view;
        const float to_px = static_cast<float>(size.width_px) / static_cast<float>(std::max(size.width, 1));
        ViewFrame view{};
        view.x_px = static_cast<int>(rect.x * to_px);
        view.width_px = std::max(size.width_px - view.x_px, 1);
        view.height_px = std::max(static_cast<int>(rect.height * to_px), 1);
        view.y_px = size.height_px - view.height_px;
        paint_grounds(layout, to_px, size.height_px);
        glViewport(view.x_px, view.y_px, view.width_px, view.height_px);
        if (!programs_) programs_ = std::make_unique<Programs>();
        if (view_options_.gradient) programs_->draw_background();
        state_.a_per_px = static_cast<double>(camera_.a_per_px(rect.height));
        const Eigen::Matrix3f axes = camera_.orientation().toRotationMatrix();
        for (int i = 0; i < 3; ++i)
            for (int k = 0; k < 3; ++k) state_.eye_axes[i][k] = axes(k, i);
        if (!view_) return;
        place_bodies(now_ns);
        follow_fit();
        drawn_.clear();
        for (std::size_t i = 0; i < places_.size(); ++i) {
            const bool live = controller_.have_bodies && i < controller_.bodies.count;
            const auto number = static_cast<std::uint32_t>(i);
            drawn_.push_back({places_[i], live ? controller_.bodies.body[i].structure : number,
                              live ? controller_.bodies.body[i].id : number + 1});
        }
        view.bodies = drawn_;
        view.active = active_body();
        const PathLevel* const force =
            controller_.have_levels ? find_path(controller_.levels, kDockingPath) : nullptr;
        view.points_felt = force != nullptr ? force->items : 0;
        if (controller_.attached() && controller_.have_tool) {
            const double* const f = controller_.tool.force_model_n;
            view.force_world_n = Vec3(f[0], f[1], f[2]);
        }
        state_.force_n = view.force_world_n.norm();
        state_.arrow_a_per_n = static_cast<double>(view_->arrow_a_per_n());
        const SceneToggles& t = state_.toggles;
        view_options_.surface = t.surface;
        view_options_.backbone = t.backbone;
        view_options_.codebook = t.codebook;
        view_options_.graph = t.graph;
        view_options_.force = t.force;
        view_options_.box = t.box;
        view_options_.style = static_cast<SurfaceStyle>(t.style);
        view_->draw(camera_, view_options_, view);
        if (const std::size_t left_out = view_->molecules().left_out(); left_out != left_out_) {
            left_out_ = left_out;
            if (left_out > 0)
                spdlog::info("bodies drawn as tubes, as this renderer has no time for their atoms: {}",
                             left_out);
        }
    }

    void paint_grounds(const Layout& layout, float to_px, int height_px) {
        glDisable(GL_SCISSOR_TEST);
        const auto clear = [](ImU32 c, GLbitfield what) {
            const ImVec4 v = ImGui::ColorConvertU32ToFloat4(c);
            glClearColor(v.x, v.y, v.z, 1.0F);
            glClear(what);
        };
        clear(colour::kGround, GL_COLOR_BUFFER_BIT | GL_DEPTH_BUFFER_BIT);
        glEnable(GL_SCISSOR_TEST);
        for (const PixelRect& card : layout.cards()) {
            const auto px = [to_px](float v) { return static_cast<int>(std::lround(v * to_px)); };
            glScissor(px(card.x), height_px - px(card.y + card.height), px(card.width), px(card.height));
            clear(colour::kPanel, GL_COLOR_BUFFER_BIT);
        }
        glDisable(GL_SCISSOR_TEST);
    }

    void draw_panels() {
        const ImGuiIO& io = ImGui::GetIO();
        draw_dashboard(theme_, state_, io.DisplaySize.x, io.DisplaySize.y);
        window_.draw_panels();
        for (const Wish& wish : state_.wishes)
            if (!commands_.send(wish.kind, wish.value, wish.text, state_.now_ns))
                spdlog::warn("a command with a text too long was not sent");
        state_.wishes.clear();
    }

    void save_picture(const std::string& path) {
        picture_wanted_ = false;
        try {
            write_png(path, window_.picture());
            spdlog::info("wrote {}", path);
        } catch (const StartupError& e) {
            spdlog::error("{}", e.what());
            picture_failed_ = true;
        }
    }

    std::string picture_name() const {
        const auto seconds = std::chrono::duration_cast<std::chrono::milliseconds>(
            std::chrono::system_clock::now().time_since_epoch());
        return "tact-" + std::to_string(seconds.count()) + ".png";
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
        region_->load.publish(load);
        state_.load = load;
        History& to = state_.history;
        to.frame_s.add(to.now_s, load.frame_s);
        to.busy_s.add(to.now_s, load.busy_s);
        if (controller_.have_levels && controller_.attached())
            for (std::uint32_t i = 0; i < controller_.levels.count; ++i)
                to.level[i].add(to.now_s, static_cast<double>(controller_.levels.path[i].level));
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
    std::unique_ptr<Programs> programs_;
    std::shared_ptr<const SceneContent> content_;
    std::unique_ptr<SceneView> view_;
    double vertices_share_ = 1.0;  // of what all surfaces have; stays as the controller last told
    std::unique_ptr<FitWorker> fit_;
    FitOutcome outcome_;
    ViewOptions view_options_;
    Camera camera_;
    PosePredictor predictors_[kBodiesMax];
    std::vector<Pose> places_;
    std::vector<DrawnBody> drawn_;
    std::size_t left_out_ = 0;
    std::future<std::shared_ptr<const SceneContent>> loading_;
    std::string loading_path_;
    bool picture_wanted_ = false, picture_failed_ = false;
};

}  // namespace

int run_gui(const GuiOptions& options) {
    catch_signals();
    return App(options).run();
}

}  // namespace tact
