#include "gui/render/gl.hpp"

#include <vector>

#include "ipc/base/error.hpp"

namespace tact {
namespace {

GLuint compile(const std::string& what, GLenum kind, const char* source) {
    const GLuint shader = glCreateShader(kind);
    glShaderSource(shader, 1, &source, nullptr);
    glCompileShader(shader);
    GLint good = 0;
    glGetShaderiv(shader, GL_COMPILE_STATUS, &good);
    if (good == GL_TRUE) return shader;
    std::vector<char> log(4096, '\0');
    glGetShaderInfoLog(shader, static_cast<GLsizei>(log.size() - 1), nullptr, log.data());
    glDeleteShader(shader);
    throw StartupError("compiling the " + what + " shader", log.data(),
                       "update the graphics driver, or set LIBGL_ALWAYS_SOFTWARE=1 for software rendering");
}

}  // namespace

GlProgram::GlProgram(const std::string& what, const char* vertex_source, const char* fragment_source) {
    const GLuint vertex = compile(what, GL_VERTEX_SHADER, vertex_source);
    const GLuint fragment = compile(what, GL_FRAGMENT_SHADER, fragment_source);
    name_ = glCreateProgram();
    glAttachShader(name_, vertex);
    glAttachShader(name_, fragment);
    glLinkProgram(name_);
    glDeleteShader(vertex);
    glDeleteShader(fragment);
    GLint good = 0;
    glGetProgramiv(name_, GL_LINK_STATUS, &good);
    if (good == GL_TRUE) return;
    std::vector<char> log(4096, '\0');
    glGetProgramInfoLog(name_, static_cast<GLsizei>(log.size() - 1), nullptr, log.data());
    throw StartupError("linking the " + what + " shader", log.data(),
                       "update the graphics driver, or set LIBGL_ALWAYS_SOFTWARE=1 for software rendering");
}

}  // namespace tact
