#include "rt/replay/replay_player.hpp"

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <utility>

#include "ipc/base/error.hpp"
#include "rt/replay/recorded_marks.hpp"

namespace tact {
namespace {

using std::chrono::milliseconds;

constexpr auto kSlice = milliseconds(20);  // of computing, between looks at the window
constexpr auto kServeEvery = milliseconds(10);
constexpr double kMostS = 1e9;
constexpr std::int64_t kMostNs = 4'000'000'000'000'000'000;
constexpr auto kAttachWithin = milliseconds(5000);  // of a window, to the replay after a way back

}  // namespace

ReplayPlayer::ReplayPlayer(Settings settings, std::unique_ptr<Replay> first)
    : settings_(std::move(settings)), shown_(std::move(first)), speed_(settings_.speed) {
    RecordingReader reader(settings_.replay.recording);
    std::vector<EventTopic> events;
    for (const EventTopic* e = reader.events().peek(); e != nullptr; e = reader.events().peek()) {
        events.push_back(*e);
        reader.events().next();
    }
    marks_ = marks_of(events, reader.about().begin_ns);
}

bool ReplayPlayer::differed() const { return differed_ || shown_->result().different > 0; }

double ReplayPlayer::time_s(const RecordedStep& step) const {
    return seconds_since(shown_->recording().about().begin_ns, step.cycle.now_ns);
}

void ReplayPlayer::run(const std::function<bool()>& stopped) {
    open();
    while (!attached_ && !stopped() &&
           Monotonic::now() - opened_ < Duration(std::llround(1e9 * settings_.wait_s)))
        attend(20);
    if (!attached_ && !stopped())
        throw StartupError("showing a replay in session '" + settings_.session + "'", "no window attached",
                           "start one with tact replay --show, or tact-gui --session " + settings_.session);
    began_ = true;
    shift_ = Monotonic::now() -
             instant_from_ns(std::clamp<std::int64_t>(shown_->recording().about().begin_ns, 0, kMostNs));
    shown_->shift_by(shift_);
    const RecordingReader::About& about = shown_->recording().about();
    const double length_s = std::clamp(seconds_since(about.begin_ns, about.end_ns), 0.0, kMostS);
    seek({settings_.from_s < 0.0 ? std::max(length_s + settings_.from_s, 0.0) : settings_.from_s, 0});
    while (!stopped()) {
        const bool waits = act_ == ReplayAct::paused || act_ == ReplayAct::ended;
        if (waits || Monotonic::now() - served_ > kServeEvery) attend(waits ? 10 : 0);
        if (closed_ || (!attached_ && Monotonic::now() - opened_ > kAttachWithin)) break;
        follow_window();
        if (act_ == ReplayAct::seeking)
            seek_on();
        else if (act_ == ReplayAct::playing)
            play_on();
        publish();
    }
}

void ReplayPlayer::open() {
    link_.reset();  // one server at a time has the session
    window_ = {};
    attached_ = false;
    OwnedRegion<RtRegion>& region = shown_->region();
    region->replay_marks.publish(marks_);
    published_ = {};
    publish();
    link_ = std::make_unique<LinkServer>(settings_.session, region.fd(), shown_->shared_fd());
    opened_ = Monotonic::now();
}

void ReplayPlayer::attend(int timeout_ms) {
    LinkServer::News news = link_->poll(timeout_ms);
    if (news.gui_arrived) {
        std::string refusal;
        window_ = MappedRegion<GuiRegion>::map(std::move(news.gui_fd), refusal);
        timelines_seen_ = 0;
        // What the window requested of another replay is over.
        if (TimelineTopic t{}; !began_ && !window_.empty() && window_->timeline.read(t, &timelines_seen_))
            seeks_wanted_ = seeks_done_ = t.seeks, runs_ = t.runs;
        attached_ = true;
        closed_ = false;
    }
    if (news.gui_left) {
        attached_ = false;
        closed_ = true;
    }
    served_ = Monotonic::now();
}

void ReplayPlayer::follow_window() {
    if (window_.empty()) return;
    TimelineTopic t{};
    std::uint64_t number = 0;
    if (window_->timeline.count() == timelines_seen_ || !window_->timeline.read(t, &number)) return;
    timelines_seen_ = number;
    if (!sensible(t)) return;
    const bool play = t.playing != 0 && t.runs == runs_;
    if (play != play_ || t.speed != speed_) {
        play_ = play;
        speed_ = t.speed;
        anchor();
        if (act_ == ReplayAct::paused && play_) act_ = ReplayAct::playing;
        if (act_ == ReplayAct::playing && !play_) act_ = ReplayAct::paused;
    }
    if (t.runs != runs_) {
        runs_ = t.runs;
        published_ = {};
    }
    if (t.seeks != seeks_wanted_) {
        seeks_wanted_ = t.seeks;
        seek({t.seek_s, t.seek_step});
    }
}

void ReplayPlayer::anchor() {
    anchor_s_ = at_s_;
    anchored_at_ = Monotonic::now();
}

void ReplayPlayer::seek(const Place& place) {
    place_ = place;
    const auto passed = [&](const Replay& replay, double at_s) {
        const std::uint64_t steps = replay.result().steps;
        return steps > 0 && (place_.step > 0 ? steps > place_.step : at_s > place_.at_s);
    };
    if (!passed(*shown_, at_s_)) {
        fresh_.reset();
    } else if (!fresh_ || passed(*fresh_, place_at_s_)) {
        fresh_ = std::make_unique<Replay>(settings_.replay);
        fresh_->shift_by(shift_);
        place_at_s_ = 0.0;
    }
    act_ = ReplayAct::seeking;
}

bool ReplayPlayer::reached(const Replay& replay) const {
    if (replay.upcoming() == nullptr) return true;
    if (place_.step > 0) return replay.result().steps >= place_.step;
    return replay.started() && time_s(*replay.upcoming()) > place_.at_s;
}

void ReplayPlayer::seek_on() {
    const Instant until = Monotonic::now() + kSlice;
    Replay& replay = fresh_ ? *fresh_ : *shown_;
    while (!reached(replay) && Monotonic::now() < until)
        fresh_ ? compute(replay, place_at_s_, place_ns_) : compute(replay, at_s_, shown_ns_);
    if (reached(replay)) found();
}

void ReplayPlayer::compute(Replay& replay, double& at_s, std::int64_t& at_ns) {
    at_s = time_s(*replay.upcoming());
    at_ns = std::clamp<std::int64_t>(replay.upcoming()->cycle.now_ns, 0, kMostNs) + shift_.count();
    replay.do_step();
}

void ReplayPlayer::found() {
    seeks_done_ = seeks_wanted_;
    const bool at_end = (fresh_ ? *fresh_ : *shown_).upcoming() == nullptr;
    act_ = at_end ? ReplayAct::ended : play_ ? ReplayAct::playing : ReplayAct::paused;
    if (fresh_) {
        differed_ = differed_ || shown_->result().different > 0;
        at_s_ = place_at_s_;
        shown_ns_ = place_ns_;
        link_.reset();  // before the region that it serves
        shown_ = std::move(fresh_);
        open();
    }
    anchor();
    published_ = {};
}

void ReplayPlayer::play_on() {
    const Instant begin = Monotonic::now();
    const double due_s = anchor_s_ + speed_ * to_s(begin - anchored_at_);
    while (const RecordedStep* const next = shown_->upcoming()) {
        if (time_s(*next) > due_s) {
            attend(1);
            return;
        }
        compute(*shown_, at_s_, shown_ns_);
        // This machine is slower than the speed: it plays as fast as it can.
        if (Monotonic::now() - begin > kSlice) return anchor();
    }
    act_ = ReplayAct::ended;
    published_ = {};
}

void ReplayPlayer::publish() {
    const Instant now = Monotonic::now();
    if (now - published_ < kServeEvery) return;
    published_ = now;
    const RecordingReader::About& about = shown_->recording().about();
    ReplayTopic t{};
    t.taken_at_ns = to_ns(now);
    // Numbers that the window accepts, whatever the recording holds: without this topic it would show a live run.
    t.shown_ns = std::clamp<std::int64_t>(shown_ns_, 0, kMostNs);
    t.at_s = std::clamp(at_s_, 0.0, kMostS);
    t.duration_s = std::clamp(seconds_since(about.begin_ns, about.end_ns), 0.0, kMostS);
    t.speed = speed_;
    t.step = shown_->result().steps;
    t.steps = about.cycles;
    t.seeks = seeks_done_;
    t.act = static_cast<std::uint8_t>(act_);
    t.exact = !differed() && shown_->obstacle().empty() ? 1 : 0;
    t.can_run = settings_.can_run ? 1 : 0;
    t.runs = runs_;
    t.plays = play_ ? 1 : 0;
    t.whole = about.first_step == 1 ? 1 : 0;
    t.seek_share = 1.0;
    if (act_ == ReplayAct::seeking) {
        const double place = place_.step > 0 ? static_cast<double>(place_.step) : place_.at_s;
        const double done = place_.step > 0 ? static_cast<double>((fresh_ ? *fresh_ : *shown_).result().steps)
                            : fresh_        ? place_at_s_
                                            : at_s_;
        t.seek_share = place > 0.0 ? std::clamp(done / place, 0.0, 1.0) : 0.0;
    }
    std::snprintf(t.name, sizeof t.name, "%s", settings_.replay.recording.filename().c_str());
    shown_->region()->replay.publish(t);
}

}  // namespace tact
