// Replays a recorded run with the controller's code (servo, models, safety chain, governor), in simulated time and
// deterministically.
//
// Given     the recorded samples, orders, reports, clock readings, passed deadlines, and the controller's start
//           parameters. Models are built from the same scene and settings.
// Compared  with the recording, bit by bit, each step: the wrenches of the models and the wrenches sent to the devices.
// Exact     from the start of a run until the recorder lost a step; obstacle() gives the reason if not.
// Thread    one; as fast as possible.
// Fails by  StartupError: wrong scene, or too little data about the start.
#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "hal/replay/replay_device.hpp"
#include "ipc/base/clock.hpp"
#include "ipc/record/recording_reader.hpp"
#include "ipc/scene/file/scene_file.hpp"
#include "ipc/shm/region.hpp"
#include "rt/servo/servo.hpp"
#include "rt/start/start_options.hpp"
#include "rt/start/systems.hpp"

namespace tact {

// The clock of a replayed cycle: returns the recorded readings in order.
class ReplayClock final : public Clock {
public:
    void give(std::span<const std::int64_t> timestamps_ns, Duration shift) noexcept;
    Instant now() noexcept TACT_RT override { return timestamps_[std::min(at_++, count_ - 1)]; }
    void wait_until(Instant /*t*/) noexcept TACT_RT override {}
    // True if each reading was used exactly once.
    [[nodiscard]] bool used_up() const noexcept { return at_ == count_; }

private:
    std::array<Instant, CycleTopic::kTimestampsMax> timestamps_{};
    std::size_t at_ = 0, count_ = 1;
};

// The first difference between recording and replay.
struct ReplayDifference {
    std::uint64_t step = 0, cycle = 0;
    std::uint32_t hand = 0;
    std::string what;  // "force sent to the device"
    double recorded[3]{}, replayed[3]{};
};

struct ReplayResult {
    std::uint64_t steps = 0;           // compared steps, including dry ones
    std::uint64_t different = 0;       // number of different steps
    std::uint64_t removed_levels = 0;  // bone removed, in density levels
    double force_n_most = 0.0;  // largest force sent to the first hand; 0 shows that the run had no contact
    std::optional<ReplayDifference> first;
};

struct ReplaySettings {
    std::filesystem::path recording;
    std::filesystem::path scene;   // empty: the recorded one
    std::filesystem::path bone{};  // drilled bone with which the run started; empty: the recorded one
};

class Replay {
public:
    explicit Replay(const ReplaySettings& settings);
    ~Replay();
    Replay(const Replay&) = delete;
    Replay& operator=(const Replay&) = delete;

    // The reason why the replay cannot be exact; empty if it can.
    [[nodiscard]] const std::string& obstacle() const { return obstacle_; }
    [[nodiscard]] const RecordingReader& recording() const { return reader_; }
    // The step that do_step() repeats next; null at the end.
    [[nodiscard]] const RecordedStep* upcoming() const { return has_step_ ? &step_ : nullptr; }
    void do_step();
    // True after the first step that is not dry.
    [[nodiscard]] bool started() const { return started_; }
    // Sets an offset for every time stamp; call it before the first step.
    void shift_by(Duration shift) { shift_ = shift; }
    [[nodiscard]] const ReplayResult& result() const { return result_; }
    [[nodiscard]] const Servo& servo() const { return *servo_; }
    [[nodiscard]] OwnedRegion<RtRegion>& region() { return region_; }
    [[nodiscard]] int shared_fd() const { return system_->fd(); }  // the system's own region; -1: none

private:
    void build_models(const ReplaySettings& from);
    void give_step();
    void fill_mailbox();
    void build_model_aside();
    void compare();
    void note(std::uint32_t hand, const char* what, const double (&recorded)[3], const Vec3& replayed);

    RecordingReader reader_;
    Duration shift_{0};
    std::string obstacle_;
    SceneFile scene_;
    StartOptions options_;
    RtConfig config_;
    OwnedRegion<RtRegion> region_;
    std::optional<SceneSystem> system_;
    ReplayClock clock_;
    ServoMailbox mailbox_;
    CycleScript script_;
    std::vector<std::unique_ptr<ReplayDevice>> devices_;
    ReplayLines lines_;
    std::optional<Servo> servo_;
    RecordedStep step_;
    bool has_step_ = false, started_ = false, different_ = false;
    std::uint64_t last_step_ = 0;
    ReplayResult result_;
};

}  // namespace tact
