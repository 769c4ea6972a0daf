#include "gui/window/window.hpp"

#include <epoxy/gl.h>
//
#include <GLFW/glfw3.h>
#include <backends/imgui_impl_glfw.h>
#include <backends/imgui_impl_opengl3.h>
#include <imgui.h>

#include <algorithm>
#include <cstdlib>
#include <utility>

#include "ipc/base/error.hpp"

namespace tact {
namespace {

std::string glfw_text() {
    const char* words = nullptr;
    glfwGetError(&words);
    return words != nullptr ? words : "no reason given";
}

WindowInput& input_of(GLFWwindow* window) {
    return *static_cast<WindowInput*>(glfwGetWindowUserPointer(window));
}
std::vector<KeyStroke>& keys_of(GLFWwindow* window) { return input_of(window).keys; }
void note_input(GLFWwindow* window) { input_of(window).any = true; }

void on_drop(GLFWwindow* window, int count, const char** paths) {
    input_of(window).dropped.assign(paths, paths + count);
}

// The letter printed on a key, because the position of Z depends on the keyboard; without Latin letters, the one at
// that position. 0: none.
char letter_of(int key, int scancode) {
    const char* const name = glfwGetKeyName(key, scancode);
    if (name != nullptr && name[0] >= 'a' && name[0] <= 'z' && name[1] == '\0') return name[0];
    const bool other_letters = name != nullptr && (static_cast<unsigned char>(name[0]) & 0x80U) != 0;
    if (other_letters && key >= GLFW_KEY_A && key <= GLFW_KEY_Z)
        return static_cast<char>('a' + (key - GLFW_KEY_A));
    return '\0';
}

KeyCode code_of(int key) {
    switch (key) {
        case GLFW_KEY_HOME:
            return KeyCode::home;
        case GLFW_KEY_ENTER:
        case GLFW_KEY_KP_ENTER:
            return KeyCode::enter;
        case GLFW_KEY_ESCAPE:
            return KeyCode::escape;
        case GLFW_KEY_SPACE:
            return KeyCode::space;
        default:
            return KeyCode::none;
    }
}

void on_key(GLFWwindow* window, int key, int scancode, int action, int modifiers) {
    note_input(window);
    if (action == GLFW_PRESS) input_of(window).pressed.push_back(key);
    if (action != GLFW_PRESS || (modifiers & (GLFW_MOD_ALT | GLFW_MOD_SUPER)) != 0) return;
    KeyStroke stroke;
    stroke.control = (modifiers & GLFW_MOD_CONTROL) != 0;
    stroke.shift = (modifiers & GLFW_MOD_SHIFT) != 0;
    stroke.code = code_of(key);
    if (stroke.code == KeyCode::none) {
        stroke.character = letter_of(key, scancode);
        stroke.code = stroke.character != '\0' ? KeyCode::character : KeyCode::none;
    }
    if (stroke.code != KeyCode::none) keys_of(window).push_back(stroke);
}

// Signs and digits by character, not by key: the position of '?' depends on the keyboard.
void on_char(GLFWwindow* window, unsigned int character) {
    note_input(window);
    const bool letter = (character | 0x20U) >= 'a' && (character | 0x20U) <= 'z';
    if (character <= ' ' || character > '~' || letter) return;  // on_key() handles those
    keys_of(window).push_back({KeyCode::character, static_cast<char>(character), false, false});
}

}  // namespace

Window::Window(int width_px, int height_px, bool hidden, float ui_scale) : ui_scale_(ui_scale) {
    try {
        open(width_px, height_px, hidden);
        start_imgui();
    } catch (...) {
        glfwTerminate();
        throw;
    }
}

void Window::open(int width_px, int height_px, bool hidden) {
    if (glfwInit() != GLFW_TRUE) {
        const char* const display = std::getenv("DISPLAY");
        const char* const wayland = std::getenv("WAYLAND_DISPLAY");
        if (display == nullptr && wayland != nullptr)
            throw StartupError("opening a window", "this Wayland session has no X server: DISPLAY is not set",
                               "install the package xwayland and start the session again, or use its own X "
                               "server: xvfb-run -a tact-gui ...");
        throw StartupError(
            "opening a window",
            display == nullptr ? "no display: DISPLAY and WAYLAND_DISPLAY are not set" : glfw_text(),
            "run it in a desktop session, or under its own X server: xvfb-run -a tact-gui ...");
    }
    glfwWindowHint(GLFW_CONTEXT_VERSION_MAJOR, 3);
    glfwWindowHint(GLFW_CONTEXT_VERSION_MINOR, 3);
    glfwWindowHint(GLFW_OPENGL_PROFILE, GLFW_OPENGL_CORE_PROFILE);
    glfwWindowHint(GLFW_OPENGL_FORWARD_COMPAT, GLFW_TRUE);
    glfwWindowHint(GLFW_VISIBLE, hidden ? GLFW_FALSE : GLFW_TRUE);
    glfwWindowHint(GLFW_DEPTH_BITS, 24);
    glfwWindowHint(GLFW_STENCIL_BITS, 0);
    window_ = glfwCreateWindow(width_px, height_px, "Tact", nullptr, nullptr);
    if (window_ == nullptr)
        throw StartupError(
            "creating an OpenGL 3.3 core context", glfw_text(),
            "install a graphics driver with OpenGL 3.3, or render in software: LIBGL_ALWAYS_SOFTWARE=1 "
            "with the package libgl1-mesa-dri");
    glfwMakeContextCurrent(window_);
    if (epoxy_gl_version() < 33)
        throw StartupError("creating an OpenGL 3.3 core context",
                           "the driver provides version " + std::to_string(epoxy_gl_version() / 10) + "." +
                               std::to_string(epoxy_gl_version() % 10),
                           "install a graphics driver with OpenGL 3.3, or set LIBGL_ALWAYS_SOFTWARE=1");
    const auto* const name = reinterpret_cast<const char*>(glGetString(GL_RENDERER));
    renderer_ = name != nullptr ? name : "unknown";
    for (const char* const word : {"llvmpipe", "softpipe", "SWR", "Software"})
        if (renderer_.find(word) != std::string::npos) software_ = true;
    // A software renderer draws in show(), which must count as work, so it must not wait for the display there.
    paced_ = !software_ && !hidden;
    glfwSwapInterval(paced_ ? 1 : 0);
    GLFWmonitor* const monitor = glfwGetPrimaryMonitor();
    const GLFWvidmode* const video = monitor != nullptr ? glfwGetVideoMode(monitor) : nullptr;
    if (video != nullptr && video->refreshRate > 0) display_period_s_ = 1.0 / video->refreshRate;
    if (hidden) target_ = std::make_unique<OffscreenTarget>(width_px, height_px);
    glfwSetWindowUserPointer(window_, &input_);
    glfwSetKeyCallback(window_, on_key);
    glfwSetCharCallback(window_, on_char);
    glfwSetDropCallback(window_, on_drop);
    // ImGui's backend calls these as well as its own.
    glfwSetCursorPosCallback(window_, [](GLFWwindow* w, double, double) { note_input(w); });
    glfwSetMouseButtonCallback(window_, [](GLFWwindow* w, int, int, int) { note_input(w); });
    glfwSetScrollCallback(window_, [](GLFWwindow* w, double, double) { note_input(w); });
    glfwSetCursorEnterCallback(window_, [](GLFWwindow* w, int) { note_input(w); });
    glfwSetWindowFocusCallback(window_, [](GLFWwindow* w, int) { note_input(w); });
    glfwSetWindowSizeLimits(window_, 320, 240, GLFW_DONT_CARE, GLFW_DONT_CARE);
}

void Window::start_imgui() {
    IMGUI_CHECKVERSION();
    ImGui::CreateContext();
    imgui_ = true;
    ImGui::GetIO().IniFilename = nullptr;  // the layout is fixed
    ImGui::GetIO().LogFilename = nullptr;
    if (!ImGui_ImplGlfw_InitForOpenGL(window_, true) || !ImGui_ImplOpenGL3_Init("#version 330 core"))
        throw StartupError("starting ImGui", "its OpenGL backend rejects the context",
                           "update the graphics driver");
}

Window::~Window() {
    if (imgui_) {
        ImGui_ImplOpenGL3_Shutdown();
        ImGui_ImplGlfw_Shutdown();
        ImGui::DestroyContext();
    }
    target_.reset();
    if (window_ != nullptr) glfwDestroyWindow(window_);
    glfwTerminate();
}

Window::Size Window::size() const {
    Size s;
    if (target_)
        return {target_->width_px(), target_->height_px(), target_->width_px(), target_->height_px()};
    glfwGetWindowSize(window_, &s.width, &s.height);
    glfwGetFramebufferSize(window_, &s.width_px, &s.height_px);
    return s;
}

// The part of the display's scale that is not in the window's units: all of it under X11, none under Wayland.
float Window::density(const Size& s) const {
    float x = 1.0F, y = 1.0F;
    if (!target_) glfwGetWindowContentScale(window_, &x, &y);
    return std::max(x, y) * static_cast<float>(s.width) / static_cast<float>(std::max(s.width_px, 1));
}

bool Window::close_wanted() const { return glfwWindowShouldClose(window_) == GLFW_TRUE; }
void Window::set_title(const std::string& title) { glfwSetWindowTitle(window_, title.c_str()); }

bool Window::take_input() {
    glfwPollEvents();
    const Size s = size();
    const ImGuiIO& io = ImGui::GetIO();
    const bool held =
        std::any_of(std::begin(io.MouseDown), std::end(io.MouseDown), [](bool down) { return down; });
    const bool resized = s.width != size_before_.width || s.height != size_before_.height ||
                         s.width_px != size_before_.width_px || s.height_px != size_before_.height_px;
    size_before_ = s;
    return std::exchange(input_.any, false) || held || resized;
}

void Window::begin_panels(Theme& theme) {
    const Size s = size();
    const float scale = theme_scale(s.width, s.height, density(s), ui_scale_);
    if (theme.text == nullptr) {
        build_theme(theme, scale);  // the backend uploads it with its first frame
    } else if (follow_letters(theme, Monotonic::now()) || scale != theme.scale) {
        if (scale != theme.scale) build_theme(theme, scale);
        ImGui_ImplOpenGL3_DestroyFontsTexture();
        ImGui_ImplOpenGL3_CreateFontsTexture();
    }
    ImGui_ImplOpenGL3_NewFrame();
    ImGui_ImplGlfw_NewFrame();
    show_short_presses();
    if (target_) {
        ImGui::GetIO().DisplaySize = {static_cast<float>(s.width), static_cast<float>(s.height)};
        ImGui::GetIO().DisplayFramebufferScale = {1.0F, 1.0F};
    }
    ImGui::NewFrame();
}

// Before 1.87 ImGui sees only whether a key is down when a frame begins: a press shorter than a frame would be lost, and with it
// Backspace or Enter in a field while frames take long.
void Window::show_short_presses() {
#if IMGUI_VERSION_NUM < 18700
    bool* const down = ImGui::GetIO().KeysDown;
    for (const int key : held_for_a_frame_)
        if (glfwGetKey(window_, key) != GLFW_PRESS) down[key] = false;
    held_for_a_frame_.clear();
    for (const int key : input_.pressed) {
        if (key < 0 || key > GLFW_KEY_LAST || down[key]) continue;
        down[key] = true;
        held_for_a_frame_.push_back(key);
    }
#endif
    input_.pressed.clear();
}

void Window::bind() {
    if (target_)
        target_->bind();
    else
        glBindFramebuffer(GL_FRAMEBUFFER, 0);
}

void Window::show() {
    if (target_)
        glFinish();  // nothing to swap, and frames must not queue up
    else
        glfwSwapBuffers(window_);
}

std::vector<KeyStroke> Window::take_keys() { return std::exchange(input_.keys, {}); }
std::vector<std::string> Window::take_dropped() { return std::exchange(input_.dropped, {}); }

Image Window::picture() {
    const Size s = size();
    if (target_)
        target_->bind();
    else
        glReadBuffer(GL_BACK);
    return read_pixels(s.width_px, s.height_px);
}

}  // namespace tact
