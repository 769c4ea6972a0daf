// Owners of OpenGL names, and shader programs that report their errors.
//
// Thread   frame thread, with the context current, destruction included.
// Fails by StartupError with the driver's message.
#pragma once

#include <epoxy/gl.h>

#include <Eigen/Core>
#include <cstddef>
#include <cstdint>
#include <string>
#include <utility>

namespace tact {

// Names held by all owners in this file; a count that grows with time is a leak.
[[nodiscard]] inline std::uint32_t& gl_names_held() noexcept {
    static std::uint32_t held = 0;
    return held;
}

class GlBuffer {
public:
    GlBuffer() = default;
    GlBuffer(GlBuffer&& other) noexcept : name_(std::exchange(other.name_, 0U)) {}
    GlBuffer& operator=(GlBuffer&& other) noexcept {
        std::swap(name_, other.name_);
        return *this;
    }
    ~GlBuffer() {
        if (name_ == 0) return;
        glDeleteBuffers(1, &name_);
        --gl_names_held();
    }
    // Created by the first call, so that an owner may be constructed without a context.
    GLuint get() {
        if (name_ != 0) return name_;
        glGenBuffers(1, &name_);
        ++gl_names_held();
        return name_;
    }

private:
    GLuint name_ = 0;
};

class GlVertexArray {
public:
    GlVertexArray() = default;
    GlVertexArray(GlVertexArray&& other) noexcept : name_(std::exchange(other.name_, 0U)) {}
    GlVertexArray& operator=(GlVertexArray&& other) noexcept {
        std::swap(name_, other.name_);
        return *this;
    }
    ~GlVertexArray() {
        if (name_ == 0) return;
        glDeleteVertexArrays(1, &name_);
        --gl_names_held();
    }
    GLuint get() {
        if (name_ != 0) return name_;
        glGenVertexArrays(1, &name_);
        ++gl_names_held();
        return name_;
    }

private:
    GLuint name_ = 0;
};

class GlTexture {
public:
    GlTexture() = default;
    GlTexture(const GlTexture&) = delete;
    GlTexture& operator=(const GlTexture&) = delete;
    ~GlTexture() {
        if (name_ == 0) return;
        glDeleteTextures(1, &name_);
        --gl_names_held();
    }
    GLuint get() {
        if (name_ != 0) return name_;
        glGenTextures(1, &name_);
        ++gl_names_held();
        return name_;
    }

private:
    GLuint name_ = 0;
};

class GlFramebuffer {
public:
    GlFramebuffer() = default;
    GlFramebuffer(const GlFramebuffer&) = delete;
    GlFramebuffer& operator=(const GlFramebuffer&) = delete;
    ~GlFramebuffer() {
        if (name_ == 0) return;
        glDeleteFramebuffers(1, &name_);
        --gl_names_held();
    }
    GLuint get() {
        if (name_ != 0) return name_;
        glGenFramebuffers(1, &name_);
        ++gl_names_held();
        return name_;
    }

private:
    GLuint name_ = 0;
};

class GlRenderbuffer {
public:
    GlRenderbuffer() = default;
    GlRenderbuffer(const GlRenderbuffer&) = delete;
    GlRenderbuffer& operator=(const GlRenderbuffer&) = delete;
    ~GlRenderbuffer() {
        if (name_ == 0) return;
        glDeleteRenderbuffers(1, &name_);
        --gl_names_held();
    }
    GLuint get() {
        if (name_ != 0) return name_;
        glGenRenderbuffers(1, &name_);
        ++gl_names_held();
        return name_;
    }

private:
    GLuint name_ = 0;
};

class GlProgram {
public:
    GlProgram(const std::string& what, const char* vertex_source, const char* fragment_source);
    ~GlProgram() { glDeleteProgram(name_); }
    GlProgram(const GlProgram&) = delete;
    GlProgram& operator=(const GlProgram&) = delete;

    void use() const { glUseProgram(name_); }
    [[nodiscard]] GLint uniform(const char* name) const { return glGetUniformLocation(name_, name); }

private:
    GLuint name_ = 0;
};

inline void set_uniform(GLint place, const Eigen::Matrix4f& m) {
    glUniformMatrix4fv(place, 1, GL_FALSE, m.data());
}

// An attribute of interleaved data; offset in bytes.
inline void attribute(GLuint place, GLint size, GLenum type, GLboolean normalized, GLsizei stride,
                      std::size_t offset) {
    // OpenGL passes the offset as a pointer.
    const void* const at = reinterpret_cast<const void*>(offset);  // NOLINT(performance-no-int-to-ptr)
    glVertexAttribPointer(place, size, type, normalized, stride, at);
    glEnableVertexAttribArray(place);
}

}  // namespace tact
