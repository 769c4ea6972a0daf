#include "ipc/recorder/recorder.hpp"

#include "ipc/base/error.hpp"
#include "ipc/recorder/watched.hpp"

namespace tact::record {
namespace {

// A free-running loop fills its rings in a fifth of a second: each portion of rows must take only a part of that.
constexpr std::size_t kFlushRows = 8192;

}  // namespace

RecorderOutcome record(const RecorderSettings& settings, const std::function<void(const std::string&)>& say,
                       const std::function<void(const RecorderProgress&)>& progress) {
    RecorderOutcome outcome;
    if (std::filesystem::exists(settings.file))
        throw StartupError("recording to '" + settings.file.string() + "'", "the file exists already",
                           "choose another file, or remove it");
    Watched watched(settings.session, LinkRole::recorder);
    if (!await(watched, {settings.session, settings.wait_s, settings.stop}, say)) return outcome;
    Drain drain(watched.region());
    Batch batch;
    drain.take(batch, to_ns(Monotonic::now()));
    RecorderProgress& p = outcome.progress;
    p.first_step = batch.cycles.empty() ? 0 : batch.cycles.front().step;
    RecordingWriter writer(settings.file, head_of(watched, settings.session, settings.program, p.first_step));
    outcome.began = true;
    const Instant begin = Monotonic::now();
    Instant flushed = begin - kFlushEvery;
    try {
        for (bool last = false; !last;) {
            // Checked before the rings are emptied, so that all records of an ended controller are written.
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
            if (!last) sleep_a_turn();
        }
        writer.close();
    } catch (const RecordError& e) {
        writer.abandon();
        throw StartupError(
            "recording to '" + settings.file.string() + "'", e.what(),
            "free disk space and record again; tact record --repair recovers the data written so far");
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
            return "the recording length was reached";
        case RecorderEnd::disk_full:
            return "the disk is nearly full";
    }
    return "unknown";
}

}  // namespace tact::record
