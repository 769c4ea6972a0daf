// EGL on Mesa's surfaceless platform creates a context without X, Wayland or a screen. The library is loaded on demand,
// so that tact also runs, and reports this, where OpenGL is not installed.
#include "deploy/tact/gl_probe.hpp"

#include <dlfcn.h>
#include <poll.h>
#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <cstdint>

namespace tact::launch {
namespace {

constexpr int kLimitMs = 10000;

// Constants of the EGL and OpenGL registries.
constexpr std::uint32_t kPlatformSurfaceless = 0x31DD, kOpenGlApi = 0x30A2;
constexpr std::int32_t kContextMajor = 0x3098, kContextMinor = 0x30FB, kProfileMask = 0x30FD,
                       kCoreProfile = 1, kEglNone = 0x3038;
constexpr std::uint32_t kGlRenderer = 0x1F01;

template <class F>
F symbol(void* library, const char* name) {
    return reinterpret_cast<F>(dlsym(library, name));
}

// Returns "+renderer" or "-reason".
std::string ask() {
    void* const egl = dlopen("libEGL.so.1", RTLD_NOW | RTLD_LOCAL);
    if (egl == nullptr) return "-libEGL.so.1 is not installed";
    using Address = void* (*)(const char*);
    using GetDisplay = void* (*)(std::uint32_t, void*, const std::int32_t*);
    using Initialize = unsigned (*)(void*, std::int32_t*, std::int32_t*);
    using Bind = unsigned (*)(std::uint32_t);
    using CreateContext = void* (*)(void*, void*, void*, const std::int32_t*);
    using MakeCurrent = unsigned (*)(void*, void*, void*, void*);
    using GetString = const unsigned char* (*)(std::uint32_t);
    const auto address = symbol<Address>(egl, "eglGetProcAddress");
    const auto initialize = symbol<Initialize>(egl, "eglInitialize");
    const auto bind = symbol<Bind>(egl, "eglBindAPI");
    const auto create = symbol<CreateContext>(egl, "eglCreateContext");
    const auto current = symbol<MakeCurrent>(egl, "eglMakeCurrent");
    if (!address || !initialize || !bind || !create || !current) return "-libEGL.so.1 lacks functions";
    const auto get_display = reinterpret_cast<GetDisplay>(address("eglGetPlatformDisplayEXT"));
    if (!get_display) return "-EGL does not support platforms";
    void* const display = get_display(kPlatformSurfaceless, nullptr, nullptr);
    if (display == nullptr || initialize(display, nullptr, nullptr) == 0)
        return "-no OpenGL driver can be loaded";
    const std::array<std::int32_t, 7> wanted{kContextMajor, 3,       kContextMinor, 3, kProfileMask,
                                             kCoreProfile,  kEglNone};
    if (bind(kOpenGlApi) == 0) return "-the driver has no desktop OpenGL";
    void* const context = create(display, nullptr, nullptr, wanted.data());
    if (context == nullptr || current(display, nullptr, nullptr, context) == 0)
        return "-the driver has no OpenGL 3.3";
    const auto get_string = reinterpret_cast<GetString>(address("glGetString"));
    const unsigned char* const renderer = get_string ? get_string(kGlRenderer) : nullptr;
    return renderer != nullptr ? "+" + std::string(reinterpret_cast<const char*>(renderer))
                               : "-the driver does not report its name";
}

}  // namespace

bool GlAnswer::software() const {
    for (const char* const name : {"llvmpipe", "softpipe", "swrast", "SWR"})
        if (renderer.find(name) != std::string::npos) return true;
    return false;
}

GlAnswer probe_gl() {
    std::array<int, 2> ends{};
    if (pipe(ends.data()) != 0) return {"", "a pipe could not be created"};
    const pid_t pid = fork();
    if (pid == 0) {
        close(STDERR_FILENO);  // hides the messages of drivers
        const std::string answer = ask();
        [[maybe_unused]] const auto n = write(ends[1], answer.data(), answer.size());
        _exit(0);
    }
    close(ends[1]);
    std::array<char, 256> text{};
    pollfd p{.fd = ends[0], .events = POLLIN, .revents = 0};
    ssize_t got = 0;
    const bool in_time = pid > 0 && ::poll(&p, 1, kLimitMs) == 1;
    if (in_time) got = read(ends[0], text.data(), text.size());
    close(ends[0]);
    if (pid > 0) {
        kill(pid, SIGKILL);
        waitpid(pid, nullptr, 0);
    }
    if (!in_time) return {"", "the driver did not respond within ten seconds"};
    if (got <= 0) return {"", "the driver crashed during the query"};
    const std::string rest(text.data() + 1, static_cast<std::size_t>(got) - 1);
    return text[0] == '+' ? GlAnswer{rest, ""} : GlAnswer{"", rest};
}

}  // namespace tact::launch
