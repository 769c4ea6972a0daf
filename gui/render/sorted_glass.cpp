#include "gui/render/sorted_glass.hpp"

namespace tact {
namespace {

constexpr char kBlendVertex[] = R"(#version 330 core
void main() {
    gl_Position = vec4(gl_VertexID == 1 ? 3.0 : -1.0, gl_VertexID == 2 ? 3.0 : -1.0, 0.0, 1.0);
}
)";
// A layer is a colour and its opacity; a sum is the light it sends and the part that passes.
constexpr char kBlendFragment[] = R"(#version 330 core
uniform sampler2D u_texture;
uniform int u_layer;
uniform ivec2 u_corner;
out vec4 colour;
void main() {
    vec4 c = texelFetch(u_texture, ivec2(gl_FragCoord.xy) - u_corner, 0);
    colour = u_layer == 1 ? vec4(c.rgb * c.a, 1.0 - c.a) : c;
}
)";
constexpr GLint kSum = 0, kLayer = 1;

void bind(GLuint unit, GLuint texture) {
    glActiveTexture(GL_TEXTURE0 + unit);
    glBindTexture(GL_TEXTURE_2D, texture);
    glActiveTexture(GL_TEXTURE0);
}

void clear_colour(float alpha) {
    const float none[4] = {0.0F, 0.0F, 0.0F, alpha};
    glClearBufferfv(GL_COLOR, 0, none);
}

void clear_depth(float depth) { glClearBufferfv(GL_DEPTH, 0, &depth); }

}  // namespace

SortedGlass::SortedGlass(Programs& programs)
    : programs_(programs),
      blend_("layers of glass", kBlendVertex, kBlendFragment),
      how_(blend_.uniform("u_layer")),
      corner_(blend_.uniform("u_corner")) {}

void SortedGlass::fit(int width_px, int height_px) {
    if (width_px == width_px_ && height_px == height_px_) return;
    width_px_ = width_px;
    height_px_ = height_px;
    const auto describe_image = [&](GlTexture& texture, GLint format, GLenum channels) {
        glBindTexture(GL_TEXTURE_2D, texture.get());
        for (const GLenum filter : {GL_TEXTURE_MIN_FILTER, GL_TEXTURE_MAG_FILTER})
            glTexParameteri(GL_TEXTURE_2D, filter, GL_NEAREST);
        glTexImage2D(GL_TEXTURE_2D, 0, format, width_px, height_px, 0, channels, GL_FLOAT, nullptr);
    };
    describe_image(solid_, GL_DEPTH_COMPONENT24, GL_DEPTH_COMPONENT);
    // Exactly as the fragments have it, so that a layer is told from the one before.
    for (GlTexture& depth : before_) describe_image(depth, GL_DEPTH_COMPONENT32F, GL_DEPTH_COMPONENT);
    for (GlTexture* const colour : {&layer_, &sum_}) describe_image(*colour, GL_RGBA16F, GL_RGBA);
}

void SortedGlass::attach(GLuint colour, GLuint depth) {
    glFramebufferTexture2D(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, GL_TEXTURE_2D, colour, 0);
    glFramebufferTexture2D(GL_FRAMEBUFFER, GL_DEPTH_ATTACHMENT, GL_TEXTURE_2D, depth, 0);
}

void SortedGlass::fill_screen(GLuint texture, GLint how) {
    blend_.use();
    glUniform1i(how_, how);
    bind(0, texture);
    glBindVertexArray(empty_.get());
    glDrawArrays(GL_TRIANGLES, 0, 3);
}

// Behind what the sum has: its light counts by the part that still passes.
void SortedGlass::add(GLuint layer, bool straight) {
    attach(sum_.get(), 0);
    glDisable(GL_DEPTH_TEST);
    glEnable(GL_BLEND);
    glBlendFuncSeparate(GL_DST_ALPHA, GL_ONE, GL_ZERO, GL_SRC_ALPHA);
    blend_.use();
    glUniform2i(corner_, 0, 0);
    fill_screen(layer, straight ? kLayer : kSum);
}

void SortedGlass::draw(int x_px, int y_px, int width_px, int height_px, int layers,
                       const std::function<void()>& draw) {
    GLint bound = 0;
    glGetIntegerv(GL_DRAW_FRAMEBUFFER_BINDING, &bound);
    fit(width_px, height_px);
    glBindTexture(GL_TEXTURE_2D, solid_.get());
    glCopyTexSubImage2D(GL_TEXTURE_2D, 0, 0, 0, x_px, y_px, width_px, height_px);
    const GLboolean clips = glIsEnabled(GL_CLIP_DISTANCE0);
    glBindFramebuffer(GL_FRAMEBUFFER, frame_.get());
    glViewport(0, 0, width_px, height_px);
    attach(sum_.get(), before_[1].get());
    glDepthMask(GL_TRUE);
    clear_colour(1.0F);
    clear_depth(0.0F);
    GLuint query = 0;
    glGenQueries(1, &query);
    const auto triangles = [&](int before) {
        bind(1, solid_.get());
        bind(2, before_[before].get());
        programs_.peel(true);
        if (clips == GL_TRUE) glEnable(GL_CLIP_DISTANCE0);
        draw();
        glDisable(GL_CLIP_DISTANCE0);
        programs_.peel(false);
    };
    layers_drawn_ = 0;
    bool more = true;
    for (int k = 0; k < layers && more; ++k) {
        attach(layer_.get(), before_[k % 2].get());
        glEnable(GL_DEPTH_TEST);
        glDepthMask(GL_TRUE);
        glDisable(GL_BLEND);
        clear_colour(0.0F);
        clear_depth(1.0F);
        glBeginQuery(GL_ANY_SAMPLES_PASSED, query);
        triangles((k + 1) % 2);
        glEndQuery(GL_ANY_SAMPLES_PASSED);
        GLuint any = 0;
        glGetQueryObjectuiv(query, GL_QUERY_RESULT, &any);
        more = any != 0;
        if (!more) break;
        ++layers_drawn_;
        add(layer_.get(), true);
    }
    if (more) {  // behind the layers, over each other as they come
        attach(layer_.get(), 0);
        glDisable(GL_DEPTH_TEST);
        glEnable(GL_BLEND);
        glBlendFuncSeparate(GL_SRC_ALPHA, GL_ONE_MINUS_SRC_ALPHA, GL_ZERO, GL_ONE_MINUS_SRC_ALPHA);
        clear_colour(1.0F);
        triangles((layers + 1) % 2);
        add(layer_.get(), false);
    }
    glDeleteQueries(1, &query);
    glBindFramebuffer(GL_FRAMEBUFFER, static_cast<GLuint>(bound));
    glViewport(x_px, y_px, width_px, height_px);
    glDisable(GL_DEPTH_TEST);
    glDepthMask(GL_FALSE);
    glEnable(GL_BLEND);
    glBlendFunc(GL_ONE, GL_SRC_ALPHA);
    blend_.use();
    glUniform2i(corner_, x_px, y_px);
    fill_screen(sum_.get(), kSum);
    for (const GLuint unit : {2U, 1U, 0U}) bind(unit, 0);
    glBlendFunc(GL_SRC_ALPHA, GL_ONE_MINUS_SRC_ALPHA);
    glEnable(GL_DEPTH_TEST);
    glDepthMask(GL_TRUE);
    if (clips == GL_TRUE) glEnable(GL_CLIP_DISTANCE0);
    glBindVertexArray(0);
}

}  // namespace tact
