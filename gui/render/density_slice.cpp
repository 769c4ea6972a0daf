#include "gui/render/density_slice.hpp"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <vector>

namespace tact {
namespace {

constexpr std::uint32_t kAxisMax = 512;
constexpr std::size_t kVoxelsMax = std::size_t{1} << 27U;

constexpr char kSliceVertex[] = R"(
out vec3 v_at;  // eye space
out float v_y;
void main() {
    vec2 corner = vec2((gl_VertexID & 1) != 0 ? 1.0 : -1.0, (gl_VertexID & 2) != 0 ? 1.0 : -1.0);
    // A little behind the plane, so that the faces of cut atoms lie before it.
    float d = 1.0005 * u_cut;
    v_at = vec3((corner + vec2(u_projection[2][0], u_projection[2][1])) * d /
                vec2(u_projection[0][0], u_projection[1][1]), -d);
    v_y = corner.y;
    gl_Position = u_projection * vec4(v_at, 1.0);
}
)";
constexpr char kSliceFragment[] = R"(
uniform sampler3D u_map;
uniform mat4 u_map_from_eye;
uniform int u_count;
uniform float u_level[4];  // rising
uniform vec4 u_colour[4];
in vec3 v_at;
in float v_y;
out vec4 colour;
void main() {
    vec3 at = (u_map_from_eye * vec4(v_at, 1.0)).xyz;
    float d = texture(u_map, at).r, fine = fwidth(d);
    if (any(lessThan(at, vec3(0.0))) || any(greaterThan(at, vec3(1.0)))) discard;
    int k = -1;
    for (int i = 0; i < u_count; ++i)
        if (d >= u_level[i]) k = i;
    if (k < 0) discard;
    float above = d - u_level[k];
    float dense = sqrt(clamp(above / max(1.0 - u_level[k], 1e-4), 0.0, 1.0));
    float rim = 1.0 - smoothstep(0.0, 1.6, above / max(fine, 1e-6));
    vec3 c = u_colour[k].rgb * mix(0.55, 1.0, dense) * (1.0 - 0.5 * rim);
    colour = hazed(vec4(c, mix(u_colour[k].a, 1.0, 0.6 * rim)), -v_at.z, v_y);
}
)";

}  // namespace

DensitySlice::DensitySlice(const DensityGrid& grid)
    : program_("cut face", shader(kSliceVertex).c_str(), shader(kSliceFragment).c_str()),
      view_(program_),
      map_from_eye_(program_.uniform("u_map_from_eye")),
      count_(program_.uniform("u_count")),
      level_(program_.uniform("u_level")),
      colour_(program_.uniform("u_colour")) {
    const auto of_stride = [&](std::size_t axis) { return (grid.size[axis] + stride_ - 1) / stride_; };
    while (std::max({of_stride(0), of_stride(1), of_stride(2)}) > kAxisMax ||
           std::size_t{of_stride(0)} * of_stride(1) * of_stride(2) > kVoxelsMax)
        ++stride_;
    const auto [low, high] = std::minmax_element(grid.values.begin(), grid.values.end());
    low_ = static_cast<double>(*low);
    range_ = std::max(static_cast<double>(*high) - low_, 1e-30);
    const std::array<std::uint32_t, 3> size{of_stride(0), of_stride(1), of_stride(2)};
    std::vector<std::uint16_t> voxels;
    voxels.reserve(std::size_t{size[0]} * size[1] * size[2]);
    for (std::uint32_t z = 0; z < size[2]; ++z)
        for (std::uint32_t y = 0; y < size[1]; ++y)
            for (std::uint32_t x = 0; x < size[0]; ++x) {
                const double share =
                    (static_cast<double>(grid.at(x * stride_, y * stride_, z * stride_)) - low_) / range_;
                voxels.push_back(static_cast<std::uint16_t>(std::lround(65535.0 * share)));
            }
    glBindTexture(GL_TEXTURE_3D, map_.get());
    for (const GLenum filter : {GL_TEXTURE_MIN_FILTER, GL_TEXTURE_MAG_FILTER})
        glTexParameteri(GL_TEXTURE_3D, filter, GL_LINEAR);
    for (const GLenum wrap : {GL_TEXTURE_WRAP_S, GL_TEXTURE_WRAP_T, GL_TEXTURE_WRAP_R})
        glTexParameteri(GL_TEXTURE_3D, wrap, GL_CLAMP_TO_EDGE);
    glPixelStorei(GL_UNPACK_ALIGNMENT, 1);
    glTexImage3D(GL_TEXTURE_3D, 0, GL_R16, static_cast<GLsizei>(size[0]), static_cast<GLsizei>(size[1]),
                 static_cast<GLsizei>(size[2]), 0, GL_RED, GL_UNSIGNED_SHORT, voxels.data());
    glPixelStorei(GL_UNPACK_ALIGNMENT, 4);
    glBindTexture(GL_TEXTURE_3D, 0);
    for (Eigen::Index i = 0; i < 3; ++i) {
        const double per_m =
            1.0 / (grid.spacing_m[i] * stride_ * static_cast<double>(size[static_cast<std::size_t>(i)]));
        map_from_model_(i, i) = per_m;
        map_from_model_(i, 3) =
            0.5 / static_cast<double>(size[static_cast<std::size_t>(i)]) - per_m * grid.origin_m[i];
    }
}

void DensitySlice::draw(const Eigen::Matrix4f& eye_from_model, const Eigen::Matrix4f& projection,
                        const Haze& haze, std::span<const Level> levels) {
    std::vector<Level> rising(
        levels.begin(), levels.begin() + static_cast<std::ptrdiff_t>(std::min(levels.size(), kLevelsMax)));
    std::sort(rising.begin(), rising.end(), [](const Level& a, const Level& b) { return a.level < b.level; });
    if (rising.empty()) return;
    program_.use();
    view_.set(eye_from_model, projection, haze);
    const Eigen::Matrix4f from_eye =
        (map_from_model_ * eye_from_model.cast<double>().inverse()).cast<float>();
    glUniformMatrix4fv(map_from_eye_, 1, GL_FALSE, from_eye.data());
    glUniform1i(count_, static_cast<GLint>(rising.size()));
    std::array<float, kLevelsMax> share{};
    std::array<float, 4 * kLevelsMax> rgba{};
    for (std::size_t i = 0; i < rising.size(); ++i) {
        const Level& l = rising[i];
        share[i] = static_cast<float>((l.level - low_) / range_);
        for (std::size_t k = 0; k < 3; ++k) rgba[4 * i + k] = l.colour[static_cast<Eigen::Index>(k)];
        rgba[4 * i + 3] = l.opacity;
    }
    glUniform1fv(level_, static_cast<GLsizei>(rising.size()), share.data());
    glUniform4fv(colour_, static_cast<GLsizei>(rising.size()), rgba.data());
    glActiveTexture(GL_TEXTURE0);
    glBindTexture(GL_TEXTURE_3D, map_.get());
    glEnable(GL_BLEND);
    glBlendFunc(GL_SRC_ALPHA, GL_ONE_MINUS_SRC_ALPHA);
    glBindVertexArray(empty_.get());
    glDrawArrays(GL_TRIANGLE_STRIP, 0, 4);
    glBindVertexArray(0);
    glBindTexture(GL_TEXTURE_3D, 0);
    glDisable(GL_BLEND);
}

}  // namespace tact
