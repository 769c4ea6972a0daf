#include "gui/drilling/bone_program.hpp"

#include <Eigen/LU>

#include <string>
#include <vector>

#include "ipc/base/clock.hpp"
#include "ipc/base/error.hpp"

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

constexpr GLsizei kEdge = BoneBricks::kEdge;

void volume_texture(GLuint name, GLint filter, GLenum wrap, const std::array<std::uint32_t, 3>& size) {
    glBindTexture(GL_TEXTURE_3D, name);
    glTexParameteri(GL_TEXTURE_3D, GL_TEXTURE_MIN_FILTER, filter);
    glTexParameteri(GL_TEXTURE_3D, GL_TEXTURE_MAG_FILTER, filter);
    for (const GLenum axis : {GL_TEXTURE_WRAP_S, GL_TEXTURE_WRAP_T, GL_TEXTURE_WRAP_R})
        glTexParameteri(GL_TEXTURE_3D, axis, static_cast<GLint>(wrap));
    glTexImage3D(GL_TEXTURE_3D, 0, GL_R8, static_cast<GLsizei>(size[0]), static_cast<GLsizei>(size[1]),
                 static_cast<GLsizei>(size[2]), 0, GL_RED, GL_UNSIGNED_BYTE, nullptr);
}

// Assembles the bricks of one layer into a texture of the volume's size.
template <class Value>
void fill_slab(const BoneBricks& bricks, std::uint32_t bz, std::vector<std::uint8_t>& slab,
               const Value& value) {
    const auto n = bricks.bricks();
    const std::size_t wide = bricks.size[0], high = bricks.size[1];
    const std::uint32_t deep = std::min<std::uint32_t>(kEdge, bricks.size[2] - bz * kEdge);
    slab.resize(wide * high * kEdge);
    std::array<std::uint8_t, BoneBricks::kVoxels> voxels{};
    for (std::uint32_t by = 0; by < n[1]; ++by)
        for (std::uint32_t bx = 0; bx < n[0]; ++bx) {
            value((bz * n[1] + by) * n[0] + bx, voxels);
            const std::size_t row = std::min<std::size_t>(kEdge, wide - std::size_t{bx} * kEdge);
            for (std::uint32_t z = 0; z < deep; ++z)
                for (std::uint32_t y = 0; y < kEdge && by * kEdge + y < high; ++y)
                    std::copy_n(voxels.data() + (z * kEdge + y) * kEdge, row,
                                slab.data() + (z * high + by * kEdge + y) * wide + std::size_t{bx} * kEdge);
        }
    glTexSubImage3D(GL_TEXTURE_3D, 0, 0, 0, static_cast<GLint>(bz * kEdge), static_cast<GLsizei>(wide),
                    static_cast<GLsizei>(high), static_cast<GLsizei>(deep), GL_RED, GL_UNSIGNED_BYTE,
                    slab.data());
}

}  // namespace

BoneTextures::BoneTextures(const BoneField& field, std::span<const BoneStructure> structures)
    : label_size_(field.labelled() ? field.bricks().size : std::array<std::uint32_t, 3>{1, 1, 1}),
      unsent_(field.bricks().bricks()[2]) {
    std::vector<std::uint8_t> rgba(std::size_t{4} * 256, 255);
    for (std::size_t i = 0; i < std::min<std::size_t>(structures.size(), 255); ++i)
        std::copy(structures[i].rgba.begin(), structures[i].rgba.end(), rgba.begin() + 4 * (i + 1));
    glBindTexture(GL_TEXTURE_2D, palette_.get());
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, GL_NEAREST);
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAG_FILTER, GL_NEAREST);
    glTexImage2D(GL_TEXTURE_2D, 0, GL_RGBA8, 256, 1, 0, GL_RGBA, GL_UNSIGNED_BYTE, rgba.data());
}

void BoneTextures::make_next(const BoneField& field) {
    while (glGetError() != GL_NO_ERROR) {
    }
    const BoneBricks& bricks = field.bricks();
    glPixelStorei(GL_UNPACK_ALIGNMENT, 1);
    if (unmade_ == 3) {
        volume_texture(solid_.get(), GL_LINEAR, GL_CLAMP_TO_BORDER, bricks.size);
    } else if (unmade_ == 2) {
        volume_texture(label_.get(), GL_NEAREST, GL_CLAMP_TO_EDGE, label_size_);
        if (!field.labelled()) {  // one voxel stands for all
            const std::uint8_t none = 0;
            glTexSubImage3D(GL_TEXTURE_3D, 0, 0, 0, 0, 1, 1, 1, GL_RED, GL_UNSIGNED_BYTE, &none);
        }
    } else {
        const auto& cells = field.cells();
        volume_texture(cells_.get(), GL_NEAREST, GL_CLAMP_TO_EDGE, cells);
        // Empty with distance 1: rays cross them one by one and skip nothing that was sent.
        const std::vector<std::uint8_t> empty(std::size_t{cells[0]} * cells[1] * cells[2], std::uint8_t{1});
        glTexSubImage3D(GL_TEXTURE_3D, 0, 0, 0, 0, static_cast<GLsizei>(cells[0]),
                        static_cast<GLsizei>(cells[1]), static_cast<GLsizei>(cells[2]), GL_RED,
                        GL_UNSIGNED_BYTE, empty.data());
    }
    glPixelStorei(GL_UNPACK_ALIGNMENT, 4);
    if (const GLenum error = glGetError(); error != GL_NO_ERROR)
        throw StartupError("showing bone of " + std::to_string(bricks.size[0]) + " x " +
                               std::to_string(bricks.size[1]) + " x " + std::to_string(bricks.size[2]) +
                               " voxels",
                           "not enough graphics memory, error " + std::to_string(error),
                           "bake a part of it with --crop, or larger voxels with --voxel-mm");
    --unmade_;
}

void BoneTextures::fill(const BoneField& field, double seconds) {
    const Instant begin = Monotonic::now();
    const auto over = [&] { return to_s(Monotonic::now() - begin) >= seconds; };
    while (!made()) {
        make_next(field);
        if (over()) return;
    }
    const BoneBricks& bricks = field.bricks();
    glPixelStorei(GL_UNPACK_ALIGNMENT, 1);
    std::vector<std::uint8_t> slab;
    while (unsent_ > 0) {
        const std::uint32_t bz = --unsent_;
        glBindTexture(GL_TEXTURE_3D, solid_.get());
        fill_slab(bricks, bz, slab, [&](std::uint32_t b, std::span<std::uint8_t, BoneBricks::kVoxels> out) {
            field.solids(b, out);
        });
        if (field.labelled()) {
            glBindTexture(GL_TEXTURE_3D, label_.get());
            fill_slab(bricks, bz, slab,
                      [&](std::uint32_t b, std::span<std::uint8_t, BoneBricks::kVoxels> out) {
                          for (std::size_t i = 0; i < out.size(); ++i)
                              out[i] = field.label(std::size_t{b} * out.size() + i);
                      });
        }
        send_cells(field, bz, 1);
        if (over()) break;
    }
    glPixelStorei(GL_UNPACK_ALIGNMENT, 4);
}

float BoneTextures::filled(const BoneField& field) const {
    return 1.0F - static_cast<float>(unsent_) / static_cast<float>(field.bricks().bricks()[2]);
}

void BoneTextures::send(const BoneField& field, std::uint32_t brick) {
    const BoneBricks& bricks = field.bricks();
    const auto n = bricks.bricks();
    const std::array<std::uint32_t, 3> at{brick % n[0], brick / n[0] % n[1], brick / n[0] / n[1]};
    if (at[2] < unsent_) return;  // it will be sent later, in its current state
    std::array<std::uint8_t, BoneBricks::kVoxels> voxels{};
    field.solids(brick, voxels);
    std::array<GLint, 3> first{};
    std::array<GLsizei, 3> size{};
    for (std::size_t i = 0; i < 3; ++i) {
        first[i] = static_cast<GLint>(at[i] * BoneBricks::kEdge);
        size[i] = std::min(kEdge, static_cast<GLsizei>(bricks.size[i]) - first[i]);
    }
    glPixelStorei(GL_UNPACK_ALIGNMENT, 1);
    glPixelStorei(GL_UNPACK_ROW_LENGTH, kEdge);
    glPixelStorei(GL_UNPACK_IMAGE_HEIGHT, kEdge);
    glBindTexture(GL_TEXTURE_3D, solid_.get());
    glTexSubImage3D(GL_TEXTURE_3D, 0, first[0], first[1], first[2], size[0], size[1], size[2], GL_RED,
                    GL_UNSIGNED_BYTE, voxels.data());
    constexpr std::uint32_t kCells = BoneBricks::kEdge / BoneField::kCell;
    std::array<std::uint8_t, std::size_t{kCells} * kCells * kCells> cells{};
    const auto& wide = field.cells();
    for (std::uint32_t i = 0; i < cells.size(); ++i)
        cells[i] = field.free_cells()[(std::size_t{at[2] * kCells + i / kCells / kCells} * wide[1] +
                                       at[1] * kCells + i / kCells % kCells) *
                                          wide[0] +
                                      at[0] * kCells + i % kCells];
    glPixelStorei(GL_UNPACK_ROW_LENGTH, 0);
    glPixelStorei(GL_UNPACK_IMAGE_HEIGHT, 0);
    glBindTexture(GL_TEXTURE_3D, cells_.get());
    glTexSubImage3D(GL_TEXTURE_3D, 0, static_cast<GLint>(at[0] * kCells), static_cast<GLint>(at[1] * kCells),
                    static_cast<GLint>(at[2] * kCells), kCells, kCells, kCells, GL_RED, GL_UNSIGNED_BYTE,
                    cells.data());
    glPixelStorei(GL_UNPACK_ALIGNMENT, 4);
}

void BoneTextures::send_cells(const BoneField& field) {
    send_cells(field, unsent_, field.bricks().bricks()[2] - unsent_);
}

void BoneTextures::send_cells(const BoneField& field, std::uint32_t first, std::uint32_t count) {
    constexpr std::uint32_t kCells = BoneBricks::kEdge / BoneField::kCell;
    const auto& n = field.cells();
    glPixelStorei(GL_UNPACK_ALIGNMENT, 1);
    glBindTexture(GL_TEXTURE_3D, cells_.get());
    glTexSubImage3D(GL_TEXTURE_3D, 0, 0, 0, static_cast<GLint>(first * kCells), static_cast<GLsizei>(n[0]),
                    static_cast<GLsizei>(n[1]), static_cast<GLsizei>(count * kCells), GL_RED,
                    GL_UNSIGNED_BYTE, field.free_cells().data() + std::size_t{first} * kCells * n[0] * n[1]);
    glPixelStorei(GL_UNPACK_ALIGNMENT, 4);
}

void BoneTextures::send_wet(const WetBone& wet) {
    glPixelStorei(GL_UNPACK_ALIGNMENT, 1);
    glBindTexture(GL_TEXTURE_3D, wet_.get());
    const auto& n = wet.size();
    const auto width = static_cast<GLsizei>(n[0]), height = static_cast<GLsizei>(n[1]),
               depth = static_cast<GLsizei>(n[2]);
    if (wet_size_ != n) {
        wet_size_ = n;
        for (const GLenum filter : {GL_TEXTURE_MIN_FILTER, GL_TEXTURE_MAG_FILTER})
            glTexParameteri(GL_TEXTURE_3D, filter, GL_LINEAR);
        for (const GLenum axis : {GL_TEXTURE_WRAP_S, GL_TEXTURE_WRAP_T, GL_TEXTURE_WRAP_R})
            glTexParameteri(GL_TEXTURE_3D, axis, GL_CLAMP_TO_EDGE);
        glTexImage3D(GL_TEXTURE_3D, 0, GL_RG8, width, height, depth, 0, GL_RG, GL_UNSIGNED_BYTE,
                     wet.texels().data());
    } else {
        constexpr std::uint32_t kCells = BoneBricks::kEdge / WetBone::kCell;
        const std::uint32_t wide = n[0] / kCells, high = n[1] / kCells;
        glPixelStorei(GL_UNPACK_ROW_LENGTH, width);
        glPixelStorei(GL_UNPACK_IMAGE_HEIGHT, height);
        for (const std::uint32_t b : wet.changed()) {
            const std::uint32_t x = b % wide * kCells, y = b / wide % high * kCells,
                                z = b / wide / high * kCells;
            glTexSubImage3D(GL_TEXTURE_3D, 0, static_cast<GLint>(x), static_cast<GLint>(y),
                            static_cast<GLint>(z), kCells, kCells, kCells, GL_RG, GL_UNSIGNED_BYTE,
                            &wet.texels()[(std::size_t{z} * n[1] + y) * n[0] + x]);
        }
        glPixelStorei(GL_UNPACK_ROW_LENGTH, 0);
        glPixelStorei(GL_UNPACK_IMAGE_HEIGHT, 0);
    }
    glPixelStorei(GL_UNPACK_ALIGNMENT, 4);
}

void BoneTextures::bind() {
    GLenum unit = GL_TEXTURE0;
    for (GlTexture* const t : {&solid_, &cells_, &label_, &wet_}) {
        glActiveTexture(unit++);
        glBindTexture(GL_TEXTURE_3D, t->get());
    }
    glActiveTexture(unit);
    glBindTexture(GL_TEXTURE_2D, palette_.get());
    glActiveTexture(GL_TEXTURE0);
}

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
