#include "gui/window/run_recorder.hpp"

#include <chrono>
#include <thread>

#include <spdlog/spdlog.h>

#include "gui/base/output_folder.hpp"
#include "ipc/base/clock.hpp"
#include "ipc/base/error.hpp"

namespace tact {

StatusText RunRecorder::toggle() {
    if (running()) {
        job_.cancel();
        return {Grade::unknown, "ending the recording"};
    }
    try {
        file_ = new_output("recording", ".h5");
        job_.start(program_, {file_.string(), "--session", session_, "--quiet", "--wait", "5"});
        return {Grade::good, "recording to " + file_.string()};
    } catch (const StartupError& e) {
        return {Grade::bad, e.what()};
    }
}

std::optional<StatusText> RunRecorder::poll() {
    const auto ended = job_.poll();
    if (!ended) return std::nullopt;
    if (ended->good() && std::filesystem::exists(file_))
        return StatusText{Grade::good, "recorded " + file_.string()};
    return StatusText{Grade::bad, "the recording failed: " + ended->output};
}

void RunRecorder::finish() {
    if (!running()) return;
    job_.cancel();
    const Instant begin = Monotonic::now();
    while (Monotonic::now() - begin < std::chrono::seconds(10)) {
        if (const auto said = poll()) {
            spdlog::info("{}", said->text);
            return;
        }
        std::this_thread::sleep_for(std::chrono::milliseconds(20));
    }
}

}  // namespace tact
