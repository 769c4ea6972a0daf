// Checks of the doctor that use a resource instead of reading its state.
#include <poll.h>
#include <unistd.h>

#include <cerrno>
#include <cstdlib>
#include <cstring>

#include "deploy/tact/child.hpp"
#include "deploy/tact/doctor.hpp"
#include "deploy/tact/files.hpp"
#include "deploy/tact/gl_probe.hpp"
#include "deploy/tact/observer.hpp"
#include "ipc/base/error.hpp"
#include "ipc/shm/session_path.hpp"
#include "ipc/topics/text.hpp"

namespace tact::launch {
namespace {

constexpr const char* kFolderFix = "set TACT_RUNTIME_DIR to a folder of your own (mode 0700)";

// Converts a StartupError to a finding: the first line is the problem, the second the fix.
Finding failed(const std::string& name, const std::exception& e) {
    const std::string text = e.what();
    const auto cut = text.find("\n  fix: ");
    return {name, FindingLevel::fail, text.substr(0, cut),
            cut == std::string::npos ? "" : text.substr(cut + 9)};
}

Finding programs() {
    try {
        std::string folders;
        for (const char* const name : {"tact-prep", "tact-rt", "tact-gui"}) {
            const auto path = find_program(name);
            if (folders.find(path.parent_path().string()) == std::string::npos)
                folders += (folders.empty() ? "" : ", ") + path.parent_path().string();
        }
        return {"programs", FindingLevel::ok, "tact-prep, tact-rt and tact-gui are in " + folders, ""};
    } catch (const StartupError& e) {
        return failed("programs", e);
    }
}

Finding runtime_folder(const std::string& session) {
    try {
        const std::filesystem::path folder =
            std::filesystem::path(session_socket_path(session)).parent_path();
        const bool made_later = std::getenv("TACT_RUNTIME_DIR") == nullptr &&
                                !std::filesystem::exists(folder) &&
                                access(folder.parent_path().c_str(), W_OK | X_OK) == 0;
        const std::string distrust = made_later ? "" : distrust_runtime_folder(folder);
        if (!distrust.empty()) return {"runtime_folder", FindingLevel::fail, distrust, kFolderFix};
        if (!made_later && access(folder.c_str(), R_OK | W_OK | X_OK) != 0)
            return {"runtime_folder", FindingLevel::fail,
                    folder.string() + " cannot be used: " + std::strerror(errno), kFolderFix};
        return {"runtime_folder", FindingLevel::ok, "the processes use the folder " + folder.string(), ""};
    } catch (const StartupError& e) {
        return failed("runtime_folder", e);
    }
}

Finding cache() {
    try {
        return {"cache", FindingLevel::ok, "baked scenes are stored in " + cache_folder().string(), ""};
    } catch (const StartupError& e) {
        return failed("cache", e);
    }
}

Finding display() {
    const auto value = [](const char* name) {
        const char* const v = std::getenv(name);
        return std::string(v != nullptr ? v : "");
    };
    return judge_display(value("DISPLAY"), value("WAYLAND_DISPLAY"), !find_in_path("Xvfb").empty());
}

Finding opengl() {
    const GlAnswer gl = probe_gl();
    if (gl.renderer.empty())
        return {"opengl", FindingLevel::fail, "no OpenGL 3.3: " + gl.why,
                "sudo apt-get install libegl1 libgl1-mesa-dri; on a PC with a graphics card, also install "
                "its driver"};
    if (gl.software())
        return {"opengl", FindingLevel::warn,
                "OpenGL 3.3 in software (" + gl.renderer +
                    "): rendering takes processor time from other programs",
                "use a machine with a graphics card and its driver, and join the group render"};
    return {"opengl", FindingLevel::ok, "OpenGL 3.3: " + gl.renderer, ""};
}

Finding session_in_use(const std::string& session) {
    try {
        Observer observer(session);
        for (int i = 0; i < 30 && !observer.seen(); ++i) {
            observer.poll();
            ::poll(nullptr, 0, 10);
        }
        const auto health = observer.seen() ? newest(observer.region().health) : std::nullopt;
        if (!observer.attached()) return {"session", FindingLevel::ok, "session " + session + " is free", ""};
        return {"session", FindingLevel::ok,
                "a controller runs in session " + session +
                    (health ? std::string(", state ") + run_state_text(static_cast<RunState>(health->state))
                            : ""),
                ""};
    } catch (const StartupError& e) {
        return failed("session", e);
    }
}

}  // namespace

Finding judge_display(const std::string& x, const std::string& wayland, bool xvfb) {
    if (x.empty() && !wayland.empty())
        return {
            "display", FindingLevel::warn,
            "this Wayland session (" + wayland +
                ") has no X server (DISPLAY is not set), and the window needs XWayland where GLFW is older "
                "than 3.4, as in Debian 12",
            "sudo apt-get install xwayland, then log in again"};
    if (!x.empty())
        return {"display", FindingLevel::ok,
                "windows open on " + x +
                    (xvfb ? "; Xvfb is installed for --headless" : "; no Xvfb for --headless"),
                xvfb ? "" : "sudo apt-get install xvfb"};
    if (xvfb) return {"display", FindingLevel::ok, "no display; Xvfb is installed for --headless", ""};
    return {"display", FindingLevel::fail,
            "neither a display nor Xvfb is available, so no window can be opened",
            "sudo apt-get install xvfb"};
}

std::vector<Finding> try_surroundings(const std::string& session) {
    return {programs(), runtime_folder(session), cache(), session_in_use(session), display(), opengl()};
}

}  // namespace tact::launch
