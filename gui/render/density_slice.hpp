// The face of a cut through a map: its density on the cutting plane, where it exceeds a contour; brighter where it is denser.
//
// Density   of the map as drawn, trilinear; maps of more than 512 voxels along an axis, or 2^27 in all, at every second or nth voxel
// Thread    frame thread, context current
#pragma once

#include <array>
#include <span>

#include "gui/render/gl.hpp"
#include "gui/render/shading.hpp"
#include "ipc/scene/density/density_map.hpp"

namespace tact {

class DensitySlice {
public:
    static constexpr std::size_t kLevelsMax = 4;
    struct Level {
        double level = 0.0;  // in the map's unit
        Eigen::Vector3f colour = Eigen::Vector3f::Ones();
        float opacity = 1.0F;
    };
    explicit DensitySlice(const DensityGrid& grid);
    // On the plane haze.cut_a. Blended, into the bound framebuffer; at most kLevelsMax levels, in any order. Of several that a density exceeds,
    // the highest counts.
    void draw(const Eigen::Matrix4f& eye_from_model, const Eigen::Matrix4f& projection, const Haze& haze,
              std::span<const Level> levels);
    [[nodiscard]] std::uint32_t stride() const { return stride_; }

private:
    GlProgram program_;
    ViewUniforms view_;
    GLint map_from_eye_, count_, level_, colour_;
    GlTexture map_;
    GlVertexArray empty_;
    Eigen::Matrix4d map_from_model_ =
        Eigen::Matrix4d::Identity();  // map: 0 to 1 along each axis of the texture
    double low_ = 0.0, range_ = 1.0;
    std::uint32_t stride_ = 1;
};

}  // namespace tact
