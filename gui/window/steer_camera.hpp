// Moves the camera as a SpaceMouse or a gamepad wants: the scene follows the cap, or the stick.
#pragma once

#include "gui/input/rate_control.hpp"
#include "gui/render/camera.hpp"

namespace tact {

// motion: of view_motion(), for one frame.
inline void steer(Camera& camera, const RateMotion& motion) {
    const Eigen::Vector3f move = motion.move.cast<float>();
    camera.turn(motion.turn_rad.cast<float>());
    camera.pan(move.x(), -move.y(), 1.0F);  // in heights of the view
    camera.zoom(move.z());
}

}  // namespace tact
