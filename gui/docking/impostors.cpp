// Bounds of a sphere in perspective: Mara, McGuire, "2D Polyhedral Bounds of a Clipped, Perspective-Projected 3D
// Sphere", JCGT 2013, axis-aligned case. The computation uses slopes, x / -z and y / -z, which include the
// perspective division. Rays start at their nearest point to the shape: single precision then resolves its radius
// even from far away, where the usual b^2 - ac has lost it (0.25 ångström at 1000).
#include "gui/docking/impostors.hpp"

#include <algorithm>

namespace tact {
namespace {

constexpr char kCommon[] = R"(
uniform int u_pick;    // 0 chain, 1 element, 2 body
uniform vec3 u_body;
uniform float u_grow;
vec3 picked(vec4 element, vec4 chain) { return u_pick == 2 ? u_body : u_pick == 1 ? element.rgb : chain.rgb; }
// At the shape's nearest point, but not in front of the near plane.
vec4 on_quad(vec2 slope, float nearest) {
    float near = u_projection[3][2] / (u_projection[2][2] - 1.0);
    float w = max(nearest, 1.0001 * near);
    return u_projection * vec4(slope * w, -w, 1.0);
}
vec2 corner() { return vec2((gl_VertexID & 1) != 0 ? 1.0 : -1.0, (gl_VertexID & 2) != 0 ? 1.0 : -1.0); }
// Greatest distance of a sphere's outline from its centre, as slopes.
float reach(vec3 c, float r) {
    float s = length(c.xy), d = c.z * c.z - r * r;
    return (s * -c.z + r * sqrt(s * s + d)) / d - s / -c.z;
}
const vec4 nowhere = vec4(2.0, 2.0, 2.0, 1.0);
)";

constexpr char kSphereVertex[] = R"(
layout(location = 0) in vec4 sphere;
layout(location = 1) in vec4 element;
layout(location = 2) in vec4 chain;
out vec2 v_slope;
flat out vec4 v_sphere;
flat out vec3 v_colour;
void main() {
    vec3 c = (u_eye * vec4(sphere.xyz, 1.0)).xyz;
    float r = u_grow * sphere.w, z = -c.z, d = z * z - r * r;
    v_colour = picked(element, chain);
    v_sphere = vec4(c, r);
    gl_ClipDistance[0] = 1.0;  // the fragments are cut
    if (z < 1.05 * r) { v_slope = vec2(0.0); gl_Position = nowhere; return; }
    v_slope = (c.xy * z + corner() * r * sqrt(c.xy * c.xy + d)) / d;
    gl_Position = on_quad(v_slope, z - r);
}
)";
constexpr char kSphereFragment[] = R"(
in vec2 v_slope;
flat in vec4 v_sphere;
flat in vec3 v_colour;
out vec4 colour;
void main() {
    vec3 ray = vec3(v_slope, -1.0);
    float length2 = dot(ray, ray);
    vec3 c = v_sphere.xyz;
    float nearest = dot(ray, c) / length2;
    vec3 off = nearest * ray - c;
    float h = v_sphere.w * v_sphere.w - dot(off, off);
    if (h < 0.0) discard;
    float back = sqrt(h / length2);
    vec3 n = (off - back * ray) / v_sphere.w;
    float depth = nearest - back;  // the ray's z is -1
    if (depth < u_cut) {
        if (nearest + back < u_cut) discard;
        face(v_colour, ray);
        return;
    }
    finish(v_colour, n, ray, length2, depth);
}
)";

constexpr char kStickVertex[] = R"(
layout(location = 0) in vec4 from;  // and radius
layout(location = 1) in vec3 to;
layout(location = 2) in vec4 element_from;
layout(location = 3) in vec4 chain_from;
layout(location = 4) in vec4 element_to;
layout(location = 5) in vec4 chain_to;
out vec2 v_slope;
flat out vec4 v_from;
flat out vec3 v_to;
flat out vec3 v_colour_from;
flat out vec3 v_colour_to;
void main() {
    vec3 a = (u_eye * vec4(from.xyz, 1.0)).xyz, b = (u_eye * vec4(to, 1.0)).xyz;
    float r = from.w;
    v_colour_from = picked(element_from, chain_from);
    v_colour_to = picked(element_to, chain_to);
    v_from = vec4(a, r);
    v_to = b;
    gl_ClipDistance[0] = 1.0;
    if (min(-a.z, -b.z) < 1.05 * r) { v_slope = vec2(0.0); gl_Position = nowhere; return; }
    vec2 sa = a.xy / -a.z, sb = b.xy / -b.z;
    float ra = reach(a, r), rb = reach(b, r);
    float l = length(sb - sa);
    vec2 u = l > 1e-7 ? (sb - sa) / l : vec2(1.0, 0.0);
    vec2 c = corner();
    v_slope = (c.x < 0.0 ? sa - ra * u : sb + rb * u) + c.y * max(ra, rb) * vec2(-u.y, u.x);
    gl_Position = on_quad(v_slope, min(-a.z, -b.z) - r);
}
)";
constexpr char kStickFragment[] = R"(
in vec2 v_slope;
flat in vec4 v_from;
flat in vec3 v_to;
flat in vec3 v_colour_from;
flat in vec3 v_colour_to;
out vec4 colour;
void main() {
    vec3 ray = vec3(v_slope, -1.0);
    float length2 = dot(ray, ray);
    float r2 = v_from.w * v_from.w;
    vec3 a = v_from.xyz, axis = v_to - a;
    float start = dot(ray, 0.5 * (a + v_to)) / length2;
    vec3 o = start * ray - a;
    float axis2 = dot(axis, axis);
    // Components of o and ray across the axis, times axis2.
    float along_ray = dot(axis, ray), along_o = dot(axis, o);
    float qa = axis2 * length2 - along_ray * along_ray;
    float qb = axis2 * dot(o, ray) - along_o * along_ray;
    float qc = axis2 * dot(o, o) - along_o * along_o - r2 * axis2;
    float h = qb * qb - qa * qc;
    float t = 0.0, y = -1.0;
    vec3 n = vec3(0.0, 0.0, 1.0);
    bool met = false;
    if (qa > 1e-6 * axis2 * length2) {
        if (h < 0.0) discard;
        t = (-qb - sqrt(h)) / qa;
        y = along_o + t * along_ray;
        met = y > 0.0 && y < axis2;
        n = (o + t * ray - axis * (y / axis2)) / v_from.w;
    } else {
        y = along_ray > 0.0 ? -1.0 : axis2 + 1.0;
    }
    if (!met) {  // a round end
        vec3 c = y <= 0.0 ? a : v_to;
        float nearest = dot(ray, c) / length2;
        vec3 off = nearest * ray - c;
        float e = r2 - dot(off, off);
        if (e < 0.0) discard;
        float back = sqrt(e / length2);
        n = (off - back * ray) / v_from.w;
        t = nearest - back - start;
    }
    if (start + t < u_cut) {
        vec3 q = u_cut * ray - a;
        float part = clamp(dot(q, axis) / max(axis2, 1e-12), 0.0, 1.0);
        vec3 beside = q - part * axis;
        if (dot(beside, beside) > r2) discard;
        face(part < 0.5 ? v_colour_from : v_colour_to, ray);
        return;
    }
    finish(y < 0.5 * axis2 ? v_colour_from : v_colour_to, n, ray, length2, start + t);
}
)";
constexpr char kFinish[] = R"(
void finish(vec3 base, vec3 n, vec3 ray, float length2, float depth) {
    vec4 clip = u_projection * vec4(depth * ray, 1.0);
    vec3 c = lit(base, n, -ray * inversesqrt(length2)).rgb;
    colour = hazed(vec4(c, 1.0), depth, clip.y / clip.w);
    gl_FragDepth = 0.5 + 0.5 * clip.z / clip.w;
}
// Of a cut: both shapes are convex, so a ray that enters one before the plane is inside of it there, or never again.
void face(vec3 base, vec3 ray) {
    vec4 clip = u_projection * vec4(u_cut * ray, 1.0);
    colour = hazed(vec4(0.72 * base, 1.0), u_cut, clip.y / clip.w);
    gl_FragDepth = 0.5 + 0.5 * clip.z / clip.w;
}
)";

// finish() and face() write to outputs that `text` declares before main(), so they stand between the two.
std::string fragment(const char* text) {
    std::string whole = shader(text);
    whole.insert(whole.find("void main()"), kFinish + 1);
    return whole;
}

constexpr GLsizei kOfSphere = sizeof(Sphere), kOfStick = sizeof(Stick);

void describe(const Sphere*) {
    attribute(0, 4, GL_FLOAT, GL_FALSE, kOfSphere, 0);
    attribute(1, 4, GL_UNSIGNED_BYTE, GL_TRUE, kOfSphere, 16);
    attribute(2, 4, GL_UNSIGNED_BYTE, GL_TRUE, kOfSphere, 20);
}

void describe(const Stick*) {
    attribute(0, 4, GL_FLOAT, GL_FALSE, kOfStick, 0);
    attribute(1, 3, GL_FLOAT, GL_FALSE, kOfStick, 16);
    for (GLuint i = 0; i < 4; ++i)
        attribute(2 + i, 4, GL_UNSIGNED_BYTE, GL_TRUE, kOfStick, 28 + std::size_t{4} * i);
}

}  // namespace

template <class Shape>
void ImpostorShapes::send(std::span<const Shape> shapes) {
    std::vector<Shape> corners;
    std::vector<std::uint32_t> index;
    corners.reserve(4 * shapes.size());
    index.reserve(6 * shapes.size());
    for (const Shape& shape : shapes) {
        const auto first = static_cast<std::uint32_t>(corners.size());
        corners.insert(corners.end(), 4, shape);
        for (const std::uint32_t k : {0U, 1U, 2U, 2U, 1U, 3U}) index.push_back(first + k);
    }
    glBindVertexArray(array_.get());
    glBindBuffer(GL_ARRAY_BUFFER, vertices_.get());
    glBufferData(GL_ARRAY_BUFFER, static_cast<GLsizeiptr>(corners.size() * sizeof(Shape)), corners.data(),
                 GL_STATIC_DRAW);
    describe(static_cast<const Shape*>(nullptr));
    glBindBuffer(GL_ELEMENT_ARRAY_BUFFER, indices_.get());
    glBufferData(GL_ELEMENT_ARRAY_BUFFER, static_cast<GLsizeiptr>(index.size() * sizeof(std::uint32_t)),
                 index.data(), GL_STATIC_DRAW);
    glBindVertexArray(0);
    count_ = shapes.size();
    filled_ = true;
}

void ImpostorShapes::fill(std::span<const Sphere> spheres) { send(spheres); }
void ImpostorShapes::fill(std::span<const Stick> sticks) { send(sticks); }

void ImpostorShapes::draw(std::size_t first) {
    glBindVertexArray(array_.get());
    glDrawElements(GL_TRIANGLES, static_cast<GLsizei>(6 * std::min(first, count_)), GL_UNSIGNED_INT, nullptr);
}

ImpostorPrograms::Program::Program(const char* what, const char* vertex, const char* fragment_text)
    : program(what, shader((kCommon + std::string(vertex)).c_str()).c_str(), fragment(fragment_text).c_str()),
      view(program),
      pick(program.uniform("u_pick")),
      body(program.uniform("u_body")),
      grow(program.uniform("u_grow")) {}

void ImpostorPrograms::Program::use(const ImpostorView& v) const {
    program.use();
    view.set(v.eye_from_local, v.projection, v.haze);
    glUniform1i(pick, static_cast<GLint>(v.colouring));
    glUniform1f(grow, v.grow);
    glUniform3f(body, static_cast<float>(v.body[0]) / 255.0F, static_cast<float>(v.body[1]) / 255.0F,
                static_cast<float>(v.body[2]) / 255.0F);
}

ImpostorPrograms::ImpostorPrograms()
    : spheres_("sphere", kSphereVertex, kSphereFragment), sticks_("stick", kStickVertex, kStickFragment) {}

void ImpostorPrograms::use_spheres(const ImpostorView& view) { spheres_.use(view); }
void ImpostorPrograms::use_sticks(const ImpostorView& view) { sticks_.use(view); }

}  // namespace tact
