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

constexpr const char* kSuffix[] = {"", "-overrun", "-mark", "-fault"};  // by FlightCause

std::string name_of_now(FlightCause cause) {
    timespec ts{};
    clock_gettime(CLOCK_REALTIME, &ts);
    tm utc{};
    gmtime_r(&ts.tv_sec, &utc);
    char text[80];
    std::snprintf(text, sizeof text, "%s%04d%02d%02dT%02d%02d%02d.%03ldZ%s.h5", kPrefix, utc.tm_year + 1900,
                  utc.tm_mon + 1, utc.tm_mday, utc.tm_hour, utc.tm_min, utc.tm_sec, ts.tv_nsec / 1'000'000,
                  kSuffix[static_cast<std::size_t>(cause)]);
    return text;
}

// None: another file. Recordings from before 2026-11-28 name no cause.
std::optional<FlightCause> cause_of_name(const std::string& name) {
    constexpr std::size_t kStem = 27;  // flight-YYYYMMDDTHHMMSS.mmmZ
    constexpr std::string_view kEnding = ".h5";
    if (name.size() < kStem + kEnding.size() || name.rfind(kPrefix, 0) != 0 || name[kStem - 1] != 'Z' ||
        name.substr(name.size() - kEnding.size()) != kEnding)
        return std::nullopt;
    const std::string suffix = name.substr(kStem, name.size() - kStem - kEnding.size());
    for (std::size_t i = 0; i < std::size(kSuffix); ++i)
        if (suffix == kSuffix[i]) return static_cast<FlightCause>(i);
    return std::nullopt;
}

void remove_old(const std::filesystem::path& folder, std::size_t files_max) {
    std::vector<std::string> names;
    for (const auto& entry : std::filesystem::directory_iterator(folder))
        names.push_back(entry.path().filename().string());
    for (const std::string& name : surplus_flights(std::move(names), files_max))
        std::filesystem::remove(folder / name);
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
            if (settings_.save()) want({FlightCause::request, "requested"}, now);
            if (last || now - turned >= kBatch) {
                turned = now;
                want(reason_in(batch), now);
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
        FlightReason reason;
        Instant at;
    };

    // A more important reason takes over a file that is still to be written.
    void want(const FlightReason& reason, Instant now) {
        if (reason.cause == FlightCause::none || (request_ && request_->reason.cause >= reason.cause)) return;
        if (reason.cause == FlightCause::overrun && saved_at_ &&
            now - *saved_at_ < std::max(settings_.length, kOverrunEvery))
            return;
        request_ = {reason, now + settings_.after};
    }

    void save(Instant now) {
        const Request request = *request_;
        request_.reset();
        saved_at_ = now;
        const std::filesystem::path path = settings_.folder / name_of_now(request.reason.cause);
        try {
            if (disk_nearly_full(settings_.folder, kFreeBytesLeast + tape_.bytes()))
                throw StartupError("writing '" + path.string() + "'", "the disk is nearly full",
                                   "free disk space");
            write(path, request.reason.text);
            remove_old(settings_.folder, settings_.files_max);
            ++outcome_.files;
            char seconds[32];
            std::snprintf(seconds, sizeof seconds, "%.1f s", tape_.length_s());
            say_("saved the last " + std::string(seconds) + " to " + path.string() + ": " +
                 request.reason.text);
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

FlightReason reason_in(const Batch& batch) {
    FlightReason found;
    const auto take = [&](FlightCause cause, const std::string& text) {
        if (cause > found.cause) found = {cause, text};
    };
    for (const EventTopic& e : batch.events) {
        const auto code = static_cast<EventCode>(e.code);
        if (code == EventCode::fault_latched)
            take(FlightCause::fault, event_text(e));
        else if (code == EventCode::command_done && e.a == static_cast<double>(CommandKind::mark))
            take(FlightCause::request, command_kind_text(CommandKind::mark));
        else if (code == EventCode::overrun)
            take(FlightCause::overrun, event_text(e));
    }
    return found;
}

// Names contain the time, so they sort by time.
std::vector<std::string> surplus_flights(std::vector<std::string> names, std::size_t files_max) {
    std::vector<std::pair<FlightCause, std::string>> mine;
    for (std::string& name : names)
        if (const auto cause = cause_of_name(name)) mine.emplace_back(*cause, std::move(name));
    std::sort(mine.begin(), mine.end());
    std::vector<std::string> surplus;
    for (std::size_t i = 0; i + files_max < mine.size(); ++i) surplus.push_back(mine[i].second);
    return surplus;
}

FlightOutcome fly(const FlightSettings& settings, const std::function<void(const std::string&)>& say) {
    return Flight(settings, say).go();
}

}  // namespace tact::record
