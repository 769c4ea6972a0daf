#include "ipc/recorder/flight.hpp"

#include <algorithm>
#include <cstdio>
#include <ctime>
#include <vector>

#include "ipc/base/error.hpp"
#include "ipc/recorder/watched.hpp"
#include "ipc/topics/text.hpp"

namespace tact::record {
namespace {

constexpr Duration kBatch = std::chrono::milliseconds(250);
constexpr std::uint64_t kFreeBytesLeast = std::uint64_t{64} << 20U;
constexpr const char* kPrefix = "flight-";

std::string name_of_now() {
    timespec ts{};
    clock_gettime(CLOCK_REALTIME, &ts);
    tm utc{};
    gmtime_r(&ts.tv_sec, &utc);
    char text[64];
    std::snprintf(text, sizeof text, "%s%04d%02d%02dT%02d%02d%02d.%03ldZ.h5", kPrefix, utc.tm_year + 1900,
                  utc.tm_mon + 1, utc.tm_mday, utc.tm_hour, utc.tm_min, utc.tm_sec, ts.tv_nsec / 1'000'000);
    return text;
}

// Names contain the time and have the same length, so they sort by time.
void remove_old(const std::filesystem::path& folder, std::size_t files_max) {
    std::vector<std::filesystem::path> mine;
    for (const auto& entry : std::filesystem::directory_iterator(folder)) {
        const std::string name = entry.path().filename().string();
        if (name.size() == name_of_now().size() && name.rfind(kPrefix, 0) == 0 &&
            entry.path().extension() == ".h5")
            mine.push_back(entry.path());
    }
    std::sort(mine.begin(), mine.end());
    for (std::size_t i = 0; i + files_max < mine.size(); ++i) std::filesystem::remove(mine[i]);
}

class Flight {
public:
    Flight(const FlightSettings& settings, const std::function<void(const std::string&)>& say)
        : settings_(settings),
          say_(say),
          watched_(settings.session, LinkRole::flight),
          tape_(settings.length, settings.bytes_max) {
        std::error_code error;
        std::filesystem::create_directories(settings.folder, error);
        if (!std::filesystem::is_directory(settings.folder))
            throw StartupError("keeping flight recordings in '" + settings.folder.string() + "'",
                               error ? error.message() : "this is not a folder", "choose a writable folder");
    }

    FlightOutcome go() {
        if (!await(watched_, {settings_.session, settings_.wait_s, settings_.stop}, say_)) return outcome_;
        outcome_.began = true;
        Drain drain(watched_.region());
        const Instant begin = Monotonic::now();
        // Earlier records in the rings go onto the tape, but do not trigger a file.
        Batch batch;
        drain.take(batch, to_ns(begin));
        tape_.add(std::move(batch));
        batch = {};
        Instant turned = begin;
        for (bool last = false; !last;) {
            watched_.look();
            last = watched_.ended() || settings_.stop() ||
                   (settings_.seconds > 0.0 && to_s(Monotonic::now() - begin) >= settings_.seconds);
            const Instant now = Monotonic::now();
            drain.take(batch, to_ns(now));
            if (settings_.save()) want("requested", now);
            if (last || now - turned >= kBatch) {
                turned = now;
                if (const std::string cause = cause_in(batch); !cause.empty()) want(cause, now);
                tape_.add(std::move(batch));
                batch = {};
                if (request_ && (last || now >= request_->at)) save(now);
            }
            if (!last) sleep_a_turn();
        }
        outcome_.dropped = drain.dropped();
        return outcome_;
    }

private:
    struct Request {
        std::string cause;
        Instant at;
    };

    // A person's request is always accepted.
    void want(const std::string& cause, Instant now) {
        if (request_) return;
        const bool person = cause == "requested" || cause == command_kind_text(CommandKind::mark);
        if (!person && saved_at_ && now - *saved_at_ < settings_.length) return;
        request_ = {cause, now + settings_.after};
    }

    void save(Instant now) {
        const Request request = *request_;
        request_.reset();
        saved_at_ = now;
        const std::filesystem::path path = settings_.folder / name_of_now();
        try {
            if (disk_nearly_full(settings_.folder, kFreeBytesLeast + tape_.bytes()))
                throw StartupError("writing '" + path.string() + "'", "the disk is nearly full",
                                   "free disk space");
            write(path, request.cause);
            remove_old(settings_.folder, settings_.files_max);
            ++outcome_.files;
            char seconds[32];
            std::snprintf(seconds, sizeof seconds, "%.1f s", tape_.length_s());
            say_("saved the last " + std::string(seconds) + " to " + path.string() + ": " + request.cause);
        } catch (const std::exception& e) {
            ++outcome_.failed;
            say_(e.what());
        }
    }

    void write(const std::filesystem::path& path, const std::string& cause) {
        RecordingHead head = head_of(watched_, settings_.session, settings_.program, tape_.first_step());
        head.cause = cause;
        RecordingWriter writer(path, head);
        try {
            for (const Batch& batch : tape_.batches()) {
                record::add(writer, batch);
                writer.flush();
            }
            writer.close();
        } catch (const RecordError&) {
            writer.abandon();
            throw;
        }
    }

    const FlightSettings& settings_;
    const std::function<void(const std::string&)>& say_;
    Watched watched_;
    FlightTape tape_;
    FlightOutcome outcome_;
    std::optional<Request> request_;
    std::optional<Instant> saved_at_;
};

}  // namespace

void FlightTape::add(Batch&& batch) {
    if (batch.cycles.empty() && batch.events.empty()) return;
    bytes_ += batch.bytes();
    batches_.push_back(std::move(batch));
    shorten();
}

void FlightTape::shorten() {
    while (batches_.size() > 1 &&
           (bytes_ > bytes_max_ || length_s() - static_cast<double>(kBatch.count()) * 1e-9 > to_s(length_))) {
        bytes_ -= batches_.front().bytes();
        batches_.pop_front();
    }
}

std::uint64_t FlightTape::first_step() const {
    for (const Batch& b : batches_)
        if (!b.cycles.empty()) return b.cycles.front().step;
    return 0;
}

double FlightTape::length_s() const {
    const CycleTopic *first = nullptr, *last = nullptr;
    for (const Batch& b : batches_) {
        if (b.cycles.empty()) continue;
        if (first == nullptr) first = &b.cycles.front();
        last = &b.cycles.back();
    }
    return first == nullptr ? 0.0 : 1e-9 * static_cast<double>(last->now_ns - first->now_ns);
}

std::string cause_in(const Batch& batch) {
    std::string overrun;
    for (const EventTopic& e : batch.events) {
        const auto code = static_cast<EventCode>(e.code);
        if (code == EventCode::fault_latched) return event_text(e);
        if (code == EventCode::command_done && e.a == static_cast<double>(CommandKind::mark))
            return command_kind_text(CommandKind::mark);
        if (code == EventCode::overrun && overrun.empty()) overrun = event_text(e);
    }
    return overrun;
}

FlightOutcome fly(const FlightSettings& settings, const std::function<void(const std::string&)>& say) {
    return Flight(settings, say).go();
}

}  // namespace tact::record
