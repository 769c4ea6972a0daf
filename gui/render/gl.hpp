// Owners of OpenGL names, and shader programs that say what is wrong with them.
//
// Thread   frame thread, with the context current, destruction included.
// Fails by StartupError with the driver's own words.
#pragma once

#include <epoxy/gl.h>

#include <Eigen/Core>
#include <cstddef>
#include <string>
#include <utility>

namespace tact {

class GlBuffer {
public:
    GlBuffer() = default;
    GlBuffer(GlBuffer&& other) noexcept : name_(std::exchange(other.name_, 0U)) {}
    GlBuffer& operator=(GlBuffer&& other) noexcept {
        std::swap(name_, other.name_);
        return *this;
    }
    ~GlBuffer() {
        if (name_ != 0) glDeleteBuffers(1, &name_);
    }
    // Made at the first call, so that an owner may be constructed without a context.
    GLuint get() {
        if (name_ == 0) glGenBuffers(1, &name_);
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
        if (name_ != 0) glDeleteVertexArrays(1, &name_);
    }
    GLuint get() {
        if (name_ == 0) glGenVertexArrays(1, &name_);
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
        if (name_ != 0) glDeleteTextures(1, &name_);
    }
    GLuint get() {
        if (name_ == 0) glGenTextures(1, &name_);
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
        if (name_ != 0) glDeleteFramebuffers(1, &name_);
    }
    GLuint get() {
        if (name_ == 0) glGenFramebuffers(1, &name_);
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
    // OpenGL takes the offset in the guise of a pointer.
    const void* const at = reinterpret_cast<const void*>(offset);  // NOLINT(performance-no-int-to-ptr)
    glVertexAttribPointer(place, size, type, normalized, stride, at);
    glEnableVertexAttribArray(place);
}

}  // namespace tact
