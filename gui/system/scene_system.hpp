// One system of scenes (docking, surface, drilling) as the window runs it: what it draws, shows, does with
// keys and reports.
//
// The window has one of each for as long as it runs (gui/window/systems.hpp); the one whose scene is shown
// gets all calls but attach(), detach() and finish(), which all get.
// Frame    follow(), perform(), adapt(), move(), prepare(), the view is drawn, drawn(), ended(), add_to()
// Thread   frame thread, OpenGL context current, but for SceneStart, which is made on the loader thread
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>

#include "gui/dashboard/dashboard_state.hpp"
#include "gui/link/command_sender.hpp"
#include "gui/link/controller.hpp"
#include "gui/render/camera.hpp"
#include "gui/render/scene_content.hpp"
#include "gui/render/scene_view.hpp"
#include "gui/system/keys.hpp"
#include "gui/system/system_panels.hpp"

namespace tact {

// What a system makes of a scene before it is shown, as it takes longer than a frame. Each derives its own.
class SceneStart {
public:
    SceneStart() = default;
    virtual ~SceneStart() = default;
    SceneStart(const SceneStart&) = delete;
    SceneStart& operator=(const SceneStart&) = delete;
};

// What of the window a system uses and changes.
struct SystemContext {
    Controller& controller;
    CommandSender& commands;
    DashboardState& state;
    Camera& camera;
    bool software = false;  // the processor draws
};

class SceneSystem {
public:
    SceneSystem() = default;
    virtual ~SceneSystem() = default;
    SceneSystem(const SceneSystem&) = delete;
    SceneSystem& operator=(const SceneSystem&) = delete;

    [[nodiscard]] virtual SystemPanels& panels() = 0;

    // A scene of this system is shown from now on, in this view, which stays until close(). Throws
    // StartupError where it cannot be drawn; it is in use all the same.
    virtual void use(const std::shared_ptr<const SceneContent>& content, std::unique_ptr<SceneStart> start,
                     SceneView& view, const SystemContext& context) = 0;
    // Another scene is shown.
    virtual void close() = 0;
    virtual void describe(const SceneContent& content, SceneState& scene) const = 0;
    // What the home view shows about the centre, ångström; 0: all of the scene.
    [[nodiscard]] virtual float home_reach_a() const { return 0.0F; }

    // A controller came, or went.
    virtual void attach(const SystemContext& context) { static_cast<void>(context); }
    virtual void detach() {}
    // Records of the controller are new.
    virtual void read(const Controller::Fresh& fresh, const SystemContext& context) {
        static_cast<void>(fresh), static_cast<void>(context);
    }

    virtual void follow(const SystemContext& context) { static_cast<void>(context); }
    // False: the key means nothing to it. place: in the key's row (KeyFound).
    virtual bool perform(KeyAction what, std::size_t place, const SystemContext& context) {
        static_cast<void>(what), static_cast<void>(place), static_cast<void>(context);
        return false;
    }
    // Alt and the wheel.
    virtual void turn_wheel(double steps) { static_cast<void>(steps); }
    virtual void adapt() {}
    virtual void move(double frame_s, const Vec3& eye_model_m, const SystemContext& context) {
        static_cast<void>(frame_s), static_cast<void>(eye_model_m), static_cast<void>(context);
    }
    // Whether the window draws the second of two hands as a pen.
    [[nodiscard]] virtual bool second_hand_is_pen() const { return true; }
    // sharp: this frame is kept, so nothing is left out for time.
    virtual void prepare(std::int64_t now_ns, bool sharp, ViewFrame& frame, const SystemContext& context) = 0;
    virtual void drawn(const SystemContext& context) { static_cast<void>(context); }
    virtual void ended(double work_s) { static_cast<void>(work_s); }
    virtual void add_to(LoadTopic& load) const { static_cast<void>(load); }
    // The window closes. Throws StartupError where a report cannot be written.
    virtual void finish(const SystemContext& context) { static_cast<void>(context); }
};

}  // namespace tact
