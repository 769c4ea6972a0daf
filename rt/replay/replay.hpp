// A recorded run, done again by the same code: servo, models, safety chain, governor; in simulated time, deterministic.
//
// Given     what was recorded: samples, orders, reports, looks at the clock, deadlines that were found passed, and what
//           the controller was started with. Models are built anew, from the same scene and settings.
// Compared  with the recording, to the bit, each step: what the model wants and what the device is sent.
// Exact     from a run's start on, until the recorder lost a step; what stands in the way is in obstacle().
// Thread    one, all of it; as fast as it goes.
// Fails by  StartupError: another scene, a recording that says too little of its start.
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

// The clock of a cycle that is done again: says what it said, look by look.
class ReplayClock final : public Clock {
public:
    void give(std::span<const std::int64_t> looks_ns, Duration shift) noexcept;
    Instant now() noexcept TACT_RT override { return looks_[std::min(at_++, count_ - 1)]; }
    void wait_until(Instant /*t*/) noexcept TACT_RT override {}
    // Every look was taken, and no other.
    [[nodiscard]] bool used_up() const noexcept { return at_ == count_; }

private:
    std::array<Instant, CycleTopic::kTimestampsMax> looks_{};
    std::size_t at_ = 0, count_ = 1;
};

// Where a replay first went another way.
struct ReplayDifference {
    std::uint64_t step = 0, cycle = 0;
    std::uint32_t hand = 0;
    std::string what;  // "force sent to the device"
    double recorded[3]{}, replayed[3]{};
};

struct ReplayResult {
    std::uint64_t steps = 0;           // compared, dry ones too
    std::uint64_t different = 0;       // of them
    std::uint64_t removed_levels = 0;  // of bone
    double force_n_most = 0.0;         // sent to the first hand: a replay of nothing compares well too
    std::optional<ReplayDifference> first;
};

struct ReplaySettings {
    std::filesystem::path recording;
    std::filesystem::path scene;  // empty: the one that the recording names
};

class Replay {
public:
    explicit Replay(const ReplaySettings& settings);
    ~Replay();
    Replay(const Replay&) = delete;
    Replay& operator=(const Replay&) = delete;

    // Why it cannot be exact; empty: it can.
    [[nodiscard]] const std::string& obstacle() const { return obstacle_; }
    [[nodiscard]] const RecordingReader& recording() const { return reader_; }
    // The step that do_step() would do; null: there is none any more.
    [[nodiscard]] const RecordedStep* upcoming() const { return has_step_ ? &step_ : nullptr; }
    void do_step();
    // Before the first step: added to every instant.
    void shift_by(Duration shift) { shift_ = shift; }
    [[nodiscard]] const ReplayResult& result() const { return result_; }
    [[nodiscard]] const Servo& servo() const { return *servo_; }
    [[nodiscard]] OwnedRegion<RtRegion>& region() { return region_; }
    [[nodiscard]] int shared_fd() const { return system_->fd(); }  // of the system's own region; -1: none

private:
    void build_models();
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
