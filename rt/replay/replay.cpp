// Why the replay is exact: a cycle is a function of its inputs and of the state that earlier cycles left (rt/servo). The
// recording has every input; the same code builds the models from a scene with the same checksum. If a model requested a
// rebuild, it is rebuilt here too and installed in the step in which the servo took it.
#include "rt/replay/replay.hpp"

#include <unistd.h>
#include <CLI/CLI.hpp>
#include <algorithm>
#include <bit>
#include <cstring>
#include <fstream>

#include "ipc/base/error.hpp"
#include "rt/replay/recorded_scene.hpp"

namespace tact {
namespace {

// Temporary copies of the files that the recorded command line names.
class RecordedFiles {
public:
    RecordedFiles() {
        std::string name = (std::filesystem::temp_directory_path() / "tact-replay-XXXXXX").string();
        if (mkdtemp(name.data()) == nullptr)
            throw StartupError("making a folder in '" + std::filesystem::temp_directory_path().string() + "'",
                               last_error(), "free disk space there, or set TMPDIR");
        folder_ = name;
    }
    ~RecordedFiles() {
        std::error_code error;
        std::filesystem::remove_all(folder_, error);
    }
    RecordedFiles(const RecordedFiles&) = delete;
    RecordedFiles& operator=(const RecordedFiles&) = delete;

    std::string put(const char* name, const std::string& content) const {
        const std::filesystem::path path = folder_ / name;
        std::ofstream(path, std::ios::binary) << content;
        return path.string();
    }

private:
    std::filesystem::path folder_;
};

DeviceInfo info_of(const StartDevice& d) {
    DeviceInfo info;
    info.name = d.name;
    info.workspace_half_m = Vec3(d.workspace_half_m);
    info.force_n_max = d.force_n_max;
    info.force_n_continuous = d.force_n_continuous;
    info.torque_n_m_max = d.torque_n_m_max;
    info.stiffness_n_m_max = d.stiffness_n_m_max;
    info.position_step_m = d.position_step_m;
    return info;
}

DeviceSample sample_of(const HandTopic& h, Duration shift) {
    DeviceSample s;
    s.taken_at = instant_from_ns(h.taken_at_ns) + shift;
    s.sequence = h.sequence;
    s.T_dev_tool = {Vec3(h.pos_dev_m), Quat(h.quat_dev_tool_xyzw)};
    s.twist_dev = {Vec3(h.velocity_dev_m_s), Vec3(h.angular_dev_rad_s)};
    s.buttons = h.buttons;
    s.hand_present = h.hand_present != 0;
    s.state = static_cast<DeviceState>(h.device_state);
    s.notice = static_cast<DeviceNotice>(h.notice);
    s.delay = Duration(h.delay_ns);
    return s;
}

LinesSample lines_of(const CycleTopic& c, Duration shift) {
    LinesSample s;
    s.taken_at = instant_from_ns(c.lines_taken_at_ns) + shift;
    s.sequence = c.lines_sequence;
    s.trips = c.lines_trips;
    s.state = static_cast<LinesState>(c.lines_state);
    s.cause = static_cast<LinesCause>(c.lines_cause);
    s.inputs = c.lines_inputs;
    s.outputs = c.lines_outputs;
    return s;
}

bool same_bits(const double (&a)[3], const Vec3& b) {
    for (int i = 0; i < 3; ++i)
        if (std::bit_cast<std::uint64_t>(a[i]) != std::bit_cast<std::uint64_t>(b[i])) return false;
    return true;
}

}  // namespace

void ReplayClock::give(std::span<const std::int64_t> timestamps_ns, Duration shift) noexcept {
    at_ = 0;
    count_ = std::clamp<std::size_t>(timestamps_ns.size(), 1, timestamps_.size());
    for (std::size_t i = 0; i < std::min(timestamps_ns.size(), timestamps_.size()); ++i)
        timestamps_[i] = instant_from_ns(timestamps_ns[i]) + shift;
}

Replay::Replay(const ReplaySettings& settings)
    : reader_(settings.recording),
      scene_(open_recorded_scene(reader_.about(), settings.recording, settings.scene)) {
    const RecordingReader::About& about = reader_.about();
    if (!about.known)
        throw StartupError("replaying '" + settings.recording.string() + "'",
                           "its command line, configuration or start poses were too long to be recorded",
                           "record a run with shorter ones");
    if (about.first_step != 1)
        obstacle_ = "the recording starts in the middle of a run, at step " +
                    std::to_string(about.first_step) +
                    "; the state of the models and of the safety chain at that step is unknown";
    build_models(settings);
    has_step_ = reader_.next(step_);
}

Replay::~Replay() {
    if (!servo_) return;
    // The servo may have swapped models; its current ones are destroyed here.
    for (std::uint32_t i = 0; i < servo_->state().hands; ++i) delete servo_->state().hand[i].model;
}

void Replay::build_models(const ReplaySettings& from) {
    const RecordingReader::About& about = reader_.about();
    StartOverrides overrides;
    {
        CLI::App app;
        describe(app, options_, overrides);
        std::vector<std::string> words(about.arguments.rbegin(), about.arguments.rend());
        try {
            app.parse(words);
        } catch (const CLI::ParseError& e) {
            throw StartupError("reading the recorded command line", e.what(),
                               "replay with the program version named in the recording");
        }
    }
    const RecordedFiles files;
    if (!options_.config.empty()) options_.config = files.put("tact.toml", about.config);
    if (!options_.poses.empty()) options_.poses = files.put("poses.json", about.poses);
    if (!options_.resume.empty())
        options_.resume =
            find_recorded_bone(options_.resume, options_.resume_identity, from.recording, from.bone);
    config_ = configure(options_, overrides);

    std::memset(static_cast<void*>(&*region_), 0, sizeof(RtRegion));
    const std::string path = std::filesystem::absolute(scene_.name()).string();
    std::memcpy(region_->scene_path, path.data(), std::min(path.size(), sizeof region_->scene_path - 1));
    region_->scene_checksum = scene_.checksum();
    region_.mark_ready();
    system_.emplace(SystemInput{scene_, options_, config_, *region_});
    std::unique_ptr<ForceModel> model = system_->make_model(0);
    std::unique_ptr<ForceModel> second;
    if (about.start.hands > 1) second = system_->make_model(1);

    std::vector<HandParts> hands;
    for (std::uint32_t i = 0; i < about.start.hands; ++i) {
        const DeviceInfo info = info_of(about.start.device[i]);
        devices_.push_back(std::make_unique<ReplayDevice>(info));
        hands.push_back({devices_[i].get(), i == 0 ? model.get() : second.get(), info, system_->drive(i)});
    }
    ServoSettings settings = settings_from(config_, (about.start.flags & kStartEmulated) != 0);
    settings.visual_paths = system_->visual_paths();
    servo_.emplace(ServoParts{.clock = clock_,
                              .hands = hands,
                              .region = *region_,
                              .mailbox = mailbox_,
                              .lines = (about.start.flags & kStartLines) != 0 ? &lines_ : nullptr,
                              .script = &script_},
                   settings);
    static_cast<void>(model.release());
    static_cast<void>(second.release());
}

void Replay::build_model_aside() {
    if (!mailbox_.build.take()) {
        if (obstacle_.empty()) obstacle_ = "the recording installs a model that this replay did not request";
        return;
    }
    std::unique_ptr<ForceModel> made = mailbox_.build.like().rebuild(mailbox_.build.bodies());
    if (made == nullptr || !mailbox_.model.offer(made)) mailbox_.build.refuse();
}

void Replay::fill_mailbox() {
    for (const MailboxTopic& m : step_.mailbox) {
        switch (static_cast<MailboxKind>(m.kind)) {
            case MailboxKind::order:
                mailbox_.orders.push(m.order);
                break;
            case MailboxKind::model_taken:
                build_model_aside();
                break;
            case MailboxKind::build_refused:
                if (mailbox_.build.take()) mailbox_.build.refuse();
                break;
            case MailboxKind::stop:
                mailbox_.stop_signal = static_cast<int>(std::clamp(m.order.value, -1.0, 64.0));
                break;
            case MailboxKind::drops:
                mailbox_.pulse.drops = m.order.sequence;
                break;
            case MailboxKind::none:
                break;
        }
    }
    if (!step_.report) return;
    HousekeepingReport said = step_.report->said;
    if (said.gui_heartbeat_ns >= 0) said.gui_heartbeat_ns += shift_.count();
    said.gui_taken_at_ns += shift_.count();
    mailbox_.housekeeping.publish(said);
}

void Replay::give_step() {
    const CycleTopic& c = step_.cycle;
    clock_.give(std::span(c.clock_ns).first(std::min<std::size_t>(c.timestamps, CycleTopic::kTimestampsMax)),
                shift_);
    script_.level = c.level;
    for (std::uint32_t i = 0; i < devices_.size(); ++i) {
        const HandTopic& h = step_.hand[i].t;
        devices_[i]->give(sample_of(h, shift_), static_cast<IoStatus>(h.read_status),
                          static_cast<IoStatus>(h.write_status));
        script_.deadline_check[i] = h.deadline_check;
    }
    lines_.give(lines_of(c, shift_));
    fill_mailbox();
}

void Replay::do_step() {
    if (!has_step_) return;
    const bool dry = (step_.cycle.flags & kCycleDry) != 0;
    if (last_step_ != 0 && step_.cycle.step != last_step_ + 1 && obstacle_.empty())
        obstacle_ = std::to_string(step_.cycle.step - last_step_ - 1) + " steps before step " +
                    std::to_string(step_.cycle.step) + " are lost";
    last_step_ = step_.cycle.step;
    if (!dry && !started_) {
        started_ = true;
        const bool late = reader_.about().first_step != 1;
        servo_->start(late ? instant_from_ns(step_.cycle.now_ns) + shift_
                           : instant_from_ns(reader_.about().start.started_at_ns) + shift_);
        // A recording that starts in the middle of an armed run: arm, so that the force ramps in. Not exact.
        if (late && step_.cycle.run_state >= static_cast<std::uint8_t>(RunState::armed))
            mailbox_.orders.push({.sequence = 0,
                                  .value = 0.0,
                                  .kind = static_cast<std::uint32_t>(CommandKind::arm),
                                  .index = 0});
    }
    give_step();
    if (dry)
        servo_->dry_cycle();
    else
        servo_->cycle();
    mailbox_.model.collect().reset();
    compare();
    has_step_ = reader_.next(step_);
}

void Replay::note(std::uint32_t hand, const char* what, const double (&recorded)[3], const Vec3& replayed) {
    if (same_bits(recorded, replayed)) return;
    different_ = true;
    if (result_.first) return;
    ReplayDifference& d = result_.first.emplace();
    d.step = step_.cycle.step;
    d.cycle = step_.cycle.cycle;
    d.hand = hand;
    d.what = what;
    std::copy_n(recorded, 3, d.recorded);
    std::copy_n(replayed.data(), 3, d.replayed);
}

void Replay::compare() {
    const CycleState& s = servo_->state();
    different_ = false;
    ++result_.steps;
    for (std::uint32_t i = 0; i < s.hands; ++i) {
        const HandTopic& was = step_.hand[i].t;
        const HandCycle& is = s.hand[i];
        note(i, "force of the model", was.force_model_world_n, is.step.wrench_world.force_n);
        note(i, "torque of the model", was.torque_model_world_n_m, is.step.wrench_world.torque_n_m);
        note(i, "force sent to the device", was.force_world_n, is.shown_world.force_n);
        note(i, "torque sent to the device", was.torque_world_n_m, is.shown_world.torque_n_m);
    }
    const double state_was[3] = {static_cast<double>(step_.cycle.run_state),
                                 static_cast<double>(step_.cycle.run_reason),
                                 static_cast<double>(step_.cycle.timestamps)};
    note(0, "state, reason, number of clock readings", state_was,
         Vec3(static_cast<double>(s.run.state), static_cast<double>(s.run.reason),
              static_cast<double>(s.timestamps)));
    if (different_) ++result_.different;
    result_.force_n_most = std::max(result_.force_n_most, s.hand[0].shown_world.force_n.norm());
    DrillTopic drill{};
    if (region_->drill.read(drill)) result_.removed_levels = drill.removed_levels;
}

}  // namespace tact
