// Interface between the window and a system of scenes (docking, surface, drilling, field): rendering, panels, keys
// and reports.
//
// The window owns one of each for its lifetime (gui/window/systems.hpp). The system of the current scene receives
// all calls; attach(), detach() and finish() go to every system.
// Frame    follow(), perform(), adapt(), move(), prepare(), the view is drawn, drawn(), ended(), add_to()
// Thread   frame thread with its OpenGL context current; SceneStart is constructed on the loader thread
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>

#include "gui/dashboard/dashboard_state.hpp"
#include "gui/link/command_sender.hpp"
#include "gui/link/controller.hpp"
#include "gui/render/camera.hpp"
#include "gui/render/content_key.hpp"
#include "gui/render/scene_content.hpp"
#include "gui/render/scene_view.hpp"
#include "gui/system/keys.hpp"
#include "gui/system/system_panels.hpp"
#include "ipc/scene/session/session_file.hpp"

namespace tact {

// Data that a system prepares before its scene is shown, because this takes longer than a frame.
class SceneStart {
public:
    SceneStart() = default;
    virtual ~SceneStart() = default;
    SceneStart(const SceneStart&) = delete;
    SceneStart& operator=(const SceneStart&) = delete;
};

// The parts of the window that a system uses and changes.
struct SystemContext {
    Controller& controller;
    CommandSender& commands;
    DashboardState& state;
    Camera& camera;
    bool software = false;  // the CPU renders
    float text_px = 1.0F;   // pixels of the view for a pixel of the text's size at scale 1
};

// The line of sight through the pointer, in the model: a place on it is from_m + depth_m * way, where the depth is measured along the
// view axis.
struct Sight {
    Vec3 from_m = Vec3::Zero(), way = Vec3::UnitZ();
    double near_m = 0.0;    // depth from which on things are drawn
    double px_share = 0.0;  // a pixel of the view covers this times the depth
};

class SceneSystem {
public:
    SceneSystem() = default;
    virtual ~SceneSystem() = default;
    SceneSystem(const SceneSystem&) = delete;
    SceneSystem& operator=(const SceneSystem&) = delete;

    [[nodiscard]] virtual SystemPanels& panels() = 0;

    // Shows a scene of this system in this view, which stays valid until close(). Throws StartupError if the scene
    // cannot be drawn; the scene is in use all the same.
    virtual void use(const std::shared_ptr<const SceneContent>& content, std::unique_ptr<SceneStart> start,
                     SceneView& view, const SystemContext& context) = 0;
    // Another scene replaces this one.
    virtual void close() = 0;
    // Radius about the centre that the home view shows, ångström; 0: the whole scene.
    [[nodiscard]] virtual float home_reach_a() const { return 0.0F; }

    // A controller attached or detached.
    virtual void attach(const SystemContext& context) { static_cast<void>(context); }
    virtual void detach() {}
    // The controller published new records.
    virtual void read(const Controller::Fresh& fresh, const SystemContext& context) {
        static_cast<void>(fresh), static_cast<void>(context);
    }

    virtual void follow(const SystemContext& context) { static_cast<void>(context); }
    // Returns false if the key has no function here. place: index in the key's row (KeyFound).
    virtual bool perform(KeyAction what, std::size_t place, const SystemContext& context) {
        static_cast<void>(what), static_cast<void>(place), static_cast<void>(context);
        return false;
    }
    // Alt + wheel, and Ctrl + wheel: changes what is chosen, and chooses another.
    virtual void turn_wheel(double steps) { static_cast<void>(steps); }
    virtual void choose_by_wheel(double steps) { static_cast<void>(steps); }
    // The first place of the scene along a line of sight, model metres; none: nothing there, or it cannot be told.
    [[nodiscard]] virtual std::optional<Vec3> place_along(const Vec3& from_m, const Vec3& way) const {
        static_cast<void>(from_m), static_cast<void>(way);
        return std::nullopt;
    }
    // The person clicked on the view, without a drag.
    virtual void click(const Sight& sight, const SystemContext& context) {
        static_cast<void>(sight), static_cast<void>(context);
    }
    // Where the tool of a hand is drawn, model metres; none: where the hand is.
    [[nodiscard]] virtual std::optional<Vec3> tool_at(std::size_t hand, const SystemContext& context) const {
        static_cast<void>(hand), static_cast<void>(context);
        return std::nullopt;
    }
    virtual void adapt() {}
    virtual void move(double frame_s, const Vec3& eye_model_m, const SystemContext& context) {
        static_cast<void>(frame_s), static_cast<void>(eye_model_m), static_cast<void>(context);
    }
    // True if the window draws the second hand as a pen.
    [[nodiscard]] virtual bool second_hand_is_pen() const { return true; }
    // sharp: this frame is saved, so nothing is omitted to save time.
    virtual void prepare(std::int64_t now_ns, bool sharp, ViewFrame& frame, const SystemContext& context) = 0;
    // After prepare(): draws this frame in full detail, because the view rests.
    virtual void refine() {}
    // Adds what prepare() decided to draw, beside the frame. False: it changes all the time, or cannot be told.
    [[nodiscard]] virtual bool add_to_key(ContentKey& key) const {
        static_cast<void>(key);
        return false;
    }
    virtual void drawn(const SystemContext& context) { static_cast<void>(context); }
    virtual void ended(double work_s) { static_cast<void>(work_s); }
    virtual void add_to(LoadTopic& load) const { static_cast<void>(load); }
    // To and from a session of this scene; restore() after use().
    virtual void add_to(Session& session) const { static_cast<void>(session); }
    virtual void restore(const Session& session) { static_cast<void>(session); }
    // The window closes. Throws StartupError if a report cannot be written.
    virtual void finish(const SystemContext& context) { static_cast<void>(context); }
};

}  // namespace tact
