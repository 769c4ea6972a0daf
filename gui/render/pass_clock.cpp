#include "gui/render/pass_clock.hpp"

#include <algorithm>
#include <initializer_list>

namespace tact {
namespace {

constexpr std::uint64_t kFirstFinished = 16;  // soon after the start, so that values exist

// After a change of the levels, a frame is measured once the change has settled, and no more often than this.
constexpr std::uint64_t kSettledAfter = 8, kFinishLeastApart = 32;

using Times = std::array<double, kPasses>;

std::size_t at(Pass pass) { return static_cast<std::size_t>(pass); }

std::array<double, kVisualPaths> path_times(const Times& s) {
    const auto sum = [&s](std::initializer_list<Pass> passes) {
        double total_s = 0.0;
        for (const Pass p : passes) total_s += s[at(p)];
        return total_s;
    };
    std::array<double, kVisualPaths> of{};
    const auto path = [&of](VisualPathIndex i) -> double& { return of[static_cast<std::size_t>(i)]; };
    path(VisualPathIndex::mesh) = sum({Pass::adapt, Pass::surface});
    path(VisualPathIndex::volume) = sum({Pass::bone});
    path(VisualPathIndex::particles) = sum({Pass::motion, Pass::particles});
    path(VisualPathIndex::molecules) = sum({Pass::structures});
    path(VisualPathIndex::resolution) = sum({Pass::structures, Pass::bone, Pass::surface, Pass::marks,
                                             Pass::particles, Pass::edges, Pass::enlarge});
    return of;
}

void add_paths(const Times& of_pass_s, std::vector<RecentTimes>& to) {
    const auto of = path_times(of_pass_s);
    for (std::size_t i = 0; i < kVisualPaths; ++i) to[i].add(of[i]);
}

PassMetrics metrics_of(const RecentTimes& work, const RecentTimes& drawn, bool known) {
    PassMetrics f{work.percentile_s(0.5), work.percentile_s(0.99), -1.0F, -1.0F};
    if (known && drawn.size() > 0) {
        f.drawn_p50_s = drawn.percentile_s(0.5);
        f.drawn_p99_s = drawn.percentile_s(0.99);
    }
    return f;
}

}  // namespace

PassClock::Drawn PassClock::possible(bool software) {
    if (software) return Drawn::finished;
    GLint bits = 0;
    glGetQueryiv(GL_TIMESTAMP, GL_QUERY_COUNTER_BITS, &bits);
    return bits > 0 ? Drawn::stamped : Drawn::unknown;
}

PassClock::PassClock(Drawn drawn)
    : how_(drawn),
      work_(kPasses, RecentTimes(kFrames)),
      drawn_(kPasses, RecentTimes(drawn == Drawn::finished ? kFinished : kFrames)),
      path_work_(kVisualPaths, RecentTimes(kFrames)),
      path_drawn_(kVisualPaths, RecentTimes(drawn == Drawn::finished ? kFinished : kFrames)) {
    if (how_ != Drawn::stamped) return;
    for (Stamps& s : in_flight_) glGenQueries(static_cast<GLsizei>(s.query.size()), s.query.data());
    gl_names_held() += static_cast<std::uint32_t>(kFramesInFlight * 2 * kScopesMost);
}

PassClock::~PassClock() {
    if (how_ != Drawn::stamped) return;
    for (Stamps& s : in_flight_) glDeleteQueries(static_cast<GLsizei>(s.query.size()), s.query.data());
    gl_names_held() -= static_cast<std::uint32_t>(kFramesInFlight * 2 * kScopesMost);
}

void PassClock::begin_frame() {
    ++frame_;
    work_s_.fill(0.0);
    drawn_s_.fill(0.0);
    finishing_ = how_ == Drawn::finished && (frame_ % kFinishEvery == kFirstFinished || frame_ == finish_at_);
    if (finishing_) finished_at_ = frame_;
    if (how_ == Drawn::stamped) collect(in_flight_[frame_ % kFramesInFlight]);
}

void PassClock::begin(Pass pass) {
    if (finishing_) glFinish();  // excludes remaining work of other passes
    Stamps& s = in_flight_[frame_ % kFramesInFlight];
    if (how_ == Drawn::stamped && stamps(pass) && s.count < kScopesMost) {
        s.pass[s.count] = pass;
        glQueryCounter(s.query[2 * s.count], GL_TIMESTAMP);
    }
    began_ = Monotonic::now();
}

void PassClock::end(Pass pass) {
    work_s_[at(pass)] += to_s(Monotonic::now() - began_);
    if (finishing_) {
        glFinish();
        drawn_s_[at(pass)] += to_s(Monotonic::now() - began_);
    }
    Stamps& s = in_flight_[frame_ % kFramesInFlight];
    if (how_ == Drawn::stamped && stamps(pass) && s.count < kScopesMost)
        glQueryCounter(s.query[2 * s.count++ + 1], GL_TIMESTAMP);
}

void PassClock::end_frame(bool at_levels) {
    in_flight_[frame_ % kFramesInFlight].at_levels = at_levels;
    if (!at_levels) return;
    for (std::size_t i = 0; i < kPasses; ++i) work_[i].add(work_s_[i]);
    add_paths(work_s_, path_work_);
    if (how_ == Drawn::unknown) newest_path_s_ = path_times(work_s_);
    if (finishing_) add_drawn(drawn_s_);
}

void PassClock::collect(Stamps& s) {
    if (s.count == 0) return;
    GLuint there = GL_FALSE;
    glGetQueryObjectuiv(s.query[2 * s.count - 1], GL_QUERY_RESULT_AVAILABLE, &there);
    if (there == GL_FALSE) {
        ++lost_;
    } else {  // queries complete in order: if the last is available, all are
        Times drawn_s{};
        for (std::size_t i = 0; i < s.count; ++i) {
            GLuint64 from_ns = 0, to_ns = 0;
            glGetQueryObjectui64v(s.query[2 * i], GL_QUERY_RESULT, &from_ns);
            glGetQueryObjectui64v(s.query[2 * i + 1], GL_QUERY_RESULT, &to_ns);
            if (to_ns > from_ns) drawn_s[at(s.pass[i])] += 1e-9 * static_cast<double>(to_ns - from_ns);
        }
        if (s.at_levels) add_drawn(drawn_s);
    }
    s.count = 0;
}

void PassClock::add_drawn(const Times& drawn_s) {
    for (std::size_t i = 0; i < kPasses; ++i) drawn_[i].add(drawn_s[i]);
    add_paths(drawn_s, path_drawn_);
    newest_path_s_ = path_times(drawn_s);
}

void PassClock::measure_next() { finish_at_ = frame_ + 2; }

void PassClock::measure_soon() {
    if (finish_at_ > frame_) return;
    finish_at_ = std::max(frame_ + kSettledAfter, finished_at_ + kFinishLeastApart);
}

void PassClock::fill(FrameMetrics& f) const {
    for (std::size_t i = 0; i < kPasses; ++i) {
        const bool known =
            how_ == Drawn::finished || (how_ == Drawn::stamped && stamps(static_cast<Pass>(i)));
        f.pass[i] = metrics_of(work_[i], drawn_[i], known);
    }
    for (std::size_t i = 0; i < kVisualPaths; ++i)
        f.path[i] = metrics_of(path_work_[i], path_drawn_[i], how_ != Drawn::unknown);
}

}  // namespace tact
