// The mouse as a hand: turns the motion of the pointer into a pose at which the emulated hand is to be. So it does with the motion of a
// SpaceMouse or a gamepad.
//
// Take      begins at the tool's pose; what the pointer does from then on moves the target, not the tool: the hand follows on a spring
// Move      in the plane of the view at the target's depth, so the target stays under the pointer
// Wheel     away from the viewer and towards them;  turn: as the camera turns, about the tool;  fine: a fifth
// Steer     by a SpaceMouse or a gamepad, in the eye's axes: metres of the world and radians
// Bounded   to kReachM about the workspace's origin; the arm bounds it further
// Frames    pointer and view in the window's units, y down; poses in the world, SI; places in the model
// Thread    frame thread; plain arithmetic
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>

#include "gui/dashboard/pixel_rect.hpp"
#include "gui/render/eye_view.hpp"
#include "ipc/scene/file/scene_meta.hpp"
#include "ipc/topics/mouse.hpp"

namespace tact {

struct DragView {
    EyeView eye;
    Eigen::Quaternionf q_eye_scene = Eigen::Quaternionf::Identity();
    PixelRect view{};
    Vec3 centre_model_m = Vec3::Zero();  // of the scene frame
    const SceneMeta* meta = nullptr;     // not null
};

// A tool that the mouse may lead.
struct DragTool {
    bool may = false;
    Pose T_world_tool;
    Vec3 at_model_m = Vec3::Zero();  // where it is drawn
};

struct DragMotion {
    float dx = 0.0F, dy = 0.0F, wheel = 0.0F;
    bool turn = false, fine = false;
    bool drive = false, clutch = false;  // second and first button of the stylus
};

// How a tool is held.
enum class HeldBy : std::uint8_t { button, key, spacemouse, gamepad };

class ToolDrag {
public:
    static constexpr double kReachM = 0.45;
    static constexpr double kWheelM = 1.5e-3;  // a step, in the world
    static constexpr double kFine = 0.2;
    static constexpr float kRollRad = 0.09F;  // a step of the wheel while turning

    // Where a place is drawn, in the window's units; none: behind the eye.
    [[nodiscard]] static std::optional<Eigen::Vector2f> on_screen(const DragView& view, const Vec3& model_m);
    // The tool nearest to the pointer, within this distance.
    [[nodiscard]] static std::optional<std::size_t> tool_near(const DragView& view,
                                                              std::span<const DragTool> tools, float x,
                                                              float y, float within);

    // Except by a button of the mouse, it holds until let_go().
    void take(std::size_t hand, const DragTool& tool, const SceneMeta& meta, HeldBy by);
    void let_go() { holds_ = false; }
    void move(const DragView& view, const DragMotion& motion);
    // turn, move: of this frame, in the eye's axes; not finite: nothing moves. buttons: of the stylus.
    void steer(const DragView& view, const Vec3& move_eye_m, const Vec3& turn_eye_rad, std::uint32_t buttons);

    [[nodiscard]] bool holds() const { return holds_; }
    [[nodiscard]] bool held(HeldBy by) const { return holds_ && by_ == by; }
    [[nodiscard]] bool by_key() const { return held(HeldBy::key); }
    [[nodiscard]] bool by_pointer() const { return held(HeldBy::button) || held(HeldBy::key); }
    [[nodiscard]] LeadDevice device() const;
    [[nodiscard]] std::size_t hand() const { return hand_; }
    [[nodiscard]] const Pose& target() const { return target_; }
    [[nodiscard]] std::uint32_t buttons() const { return buttons_; }
    // Where the target is drawn: as far from the drawn tool as the target is from the hand.
    [[nodiscard]] Vec3 target_model_m(const SceneMeta& meta) const {
        return meta.to_model(target_.p_m) + drawn_off_m_;
    }
    // A record for the controller of this region; after let_go(): that it lets go.
    [[nodiscard]] MouseTopic record(std::uint64_t generation, std::int64_t now_ns) const;

private:
    void bound();

    bool holds_ = false;
    HeldBy by_ = HeldBy::button;
    std::size_t hand_ = 0;
    std::uint32_t buttons_ = 0;
    Pose target_;
    Vec3 drawn_off_m_ = Vec3::Zero();  // from the hand to the drawn tool, in the model
};

}  // namespace tact
