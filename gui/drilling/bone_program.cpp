#include "gui/drilling/bone_program.hpp"

#include <Eigen/LU>

namespace tact {
namespace {

constexpr char kRayVertex[] = R"(
layout(location = 0) in vec2 corner;
uniform vec4 u_tan;  // xy: half view / distance; zw: centre / distance
uniform mat3 u_from_eye;
out vec3 v_ray;      // voxels
out float v_y;
void main() {
    v_ray = u_from_eye * vec3(corner * u_tan.xy + u_tan.zw, -1.0);
    v_y = corner.y;
    gl_Position = vec4(corner, 0.0, 1.0);
}
)";
constexpr char kRayFragment[] = R"(
uniform sampler3D u_bone;
uniform sampler3D u_free;
uniform sampler3D u_label;
uniform vec3 u_label_size;
uniform sampler2D u_palette;
uniform sampler3D u_wet;
uniform vec3 u_wet_size;   // voxels
uniform int u_slopes;
uniform float u_coaxial;  // 1: only the lamp of a microscope
uniform vec3 u_size;
uniform vec3 u_cells;
uniform vec3 u_origin;  // ray origin, voxels
uniform vec3 u_lamp;    // direction, voxels
uniform float u_step;
in vec3 v_ray;
in float v_y;
out vec4 colour;
uniform float u_surface;
float bone(vec3 p) { return texture(u_bone, (p + 0.5) / u_size).r; }
float label_at(vec3 p) {
    return floor(texelFetch(u_label, ivec3(clamp(floor(p + 0.5), vec3(0.0), u_label_size - 1.0)), 0).r * 255.0 + 0.5);
}
void main() {
    colour = vec4(0.0);
    gl_FragDepth = 1.0;
    vec3 d = normalize(v_ray);
    d = mix(d, vec3(1e-7), lessThan(abs(d), vec3(1e-7)));
    vec3 inv = 1.0 / d;
    vec3 a = (vec3(-0.5) - u_origin) * inv, b = (u_size - 0.5 - u_origin) * inv;
    vec3 near = min(a, b), far = max(a, b);
    float t = max(max(near.x, max(near.y, near.z)), 0.0);
    float end = min(far.x, min(far.y, far.z));
    if (t >= end) return;
    float plane = u_cut / max(-(mat3(u_eye) * d).z, 1e-9);
    if (u_cut > 0.0 && plane > t) {
        if (plane >= end) return;
        t = plane;
        vec3 p = u_origin + t * d;
        float dense = bone(p);
        if (dense >= u_surface) {
            float label = label_at(p);
            vec3 face = label > 0.5 ? texelFetch(u_palette, ivec2(int(label), 0), 0).rgb
                                    : mix(vec3(0.52, 0.30, 0.24), vec3(0.93, 0.89, 0.80), smoothstep(0.3, 0.95, dense));
            colour = hazed(vec4(0.92 * face, 1.0), u_cut, v_y);
            vec4 clip = u_projection * (u_eye * vec4(p, 1.0));
            gl_FragDepth = clamp(0.5 + 0.5 * clip.z / clip.w, 0.0, 0.99999);
            return;
        }
    }
    t += 1e-3;
    float leave = -1.0;
    bool hit = false;
    for (int i = 0; i < 1600; ++i) {
        vec3 p = u_origin + t * d;
        if (t > leave) {
            vec3 c = clamp(floor((p + 0.5) * 0.25), vec3(0.0), u_cells - 1.0);
            float k = floor(texelFetch(u_free, ivec3(c), 0).r * 255.0 + 0.5);
            float reach = max(k, 1.0) - 1.0;
            vec3 edge = (c + mix(vec3(-reach), vec3(1.0 + reach), greaterThan(d, vec3(0.0)))) * 4.0 - 0.5;
            vec3 out_at = (edge - u_origin) * inv;
            leave = max(min(out_at.x, min(out_at.y, out_at.z)), t);
            if (k > 0.5) {
                t = leave + 0.01;
                if (t > end) return;
                continue;
            }
        }
        if (bone(p) >= u_surface) {
            hit = true;
            break;
        }
        t += u_step;
        if (t > end) return;
    }
    if (!hit) return;
    float low = max(t - u_step, 0.0), high = t;
    for (int i = 0; i < 5; ++i) {
        float middle = 0.5 * (low + high);
        if (bone(u_origin + middle * d) >= u_surface) high = middle; else low = middle;
    }
    vec3 p = u_origin + high * d;

    // Gradient from a tetrahedron's corners, four samples instead of six; narrow for fine detail, and wide because the
    // steps between voxels would otherwise appear as terraces: of a segmented volume, wider still.
    vec2 e = vec2(1.0, -1.0);
    vec3 slope = vec3(0.0), fine = vec3(0.0);
    for (int i = 0; i < u_slopes; ++i) {
        float w = i == 0 ? 1.1 : i == 1 ? 2.3 : 4.5;
        slope += e.xyy * bone(p + w * e.xyy) + e.yyx * bone(p + w * e.yyx) + e.yxy * bone(p + w * e.yxy) +
                 e.xxx * bone(p + w * e.xxx);
        if (i == 0) fine = -slope;
    }
    vec3 n = -slope;
    float steep = dot(n, n);
    n = steep > 1e-8 ? n * inversesqrt(steep) : -d;
    if (dot(n, d) > 0.0) n = normalize(n - 1.02 * dot(n, d) * d);

    float open = 1.0 - clamp(0.45 * bone(p + 2.5 * n) + 0.35 * bone(p + 5.0 * n) + 0.25 * bone(p + 9.0 * n) +
                             0.2 * bone(p + 15.0 * n), 0.0, 0.8);
    float shade = 0.0;
    vec3 from = p + 1.5 * n;
    for (int i = 1; i <= 6; ++i) {
        float s = 0.9 * float(i) * float(i) + 0.5;
        shade = max(shade, (1.0 - s / 45.0) * smoothstep(0.15, 0.7, bone(from + s * u_lamp)));
    }

    float label = label_at(p - 0.8 * n);
    if (label < 0.5) label = label_at(p - 1.7 * n);
    float dense = bone(p - 2.2 * n);
    vec3 base;
    if (label > 0.5) {
        base = texelFetch(u_palette, ivec2(int(label), 0), 0).rgb;
    } else {
        base = mix(vec3(0.60, 0.27, 0.20), vec3(0.93, 0.855, 0.72), smoothstep(0.32, 0.85, dense));
    }
    vec3 at = (u_eye * vec4(p, 1.0)).xyz;
    vec3 n_eye = normalize(mat3(u_eye) * n);
    vec3 towards = normalize(-at);
    // Wet bone is darker, and blood stains it. What wets it lies in front of it.
    vec2 wet = 1.0625 * texture(u_wet, (p + 2.0 * n + 0.5) / u_wet_size).rg;
    base *= mix(vec3(1.0), vec3(0.80, 0.73, 0.68), wet.r);
    base = mix(base, vec3(0.42, 0.045, 0.035), 0.7 * wet.g);
    vec4 c = lit(base, n_eye, towards);
    // A microscope's lamp shines along the line of sight: as deep into a hole as the view.
    float facing = max(dot(n_eye, towards), 0.0);
    vec3 light = mix(c.rgb * (1.0 - 0.5 * shade) + 0.42 * base * facing, base * (0.06 + 1.12 * facing * sqrt(facing)), u_coaxial);
    light *= mix(vec3(0.46, 0.33, 0.30), vec3(1.0), open);
    if (wet.r > 0.02) {
        // A film of water follows the fine relief, so it glitters where the smoothed light does not.
        vec3 film = dot(fine, fine) > 1e-8 ? normalize(mat3(u_eye) * normalize(fine)) : n_eye;
        film = normalize(mix(n_eye, film, 0.6));
        float lamp = max(dot(film, normalize(vec3(0.352, 0.754, 0.553) + towards)), 0.0);
        float scope = max(dot(film, towards), 0.0);
        light += wet.r * open * (0.30 * (1.0 - shade) * (1.0 - u_coaxial) * pow(lamp, 70.0) +
                                 (0.22 + 0.3 * u_coaxial) * pow(scope, 110.0));
    }
    colour = hazed(vec4(light, 1.0), -at.z, v_y);
    vec4 clip = u_projection * vec4(at, 1.0);
    gl_FragDepth = clamp(0.5 + 0.5 * clip.z / clip.w, 0.0, 0.99999);
}
)";
constexpr char kShowVertex[] = R"(#version 330 core
layout(location = 0) in vec2 corner;
uniform vec2 u_share;
out vec2 v_at;
void main() {
    v_at = (0.5 + 0.5 * corner) * u_share;
    gl_Position = vec4(corner, 0.0, 1.0);
}
)";
constexpr char kShowFragment[] = R"(#version 330 core
uniform sampler2D u_colour;
uniform sampler2D u_depth;
in vec2 v_at;
out vec4 colour;
void main() {
    float depth = texture(u_depth, v_at).r;
    if (depth >= 1.0) discard;
    vec4 c = texture(u_colour, v_at);
    colour = vec4(c.rgb / max(c.a, 0.25), 1.0);
    gl_FragDepth = depth;
}
)";

}  // namespace

BoneProgram::BoneProgram()
    : program_("bone", shader(kRayVertex).c_str(), shader(kRayFragment).c_str()),
      view_(program_),
      size_(program_.uniform("u_size")),
      label_size_(program_.uniform("u_label_size")),
      cells_(program_.uniform("u_cells")),
      origin_(program_.uniform("u_origin")),
      from_eye_(program_.uniform("u_from_eye")),
      tan_(program_.uniform("u_tan")),
      step_(program_.uniform("u_step")),
      lamp_(program_.uniform("u_lamp")),
      wet_size_(program_.uniform("u_wet_size")),
      coaxial_(program_.uniform("u_coaxial")),
      slopes_(program_.uniform("u_slopes")) {
    program_.use();
    GLint unit = 0;
    for (const char* const name : {"u_bone", "u_free", "u_label", "u_wet", "u_palette"})
        glUniform1i(program_.uniform(name), unit++);
    glUniform1f(program_.uniform("u_surface"), static_cast<float>(BoneField::kSurface) / 255.0F);
}

void BoneProgram::use(BoneTextures& textures, const BoneField& field, const Eigen::Matrix4f& eye_from_voxels,
                      const Eigen::Matrix4f& projection, const Haze& haze, float step_voxels,
                      bool coaxial_light) {
    program_.use();
    view_.set(eye_from_voxels, projection, haze);
    const Eigen::Matrix4d inverse = eye_from_voxels.cast<double>().inverse();
    const Eigen::Vector3f origin = inverse.topRightCorner<3, 1>().cast<float>();
    // Length 1 in voxels for the central ray, so that all numbers are near 1.
    Eigen::Matrix3d from_eye = inverse.topLeftCorner<3, 3>();
    from_eye /= from_eye.col(2).norm();
    const Eigen::Matrix3f turned = from_eye.cast<float>();
    const Eigen::Vector3f lamp = (from_eye * Eigen::Vector3d(0.352, 0.754, 0.553)).normalized().cast<float>();
    const auto& size = field.bricks().size;
    const auto& cells = field.cells();
    glUniform3f(size_, static_cast<float>(size[0]), static_cast<float>(size[1]), static_cast<float>(size[2]));
    const auto& labels = textures.label_size();
    glUniform3f(label_size_, static_cast<float>(labels[0]), static_cast<float>(labels[1]),
                static_cast<float>(labels[2]));
    glUniform3f(cells_, static_cast<float>(cells[0]), static_cast<float>(cells[1]),
                static_cast<float>(cells[2]));
    glUniform3fv(origin_, 1, origin.data());
    glUniformMatrix3fv(from_eye_, 1, GL_FALSE, turned.data());
    glUniform4f(tan_, 1.0F / projection(0, 0), 1.0F / projection(1, 1), projection(0, 2) / projection(0, 0),
                projection(1, 2) / projection(1, 1));
    glUniform1f(step_, step_voxels);
    glUniform3fv(lamp_, 1, lamp.data());
    const Eigen::Array3f wet = textures.wet_size_voxels();
    glUniform3fv(wet_size_, 1, wet.data());
    glUniform1i(slopes_, field.smooth() ? 3 : 2);
    glUniform1f(coaxial_, coaxial_light ? 1.0F : 0.0F);
    textures.bind();
}

BoneOnScreen::BoneOnScreen()
    : program_("bone on screen", kShowVertex, kShowFragment), share_(program_.uniform("u_share")) {
    program_.use();
    glUniform1i(program_.uniform("u_colour"), 0);
    glUniform1i(program_.uniform("u_depth"), 1);
}

void BoneOnScreen::use(GLuint colour, GLuint depth, float share_x, float share_y, bool smooth) {
    program_.use();
    glUniform2f(share_, share_x, share_y);
    glActiveTexture(GL_TEXTURE1);
    glBindTexture(GL_TEXTURE_2D, depth);
    glActiveTexture(GL_TEXTURE0);
    glBindTexture(GL_TEXTURE_2D, colour);
    const GLint filter = smooth ? GL_LINEAR : GL_NEAREST;
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAG_FILTER, filter);
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, filter);
}

}  // namespace tact
