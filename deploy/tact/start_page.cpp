#include "deploy/tact/start_page.hpp"

#include <fcntl.h>
#include <unistd.h>

#include <cstdio>
#include <cstdlib>
#include <optional>
#include <string>
#include <vector>

#include "deploy/tact/child.hpp"
#include "deploy/tact/files.hpp"
#include "deploy/tact/scene_switch.hpp"
#include "deploy/tact/signals.hpp"
#include "ipc/base/error.hpp"
#include "ipc/scene/file/scene_meta.hpp"
#include "ipc/scene/file/scene_peek.hpp"
#include "ipc/scene/file/scene_switch.hpp"

namespace tact::launch {
namespace {

constexpr std::size_t kLogRead = 65536;

// Arguments of `tact` for what the window requested, once it has.
std::optional<std::vector<std::string>> chosen_in(const std::filesystem::path& folder) {
    try {
        if (auto demo = take_asked_demo(folder)) return std::vector<std::string>{"demo", std::move(*demo)};
        if (const auto scene = take_asked_scene(folder)) {
            if (scene->extension() == ".bone")
                throw StartupError("opening " + scene->string(), "it is bone of a scene, without the scene",
                                   "open the scene first, then this file");
            static_cast<void>(peek_scene(asked_of(*scene).scene));
            return std::vector<std::string>{"run", scene->string()};
        }
    } catch (const StartupError& e) {
        std::fprintf(stderr, "tact: %s\n", e.what());
        refuse_scene(folder, e.what());
    }
    return std::nullopt;
}

struct PageEnd {
    int exit_code = 0;
    std::vector<std::string> chosen;  // empty: the person closed the page
};

PageEnd show_page(Signals& signals, const std::vector<std::string>& words, const std::string& trouble) {
    const ScratchFolder scratch;
    if (!trouble.empty()) refuse_scene(scratch.path(), trouble);
    ChildSettings settings;
    settings.arguments = {"--start-page", "--scene-switch", scratch.path().string()};
    settings.arguments.insert(settings.arguments.end(), words.begin(), words.end());
    Child window("tact-gui", find_program("tact-gui"), settings);
    PageEnd end;
    bool asked = false;
    while (!window.poll()) {
        if (signals.wait(50) != 0) {
            asked = true;
            window.stop();
        }
        if (asked || !end.chosen.empty()) continue;
        if (auto chosen = chosen_in(scratch.path())) {
            end.chosen = std::move(*chosen);
            window.stop();
        }
    }
    const Ending& ended = *window.poll();
    if (asked) {
        end.chosen.clear();
        end.exit_code = 130;
    } else if (end.chosen.empty() && !ended.clean()) {
        std::fprintf(stderr, "tact-gui %s\n  fix: see the messages of tact-gui above\n",
                     ended.text().c_str());
        end.exit_code = 1;
    }
    return end;
}

// Output of a run, in a file that is also copied to this program's output, so that the page can show why a run failed.
class RunLog {
public:
    explicit RunLog(const std::filesystem::path& path)
        : fd_(::open(path.c_str(), O_RDWR | O_CREAT | O_CLOEXEC | O_APPEND, 0600)) {
        if (fd_ < 0) throw StartupError("writing " + path.string(), last_error(), "free some space there");
    }
    ~RunLog() { ::close(fd_); }
    RunLog(const RunLog&) = delete;
    RunLog& operator=(const RunLog&) = delete;
    [[nodiscard]] int fd() const { return fd_; }
    void copy_new() {
        char text[kLogRead];
        for (ssize_t got = 0; (got = ::pread(fd_, text, sizeof text, copied_)) > 0; copied_ += got) {
            std::fwrite(text, 1, static_cast<std::size_t>(got), stdout);
            last_.append(text, static_cast<std::size_t>(got));
            if (last_.size() > kRefusalMost) last_.erase(0, last_.size() - kRefusalMost);
        }
        std::fflush(stdout);
    }
    // The last error message with what follows it, or the last lines.
    [[nodiscard]] std::string trouble() const {
        const auto at = last_.rfind("\ntact");
        return at == std::string::npos ? last_ : last_.substr(at + 1);
    }

private:
    int fd_;
    off_t copied_ = 0;
    std::string last_;
};

struct RunEnd {
    int exit_code = 0;
    bool asked = false;  // by a signal
    std::string trouble;
};

RunEnd run(Signals& signals, const std::vector<std::string>& words) {
    const ScratchFolder scratch;
    RunLog log(scratch.path() / "run.log");
    ChildSettings settings;
    settings.arguments = words;
    settings.output_fd = log.fd();
    settings.grace = std::chrono::seconds(30);  // it ends programs of its own
    Child tact("tact", find_program("tact"), settings);
    RunEnd end;
    while (!tact.poll()) {
        if (signals.wait(100) != 0) {
            end.asked = true;
            tact.stop();
        }
        log.copy_new();
    }
    log.copy_new();
    const Ending& ended = *tact.poll();
    end.exit_code = ended.by_signal ? 128 + ended.number : ended.number;
    if (end.exit_code != 0) end.trouble = "The run ended with an error.\n" + log.trouble();
    return end;
}

}  // namespace

int run_start_page(const std::vector<std::string>& words) {
    const auto set = [](const char* name) {
        const char* const value = std::getenv(name);
        return value != nullptr && value[0] != '\0';
    };
    if (!set("DISPLAY") && !set("WAYLAND_DISPLAY"))
        throw StartupError("opening a window", "neither DISPLAY nor WAYLAND_DISPLAY is set",
                           "start it on a desktop, or name a command: tact --help lists them");
    Signals signals;
    std::string trouble;
    for (;;) {
        PageEnd page = show_page(signals, words, trouble);
        if (page.chosen.empty()) return page.exit_code;
        page.chosen.insert(page.chosen.end(), words.begin(), words.end());
        const RunEnd end = run(signals, page.chosen);
        if (end.exit_code == 0 || end.asked) return end.exit_code;
        trouble = end.trouble;
    }
}

}  // namespace tact::launch
