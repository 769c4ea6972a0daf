#include "deploy/record/recorder.hpp"

#include <poll.h>
#include <sys/statvfs.h>

#include <algorithm>
#include <cstring>
#include <ctime>

#include "deploy/record/drain.hpp"
#include "ipc/base/error.hpp"
#include "ipc/record/recording_writer.hpp"
#include "ipc/shm/link.hpp"

namespace tact::record {
namespace {

// A loop that runs freely fills its rings in a fifth of a second: the rows go out in portions that take a part of that.
constexpr std::size_t kFlushRows = 8192;

std::int64_t utc_ns() {
    timespec ts{};
    clock_gettime(CLOCK_REALTIME, &ts);
    return std::int64_t{ts.tv_sec} * 1'000'000'000 + ts.tv_nsec;
}

void sleep_for(Duration d) {
    ::poll(nullptr, 0, static_cast<int>(std::chrono::duration_cast<std::chrono::milliseconds>(d).count()));
}

// A controller's region; stays mapped after it ended.
class Watched {
public:
    explicit Watched(const std::string& session) : link_(session, -1) {}

    // True: there is one, and its loop has begun.
    bool look() {
        LinkClient::News news = link_.poll();
        if (region_.empty() && news.arrived) {
            region_ = MappedRegion<RtRegion>::map(std::move(news.rt_fd), refusal_);
        } else if (!region_.empty() && (news.left || news.arrived)) {
            ended_ = true;  // another one's region is not this recording's
        }
        return !region_.empty() && region_->start.count() > 0;
    }
    [[nodiscard]] bool ended() const { return ended_; }
    [[nodiscard]] const RtRegion& region() const { return *region_; }
    [[nodiscard]] std::uint64_t generation() const { return region_.generation(); }
    [[nodiscard]] std::string waiting_for() const {
        if (!refusal_.empty()) return refusal_;
        return region_.empty() ? link_.status_text() : "waiting for the controller's loop to begin";
    }

private:
    LinkClient link_;
    MappedRegion<RtRegion> region_;
    std::string refusal_;
    bool ended_ = false;
};

RecordingHead head_of(const Watched& watched, const RecorderSettings& settings, const Batch& first) {
    const RtRegion& region = watched.region();
    RecordingHead head;
    static_cast<void>(region.start.read(head.start));
    static_cast<void>(region.levels.read(head.levels));
    head.text = region.run_text;
    head.scene_path.assign(region.scene_path, strnlen(region.scene_path, sizeof region.scene_path));
    head.scene_checksum = region.scene_checksum;
    head.session = settings.session;
    head.program = settings.program;
    head.generation = watched.generation();
    head.first_step = first.cycles.empty() ? 0 : first.cycles.front().step;
    head.created_ns = to_ns(Monotonic::now());
    head.created_utc_ns = utc_ns();
    return head;
}

void add(RecordingWriter& writer, const Batch& batch) {
    for (const auto& row : batch.mail) writer.add(row);
    for (const auto& row : batch.reports) writer.add(row);
    for (std::size_t h = 0; h < kHandsMax; ++h)
        for (const auto& row : batch.hand[h]) writer.add(h, row);
    for (const auto& row : batch.cycles) writer.add(row);
    for (const auto& row : batch.events) writer.add(row);
    for (const auto& row : batch.levels) writer.add(row);
    for (const auto& row : batch.health) writer.add(row);
    for (const auto& row : batch.bodies) writer.add(row);
    for (const auto& row : batch.drops) writer.add(row);
}

bool disk_nearly_full(const std::filesystem::path& file, std::uint64_t least) {
    struct statvfs fs {};
    if (statvfs(file.c_str(), &fs) != 0) return false;
    return std::uint64_t{fs.f_bavail} * fs.f_frsize < least;
}

// Until there is a controller whose loop has begun, and its first steps; false: it was told to stop before.
bool await(Watched& watched, const RecorderSettings& settings,
           const std::function<void(const std::string&)>& say) {
    const Instant begin = Monotonic::now();
    std::string said;
    while (!watched.look() || watched.region().cycles.pushed() == 0) {
        if (settings.stop()) return false;
        if (std::string now = watched.waiting_for(); now != said) say(said = std::move(now));
        if (settings.wait_s > 0.0 && to_s(Monotonic::now() - begin) > settings.wait_s)
            throw StartupError("recording session '" + settings.session + "'", watched.waiting_for(),
                               "start a run in this session, e.g. tact demo dock");
        sleep_for(kTurn);
    }
    return true;
}

}  // namespace

RecorderOutcome record(const RecorderSettings& settings, const std::function<void(const std::string&)>& say,
                       const std::function<void(const RecorderProgress&)>& progress) {
    RecorderOutcome outcome;
    if (std::filesystem::exists(settings.file))
        throw StartupError("recording to '" + settings.file.string() + "'", "the file is there already",
                           "name another one, or remove it");
    Watched watched(settings.session);
    if (!await(watched, settings, say)) return outcome;
    Drain drain(watched.region());
    Batch batch;
    drain.take(batch, to_ns(Monotonic::now()));
    RecordingWriter writer(settings.file, head_of(watched, settings, batch));
    outcome.began = true;
    RecorderProgress& p = outcome.progress;
    p.first_step = batch.cycles.empty() ? 0 : batch.cycles.front().step;
    const Instant begin = Monotonic::now();
    Instant flushed = begin - kFlushEvery;
    try {
        for (bool last = false; !last;) {
            // Looked at before the rings are emptied, so that nothing of a controller that ended stays behind.
            watched.look();
            last = true;
            if (watched.ended())
                outcome.end = RecorderEnd::controller_ended;
            else if (settings.stop())
                outcome.end = RecorderEnd::stopped;
            else if (settings.seconds > 0.0 && to_s(Monotonic::now() - begin) >= settings.seconds)
                outcome.end = RecorderEnd::time_over;
            else if (disk_nearly_full(settings.file, settings.free_bytes_least))
                outcome.end = RecorderEnd::disk_full;
            else
                last = false;
            drain.take(batch, to_ns(Monotonic::now()));
            if (last || batch.cycles.size() >= kFlushRows || Monotonic::now() - flushed >= kFlushEvery) {
                flushed = Monotonic::now();
                add(writer, batch);
                batch.clear();
                writer.flush();
                p.cycles = writer.cycles();
                p.dropped = drain.dropped();
                p.recorded_s = to_s(flushed - begin);
                p.bytes = std::filesystem::file_size(settings.file);
                progress(p);
            }
            if (!last) sleep_for(kTurn);
        }
        writer.close();
    } catch (const RecordError& e) {
        writer.abandon();
        throw StartupError(
            "recording to '" + settings.file.string() + "'", e.what(),
            "make space and record anew; what was written so far opens after tact record --repair");
    }
    return outcome;
}

const char* recorder_end_text(RecorderEnd end) {
    switch (end) {
        case RecorderEnd::controller_ended:
            return "the controller ended";
        case RecorderEnd::stopped:
            return "stopped";
        case RecorderEnd::time_over:
            return "its time was over";
        case RecorderEnd::disk_full:
            return "the disk is nearly full";
    }
    return "unknown";
}

}  // namespace tact::record
