#include "gui/render/scene_frame.hpp"

#include "ipc/base/units.hpp"

namespace tact {

Eigen::Matrix4f scene_from_body(const Pose& T_model_body, const Vec3& centre_model_m) {
    Eigen::Matrix4f m = Eigen::Matrix4f::Identity();
    m.topLeftCorner<3, 3>() = T_model_body.q.toRotationMatrix().cast<float>();
    m.topRightCorner<3, 1>() = ((T_model_body.p_m - centre_model_m) / kAngstromM).cast<float>();
    return m;
}

Eigen::Matrix4f scene_from_model(const Vec3& centre_model_m) {
    Eigen::Matrix4f m = Eigen::Matrix4f::Zero();
    m.topLeftCorner<3, 3>() = kSceneAPerM * Eigen::Matrix3f::Identity();
    m.topRightCorner<3, 1>() = (-centre_model_m / kAngstromM).cast<float>();
    m(3, 3) = 1.0F;
    return m;
}

}  // namespace tact
