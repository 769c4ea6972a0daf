#include "deploy/tact/look_back.hpp"

#include <signal.h>

#include <algorithm>

#include "ipc/base/error.hpp"

namespace tact::launch {
namespace {

namespace fs = std::filesystem;
constexpr auto kSavedWithin = std::chrono::seconds(15);
constexpr auto kWrittenAfter = std::chrono::milliseconds(400);
constexpr double kRecordedAfterS = 1.1;  // a flight recorder goes on for a second, and saves by batches

std::set<fs::path> recordings_in(const fs::path& folder) {
    std::set<fs::path> all;
    std::error_code failed;
    for (fs::directory_iterator it(folder, failed), end; !failed && it != end; it.increment(failed))
        if (it->path().extension() == ".h5") all.insert(it->path());
    return all;
}

}  // namespace

void LookBack::begin(double ago_s, pid_t recorder) {
    const auto fail = [](const std::string& why, const char* fix) {
        throw StartupError("looking back", why, fix);
    };
    if (ago_s_ || (replay_ && !replay_->poll()))
        fail("a window that looks back is open, or about to open", "close it first");
    replay_.reset();
    before_ = recordings_in(options_.flight);
    if (kill(recorder, SIGUSR1) != 0)
        fail("the flight recorder ended: " + last_error(), "start the run again");
    ago_s_ = ago_s;
    asked_at_ = grown_at_ = Monotonic::now();
    bytes_ = 0;
}

// Other causes save too; this request is served by the first file after it, once that no longer grows.
std::optional<fs::path> LookBack::new_recording() {
    for (const fs::path& file : recordings_in(options_.flight)) {
        if (before_.contains(file)) continue;
        std::error_code unknown;
        const std::uintmax_t bytes = fs::file_size(file, unknown);
        if (unknown || bytes != bytes_) {
            bytes_ = bytes;
            grown_at_ = Monotonic::now();
        }
        if (Monotonic::now() - grown_at_ > kWrittenAfter) return file;
        return std::nullopt;
    }
    return std::nullopt;
}

void LookBack::poll() {
    if (replay_) static_cast<void>(replay_->poll());
    if (!ago_s_) return;
    if (const auto recording = new_recording()) return show(*recording);
    if (Monotonic::now() - asked_at_ < kSavedWithin) return;
    ago_s_.reset();
    throw StartupError("looking back", "the flight recorder saved nothing in " + options_.flight.string(),
                       "see its message in the terminal");
}

void LookBack::show(const fs::path& recording) {
    ChildSettings settings;
    settings.arguments = {"replay",    recording.string(),
                          "--show",    "--from=-" + std::to_string(*ago_s_ + kRecordedAfterS),
                          "--size",    options_.size,
                          "--into",    into_.string(),
                          "--session", options_.session + "-past"};
    ago_s_.reset();
    settings.arguments.insert(settings.arguments.end(), {"--scene", scene_.string()});
    if (const std::string bone = options_.controller_value("--resume"); !bone.empty())
        settings.arguments.insert(settings.arguments.end(), {"--bone", bone});
    const auto texts = std::find(options_.visual.begin(), options_.visual.end(), "--texts");
    if (texts != options_.visual.end())
        settings.arguments.insert(settings.arguments.end(), {"--texts", *std::next(texts) + ".past"});
    settings.grace = std::chrono::seconds(15);  // it ends programs of its own
    replay_.emplace("tact replay", find_program("tact"), settings);
}

void LookBack::stop() {
    if (!replay_) return;
    replay_->stop();
    replay_->wait(std::chrono::seconds(15));
}

}  // namespace tact::launch
