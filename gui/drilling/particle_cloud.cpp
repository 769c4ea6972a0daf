// Screen-space fluids (van der Laan, Green, Sainz, "Screen space fluid rendering with curvature flow", I3D 2009), in
// one pass over the particles instead of three. Each particle adds a soft disc larger than its cell to four sums:
// thickness, thickness of water, thickness of blood, and distance weighted by thickness; the rest is paste. Fluid is
// where the thickness exceeds a threshold: overlapping discs merge into one body, single ones are drops. Mean
// distance and thickness give the normal, Beer's law gives the opacity. Particles behind the scene add nothing, so no
// depth is stored.
#include "gui/drilling/particle_cloud.hpp"

#include <algorithm>
#include <cmath>

namespace tact {
namespace {

// In cells. Grains of adjacent cells overlap, or bone would shine through their piles; discs of fluid cover the
// adjacent cells.
constexpr float kGrainRadius = 0.58F, kDiscRadius = 1.7F;
// Discs of fluid are accumulated at a radius of about three pixels: more costs time and shows no more.
constexpr float kDiscPx = 3.0F;
constexpr int kFinest = 2, kCoarsestPixel = 8;

constexpr char kGrainVertex[] = R"(
layout(location = 0) in vec3 at;
layout(location = 1) in vec4 look;  // matter, shade, size (kDotSize), 0
uniform vec2 u_size;  // radius of a grain; pixels per length at distance 1
flat out vec3 v_colour;
flat out vec4 v_ground;  // background colour, fraction of haze
void main() {
    vec4 p = u_eye * vec4(at, 1.0);
    v_colour = mix(vec3(0.84, 0.79, 0.68), vec3(1.0, 0.97, 0.90), look.y / 255.0);
    // The depth test uses its front, not its centre.
    float radius = u_size.x * look.z / 32.0;
    gl_Position = u_projection * vec4(p.xy, p.z + 0.7 * radius, 1.0);
    if (-p.z < u_cut) gl_Position = vec4(2.0, 2.0, 2.0, 1.0);
    gl_PointSize = clamp(2.0 * radius * u_size.y / max(-p.z, 1e-3), 1.5, 64.0);
    v_ground = vec4(mix(u_ground_bottom, u_ground_top, 0.5 + 0.5 * gl_Position.y / gl_Position.w),
                    haze_at(-p.z));
}
)";
constexpr char kGrainFragment[] = R"(
flat in vec3 v_colour;
flat in vec4 v_ground;
out vec4 colour;
void main() {
    vec2 d = 2.0 * gl_PointCoord - 1.0;
    float r2 = dot(d, d);
    if (r2 > 1.0) discard;
    // Flatter than a ball: many together look like powder, not pearls.
    vec4 c = lit(v_colour, normalize(vec3(0.6 * d.x, -0.6 * d.y, 0.45 + sqrt(1.0 - r2))), vec3(0.0, 0.0, 1.0));
    colour = vec4(mix(c.rgb - vec3(0.2 * c.a), v_ground.rgb, v_ground.a), 1.0);
}
)";

constexpr char kSumVertex[] = R"(
layout(location = 0) in vec3 at;
layout(location = 1) in vec4 look;
uniform vec2 u_size;  // radius of a disc; pixels per length at distance 1
out vec3 v_adds;
void main() {
    vec4 p = u_eye * vec4(at, 1.0);
    gl_Position = -p.z < u_cut ? vec4(2.0, 2.0, 2.0, 1.0)
                               : u_projection * vec4(p.xy, p.z + 0.5 * u_size.x, 1.0);
    gl_PointSize = clamp(2.0 * u_size.x * u_size.y / max(-p.z, 1e-3), 2.0, 64.0);
    v_adds = vec3(look.x == 1.0 ? 1.0 : 0.0, look.x == 2.0 ? 1.0 : 0.0, -p.z);
}
)";
constexpr char kSumFragment[] = R"(#version 330 core
in vec3 v_adds;
uniform sampler2D u_scene;
uniform int u_coarser;
out vec4 sums;
void main() {
    vec2 d = 2.0 * gl_PointCoord - 1.0;
    float k = 1.0 - dot(d, d);
    if (k <= 0.0) discard;
    if (gl_FragCoord.z > texelFetch(u_scene, ivec2(gl_FragCoord.xy) * u_coarser, 0).r) discard;
    k *= k;
    sums = k * vec4(v_adds.xy, v_adds.z, 1.0);
}
)";

constexpr char kSurfaceVertex[] = R"(
void main() {
    gl_Position = vec4(gl_VertexID == 1 ? 3.0 : -1.0, gl_VertexID == 2 ? 3.0 : -1.0, 0.0, 1.0);
}
)";
constexpr char kSurfaceFragment[] = R"(
uniform sampler2D u_sums;
uniform sampler2D u_scene;
uniform vec4 u_view;   // lower left corner, 1 / size of the sums in pixels of the frame
uniform vec3 u_place;  // radius of a disc; size of a pixel at distance 1; edge of a sum's pixel in pixels
out vec4 colour;
// Tent filter, three by three: without it the coarser pixels are visible.
vec4 smooth_sums(vec2 uv, vec2 step) {
    vec4 s = 4.0 * texture(u_sums, uv);
    s += 2.0 * (texture(u_sums, uv + vec2(step.x, 0.0)) + texture(u_sums, uv - vec2(step.x, 0.0)) +
                texture(u_sums, uv + vec2(0.0, step.y)) + texture(u_sums, uv - vec2(0.0, step.y)));
    return s / 12.0;
}
float step_of(vec4 s) { return smoothstep(0.02, 0.2, s.w); }
// Height of the surface: minus the mean distance, plus half of the thickness.
float height(vec4 s) { return s.w > 1e-4 ? 0.45 * u_place.x * sqrt(s.w) - s.z / s.w : 0.0; }
void main() {
    vec2 at = gl_FragCoord.xy - u_view.xy;
    vec2 uv = at * u_view.zw, step = u_place.z * u_view.zw;
    vec4 s = smooth_sums(uv, step);
    float there = smoothstep(0.10, 0.42, s.w);
    if (there <= 0.0) discard;
    float mean = s.z / s.w;
    // Coarse sums extend beyond depth edges of the scene: they must not cover nearer content.
    float scene = 2.0 * texelFetch(u_scene, ivec2(at), 0).r - 1.0;
    float scene_a = u_projection[3][2] / (scene + u_projection[2][2]);
    there *= smoothstep(-1.6, -0.8, (scene_a - mean) / u_place.x);
    vec4 sx0 = texture(u_sums, uv - vec2(step.x, 0.0)), sx1 = texture(u_sums, uv + vec2(step.x, 0.0));
    vec4 sy0 = texture(u_sums, uv - vec2(0.0, step.y)), sy1 = texture(u_sums, uv + vec2(0.0, step.y));
    float h = height(s), across = u_place.z * u_place.y * mean;
    // The step to another body behind is no slope.
    float most = 1.5 * u_place.x;
    vec2 slope = vec2(clamp(height(sx1) - h, -most, most) * step_of(sx1) -
                          clamp(height(sx0) - h, -most, most) * step_of(sx0),
                      clamp(height(sy1) - h, -most, most) * step_of(sy1) -
                          clamp(height(sy0) - h, -most, most) * step_of(sy0));
    vec2 tilt = -0.3 * slope / across;
    vec3 n = normalize(vec3(tilt * min(1.0, 1.3 / max(length(tilt), 1e-3)), 1.0));
    float water = s.x, blood = s.y, paste = max(s.w - s.x - s.y, 0.0);
    vec3 red = mix(vec3(0.62, 0.040, 0.030), vec3(0.30, 0.008, 0.012), 1.0 - exp(-0.30 * blood));
    vec3 mud = mix(vec3(0.90, 0.80, 0.70), vec3(0.82, 0.66, 0.57), 1.0 - exp(-0.5 * paste));
    vec3 base = (0.3 * water * vec3(0.74, 0.86, 0.93) + blood * red + paste * mud) /
                max(0.3 * water + blood + paste, 1e-4);
    float clear = exp(-1.3 * blood - 1.7 * paste);
    float hides = 1.0 - clear + 0.45 * (1.0 - exp(-0.06 * water)) * clear;
    // At its rim a drop refracts the background away.
    hides = max(hides, mix(0.08, 0.45, 1.0 - n.z) * water / s.w);
    vec4 c = lit(base, n, vec3(0.0, 0.0, 1.0));
    float shine = c.a * c.a * (1.0 - 0.75 * paste / s.w);
    // Light passes through water: no side of it is dark.
    vec3 seen = mix(c.rgb, max(c.rgb, 0.8 * base), water / s.w) + vec3(0.6 * shine - 0.15 * c.a * paste / s.w);
    // Wet: highlights are opaque.
    colour = hazed(vec4(seen, there * min(hides + 0.8 * shine, 1.0)), mean, 2.0 * at.y * u_view.w - 1.0);
}
)";

float px_at_1(const ParticleCloud::View& view) {
    return 0.5F * static_cast<float>(view.height_px) * view.projection(1, 1);
}

// Chosen by the size of a disc at the centre of the fluids.
int coarser_for(const ParticleCloud::View& view, const DotRanges& sent) {
    Eigen::Vector4f middle(0.0F, 0.0F, 0.0F, 1.0F);
    for (std::size_t i = 0; i < 3; ++i)
        middle[static_cast<Eigen::Index>(i)] = 0.5F * (sent.fluids_low[i] + sent.fluids_high[i]);
    const float away_a = -(view.eye_from_cells * middle).z();
    if (!(away_a > 0.0F)) return kCoarsestPixel;
    const float disc_px = kDiscRadius * view.cell_a * px_at_1(view) / away_a;
    return static_cast<int>(std::clamp(std::round(disc_px / kDiscPx), static_cast<float>(kFinest),
                                       static_cast<float>(kCoarsestPixel)));
}

}  // namespace

ParticleCloud::Program::Program(const char* what, const char* vertex, const char* fragment)
    : program(what, shader(vertex).c_str(), fragment), view(program), size(program.uniform("u_size")) {}

ParticleCloud::ParticleCloud()
    : grains_("grain", kGrainVertex, shader(kGrainFragment).c_str()),
      sums_("fluid", kSumVertex, kSumFragment),
      surface_("fluid surface", shader(kSurfaceVertex).c_str(), shader(kSurfaceFragment).c_str()),
      surface_view_(surface_) {
    sums_.program.use();
    glUniform1i(sums_.program.uniform("u_scene"), 0);
    surface_.use();
    glUniform1i(surface_.uniform("u_scene"), 0);
    glUniform1i(surface_.uniform("u_sums"), 1);
    glUseProgram(0);
}

void ParticleCloud::fill(std::span<const Particle> particles) {
    sent_ = build_dots(particles, dots_);
    glBindVertexArray(dots_array_.get());
    glBindBuffer(GL_ARRAY_BUFFER, dots_buffer_.get());
    glBufferData(GL_ARRAY_BUFFER, static_cast<GLsizeiptr>(dots_.size() * sizeof(ParticleDot)), dots_.data(),
                 GL_STREAM_DRAW);
    attribute(0, 3, GL_FLOAT, GL_FALSE, sizeof(ParticleDot), 0);
    attribute(1, 4, GL_UNSIGNED_BYTE, GL_FALSE, sizeof(ParticleDot), 12);
    glBindVertexArray(0);
}

void ParticleCloud::draw(const View& view) {
    glEnable(GL_PROGRAM_POINT_SIZE);
    if (sent_.grains > 0) draw_grains(view);
    if (sent_.fluids > 0) draw_fluids(view);
    glDisable(GL_PROGRAM_POINT_SIZE);
    glBindVertexArray(0);
    glUseProgram(0);
}

void ParticleCloud::draw_grains(const View& view) {
    glEnable(GL_DEPTH_TEST);
    glDisable(GL_BLEND);
    grains_.program.use();
    grains_.view.set(view.eye_from_cells, view.projection, view.haze);
    glUniform2f(grains_.size, kGrainRadius * view.cell_a, px_at_1(view));
    glBindVertexArray(dots_array_.get());
    glDrawArrays(GL_POINTS, 0, static_cast<GLsizei>(sent_.grains));
}

std::optional<ParticleCloud::Box> ParticleCloud::fluid_box(const View& view) const {
    Eigen::Array2f low(1.0F, 1.0F), high(-1.0F, -1.0F);
    for (std::size_t k = 0; k < 8; ++k) {
        Eigen::Vector4f corner(0.0F, 0.0F, 0.0F, 1.0F);
        for (std::size_t i = 0; i < 3; ++i)
            corner[static_cast<Eigen::Index>(i)] =
                (k >> i & 1U) != 0 ? sent_.fluids_high[i] + kDiscRadius : sent_.fluids_low[i] - kDiscRadius;
        const Eigen::Vector4f clip = view.projection * (view.eye_from_cells * corner);
        if (!(clip.w() > 0.0F))
            return Box{0, 0, view.width_px, view.height_px};  // a corner is behind the eye
        const Eigen::Array2f at = clip.head<2>().array() / clip.w();
        low = low.min(at);
        high = high.max(at);
    }
    low = low.max(-1.0F);
    high = high.min(1.0F);
    if (!(low < high).all()) return std::nullopt;
    const auto px = [](float v, int size) {
        return static_cast<int>(std::lround((0.5F + 0.5F * v) * static_cast<float>(size)));
    };
    constexpr int kAround = 2 * kCoarsestPixel;
    Box box;
    box.x = std::max(px(low.x(), view.width_px) - kAround, 0);
    box.y = std::max(px(low.y(), view.height_px) - kAround, 0);
    box.width = std::min(px(high.x(), view.width_px) + kAround, view.width_px) - box.x;
    box.height = std::min(px(high.y(), view.height_px) + kAround, view.height_px) - box.y;
    return box;
}

void ParticleCloud::draw_fluids(const View& view) {
    const auto box = fluid_box(view);
    if (!box) return;
    const int coarser = coarser_for(view, sent_);
    if (!target_ || !target_->fits(view.width_px, view.height_px, coarser))
        target_ = std::make_unique<FluidTarget>(view.width_px, view.height_px, coarser);
    GLint frame = 0;
    glGetIntegerv(GL_FRAMEBUFFER_BINDING, &frame);
    glDisable(GL_SCISSOR_TEST);
    target_->take_depth(view.x_px, view.y_px);

    target_->bind();
    glViewport(0, 0, target_->width_px(), target_->height_px());
    glEnable(GL_SCISSOR_TEST);
    glScissor(box->x / coarser, box->y / coarser, box->width / coarser + 2, box->height / coarser + 2);
    glClearColor(0.0F, 0.0F, 0.0F, 0.0F);
    glClear(GL_COLOR_BUFFER_BIT);
    glDisable(GL_DEPTH_TEST);
    glEnable(GL_BLEND);
    glBlendFunc(GL_ONE, GL_ONE);
    target_->bind_depth(GL_TEXTURE0);
    sums_.program.use();
    glUniform1i(sums_.program.uniform("u_coarser"), coarser);
    sums_.view.set(view.eye_from_cells, view.projection, view.haze);
    glUniform2f(sums_.size, kDiscRadius * view.cell_a, px_at_1(view) / static_cast<float>(coarser));
    glBindVertexArray(dots_array_.get());
    glDrawArrays(GL_POINTS, static_cast<GLint>(sent_.grains), static_cast<GLsizei>(sent_.fluids));

    glBindFramebuffer(GL_FRAMEBUFFER, static_cast<GLuint>(frame));
    glViewport(view.x_px, view.y_px, view.width_px, view.height_px);
    glScissor(view.x_px + box->x, view.y_px + box->y, box->width, box->height);
    glBlendFunc(GL_SRC_ALPHA, GL_ONE_MINUS_SRC_ALPHA);
    target_->bind_sums(GL_TEXTURE1);
    surface_.use();
    surface_view_.set(view.eye_from_cells, view.projection, view.haze);
    glUniform4f(surface_.uniform("u_view"), static_cast<float>(view.x_px), static_cast<float>(view.y_px),
                1.0F / static_cast<float>(target_->width_px() * coarser),
                1.0F / static_cast<float>(target_->height_px() * coarser));
    glUniform3f(surface_.uniform("u_place"), kDiscRadius * view.cell_a, 1.0F / px_at_1(view),
                static_cast<float>(coarser));
    glBindVertexArray(empty_.get());
    glDrawArrays(GL_TRIANGLES, 0, 3);

    glBindTexture(GL_TEXTURE_2D, 0);
    glActiveTexture(GL_TEXTURE0);
    glBindTexture(GL_TEXTURE_2D, 0);
    glDisable(GL_SCISSOR_TEST);
    glDisable(GL_BLEND);
    glEnable(GL_DEPTH_TEST);
}

}  // namespace tact
