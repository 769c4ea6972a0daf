#include "ipc/record/recording_writer.hpp"

#include <fcntl.h>
#include <sys/file.h>
#include <unistd.h>

#include <algorithm>
#include <cstdio>
#include <cstring>
#include <iterator>

#include "ipc/base/error.hpp"
#include "ipc/record/repair.hpp"
#include "ipc/record/without_folders.hpp"
#include "ipc/topics/text.hpp"

namespace tact {
namespace {

std::string names_of_codes() {
    std::string names;
    for (auto code = EventCode::none; code <= EventCode::device_notice;
         code = static_cast<EventCode>(static_cast<int>(code) + 1))
        names += (names.empty() ? "" : ",") + std::string(event_code_text(code));
    return names;
}

std::string field(const char* text, std::size_t size) {
    std::string s(text, strnlen(text, size));
    std::replace_if(
        s.begin(), s.end(), [](char c) { return c < ' ' || c > '~'; }, '?');
    return s;
}

std::string names_of_paths(const LevelsTopic& levels) {
    std::string names;
    for (std::size_t i = 0; i < std::min<std::size_t>(levels.count, kPathsMax); ++i)
        names += (names.empty() ? "" : ",") + field(levels.path[i].path, kPathNameMax);
    return names;
}

template <class T>
std::span<const char> bytes_of(const T& value) {
    return {reinterpret_cast<const char*>(&value), sizeof value};
}

// A text that is too long is omitted; the size 0 in the file indicates it.
std::span<const char> told(const char* text, std::uint32_t bytes, std::size_t most) {
    return {text, bytes <= most ? bytes : 0};
}

}  // namespace

RecordingWriter::RecordingWriter(const std::filesystem::path& path, const RecordingHead& head)
    : path_(path),
      hands_(std::min<std::uint32_t>(head.start.hands, kHandsMax)),
      T_world_dev_{Vec3(head.start.pos_world_dev_m), Quat(head.start.quat_world_dev_xyzw)} {
    hdf5::quiet();
    // The final name never belongs to a partial file, even if this process is killed.
    const std::filesystem::path making = path.string() + ".making-" + std::to_string(getpid());
    file_ = hdf5::create_file(making);
    try {
        make(head);
        hdf5::start_shared_writing(file_.get());  // releases HDF5's own lock, which would block readers
        lock_ = FileDescriptor(open(making.c_str(), O_RDONLY | O_CLOEXEC));
        if (!lock_.valid() || flock(lock_.get(), LOCK_SH | LOCK_NB) != 0)
            throw RecordError("locking the file: " + last_error());
        hdf5::flush(file_.get());
        if (renameat2(AT_FDCWD, making.c_str(), AT_FDCWD, path.c_str(), RENAME_NOREPLACE) != 0)
            throw RecordError("naming the file: " + last_error());
    } catch (const RecordError& e) {
        std::error_code gone;
        std::filesystem::remove(making, gone);
        throw StartupError("creating the recording '" + path.string() + "'", e.what(),
                           "choose a file on a disk with free space");
    }
}

void RecordingWriter::make(const RecordingHead& head) {
    const Hdf5Id f = file_.get();
    hdf5::put_text(f, "/", "format", kRecordingFormat);
    hdf5::put_number(f, "/", "version", kRecordingVersion);
    hdf5::put_text(f, "/", "program", head.program);
    hdf5::put_text(f, "/", "session", head.session);
    if (!head.cause.empty()) hdf5::put_text(f, "/", "cause", head.cause);
    hdf5::put_text(f, "/", "scene_path", without_folders(head.scene_path));
    hdf5::put_number(f, "/", "scene_checksum", head.scene_checksum);
    hdf5::put_number(f, "/", "generation", head.generation);
    hdf5::put_signed(f, "/", "created_utc_ns", head.created_utc_ns);
    hdf5::put_signed(f, "/", "created_ns", head.created_ns);
    hdf5::put_number(f, "/", "hands", hands_);
    hdf5::put_signed(f, "/", "period_ns", head.start.period_ns);
    hdf5::put_number(f, "/", "first_step", head.first_step);
    hdf5::put_number(f, "/", "dry_steps", head.start.dry_steps);
    const double T_world_dev[7] = {head.start.pos_world_dev_m[0],     head.start.pos_world_dev_m[1],
                                   head.start.pos_world_dev_m[2],     head.start.quat_world_dev_xyzw[0],
                                   head.start.quat_world_dev_xyzw[1], head.start.quat_world_dev_xyzw[2],
                                   head.start.quat_world_dev_xyzw[3]};
    hdf5::put_reals(f, "/", "pose_world_dev", T_world_dev);

    hdf5::make_group(f, "/start");
    hdf5::put_bytes(f, "/start/loop", bytes_of(head.start));
    hdf5::put_number(f, "/start", "loop_version", StartTopic::kInfo.version);
    const RunText& t = head.text;
    const bool known = t.arguments_bytes <= RunText::kArgumentsMax && t.config_bytes <= RunText::kConfigMax &&
                       t.poses_bytes <= RunText::kPosesMax;
    hdf5::put_number(f, "/start", "known", known ? 1 : 0);
    hdf5::put_text(f, "/start", "program", field(t.program, sizeof t.program));
    const std::span<const char> arguments = told(t.arguments, t.arguments_bytes, RunText::kArgumentsMax);
    hdf5::put_bytes(f, "/start/arguments", arguments_without_folders({arguments.data(), arguments.size()}));
    hdf5::put_bytes(f, "/start/config", told(t.config, t.config_bytes, RunText::kConfigMax));
    hdf5::put_bytes(f, "/start/poses", told(t.poses, t.poses_bytes, RunText::kPosesMax));
    for (std::uint32_t i = 0; i < hands_; ++i)
        hdf5::put_text(f, "/start", i == 0 ? "device0" : "device1",
                       field(head.start.device[i].name, sizeof head.start.device[i].name));

    cycles_.table = Hdf5Table::create(f, kCyclesGroup, cycle_columns(), sizeof(CycleTopic));
    for (std::uint32_t i = 0; i < hands_; ++i)
        hand_[i].table = Hdf5Table::create(f, kHandGroups[i], hand_columns(), sizeof(HandRow));
    mailbox_.table = Hdf5Table::create(f, kMailboxGroup, mailbox_columns(), sizeof(MailboxTopic));
    reports_.table = Hdf5Table::create(f, kReportsGroup, report_columns(), sizeof(ReportTopic));
    events_.table = Hdf5Table::create(f, kEventsGroup, event_columns(), sizeof(EventTopic));
    levels_.table = Hdf5Table::create(f, kLevelsGroup, levels_columns(), sizeof(LevelsRow));
    health_.table = Hdf5Table::create(f, kHealthGroup, health_columns(), sizeof(HealthRow));
    bodies_.table = Hdf5Table::create(f, kBodiesGroup, body_columns(), sizeof(BodyRow));
    drops_.table = Hdf5Table::create(f, kDropsGroup, drop_columns(), sizeof(DropRow));
    hdf5::put_text(f, kEventsGroup, "codes", names_of_codes());
    hdf5::put_text(f, kLevelsGroup, "paths", names_of_paths(head.levels));
    hdf5::put_number(f, "/", "end", static_cast<std::uint64_t>(RecordingEnd::open));
}

RecordingWriter::~RecordingWriter() {
    if (!file_.valid()) return;
    try {
        close();
    } catch (const RecordError&) {
        abandon();
    }
}

void RecordingWriter::add(std::size_t hand, const HandTopic& row) {
    HandRow r{};
    r.t = row;
    const Pose tool = T_world_dev_ * Pose{Vec3(row.pos_dev_m), Quat(row.quat_dev_tool_xyzw)};
    std::copy_n(tool.p_m.data(), 3, r.pos_world_m);
    std::copy_n(tool.q.coeffs().data(), 4, r.quat_world_tool_xyzw);
    hand_[hand].kept.push_back(r);
}

void RecordingWriter::add(const LevelsTopic& topic) {
    LevelsRow r{};
    r.taken_at_ns = topic.taken_at_ns;
    r.sequence = topic.sequence;
    r.goal_hz = topic.goal_hz;
    r.rate_hz = topic.rate_hz;
    for (std::size_t i = 0; i < std::min<std::size_t>(topic.count, kPathsMax); ++i)
        r.level[i] = topic.path[i].level;
    levels_.kept.push_back(r);
}

void RecordingWriter::add(const HealthTopic& t) {
    HealthRow r{};
    r.taken_at_ns = t.taken_at_ns;
    r.cycle = t.cycle;
    r.force_rate_hz = t.force_rate_hz;
    r.lateness_p50_ns = t.lateness_p50_ns;
    r.lateness_p99_ns = t.lateness_p99_ns;
    r.lateness_max_ns = t.lateness_max_ns;
    r.cycle_cost_p50_ns = t.cycle_cost_p50_ns;
    r.cycle_cost_max_ns = t.cycle_cost_max_ns;
    r.overruns = t.overruns;
    r.skipped = t.skipped;
    r.allocations = t.allocations;
    r.locks = t.locks;
    r.page_faults = t.page_faults;
    r.bad_input = t.bad_input;
    r.gui_fps = t.gui_fps;
    r.gui_vertices = t.gui_vertices;
    r.state = t.state;
    r.reason = t.reason;
    r.device_state = t.device_state;
    r.gui_attached = t.gui_attached;
    health_.kept.push_back(r);
}

void RecordingWriter::add(const BodiesTopic& topic) {
    for (std::size_t i = 0; i < std::min<std::size_t>(topic.count, kBodiesMax); ++i) {
        const BodyPlace& b = topic.body[i];
        BodyRow r{};
        r.taken_at_ns = topic.taken_at_ns;
        r.cycle = topic.cycle;
        std::copy(std::begin(b.pos_model_m), std::end(b.pos_model_m), r.pos_model_m);
        std::copy(std::begin(b.quat_model_body_xyzw), std::end(b.quat_model_body_xyzw),
                  r.quat_model_body_xyzw);
        r.id = b.id;
        r.structure = b.structure;
        r.flags = b.flags;
        bodies_.kept.push_back(r);
    }
}

void RecordingWriter::flush() {
    // Flushes the inputs of a cycle before the cycle: a replay has all inputs of the last cycle.
    mailbox_.flush();
    reports_.flush();
    for (std::uint32_t i = 0; i < hands_; ++i) hand_[i].flush();
    cycles_.flush();
    events_.flush();
    levels_.flush();
    health_.flush();
    bodies_.flush();
    drops_.flush();
    hdf5::flush(file_.get());
}

void RecordingWriter::close() {
    flush();
    for (Hdf5Table* const t :
         {&cycles_.table, &hand_[0].table, &hand_[1].table, &mailbox_.table, &reports_.table, &events_.table,
          &levels_.table, &health_.table, &bodies_.table, &drops_.table})
        *t = {};
    file_.reset();
    lock_ = {};
    // Attributes cannot change during shared writing; the file is reopened without it.
    Hdf5Handle file = hdf5::open_file(path_, true);
    hdf5::put_number(file.get(), "/", "end", static_cast<std::uint64_t>(RecordingEnd::whole));
}

void RecordingWriter::abandon() noexcept {
    for (Hdf5Table* const t :
         {&cycles_.table, &hand_[0].table, &hand_[1].table, &mailbox_.table, &reports_.table, &events_.table,
          &levels_.table, &health_.table, &bodies_.table, &drops_.table})
        t->release();
    file_.release();
    lock_ = {};
}

}  // namespace tact
