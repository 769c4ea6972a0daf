#include "gui/stereo/rest_window.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>

namespace tact {

void RestWindow::start(double now_s) {
    samples_.clear();
    state_ = State::moving;
    started_s_ = heard_s_ = now_s;
    spread_m_ = 0.0;
    silent_ = false;
}

double RestWindow::progress() const {
    if (state_ == State::done) return 1.0;
    if (state_ != State::resting || samples_.empty()) return 0.0;
    return std::clamp((samples_.back().at_s - samples_.front().at_s) / kWindowS, 0.0, 1.0);
}

void RestWindow::add(double now_s, std::int64_t taken_at_ns, const Vec3& at_m, bool good) {
    if (!measuring()) return;
    if (good && at_m.allFinite() && taken_at_ns != newest_ns_) {
        newest_ns_ = taken_at_ns;
        heard_s_ = now_s;
        samples_.push_back({now_s, at_m});
        if (samples_.size() > kSamplesMax) samples_.pop_front();
    }
    silent_ = now_s - heard_s_ > kSilentS;
    if (silent_) samples_.clear();  // earlier samples may be of another place
    if (now_s - started_s_ > kPatienceS) {
        state_ = State::failed;
        return;
    }
    // A sample older than the window shows that it is full; at low frame rates the window is longer.
    while (samples_.size() > kSamplesMin && now_s - samples_[1].at_s >= kWindowS) samples_.pop_front();
    state_ = State::moving;
    if (samples_.empty()) return;
    // Means of the earlier and the later half: if they differ, the hand still arrives, or sinks.
    Vec3 half_m[2] = {Vec3::Zero(), Vec3::Zero()};
    const std::size_t early = samples_.size() / 2;
    for (std::size_t i = 0; i < samples_.size(); ++i) half_m[i < early ? 0 : 1] += samples_[i].at_m;
    mean_m_ = (half_m[0] + half_m[1]) / static_cast<double>(samples_.size());
    double sum = 0.0, farthest_m = 0.0;
    for (const Sample& s : samples_) {
        sum += (s.at_m - mean_m_).squaredNorm();
        farthest_m = std::max(farthest_m, (s.at_m - mean_m_).norm());
    }
    spread_m_ = std::sqrt(sum / static_cast<double>(samples_.size()));
    if (early > 0)
        drift_m_ = (half_m[1] / static_cast<double>(samples_.size() - early) -
                    half_m[0] / static_cast<double>(early))
                       .norm();
    if (spread_m_ > spread_m_max_ || farthest_m > kFarthest * spread_m_max_ ||
        drift_m_ > kDriftShare * spread_m_max_)
        return;
    state_ = State::resting;
    if (samples_.size() >= kSamplesMin && now_s - samples_.front().at_s >= kWindowS) state_ = State::done;
}

std::string RestWindow::text(const std::string& what) const {
    char text[160];
    switch (state_) {
        case State::idle:
            return {};
        case State::failed:
            if (silent_)
                std::snprintf(text, sizeof text,
                              "Not measured: no data from %s. Check that it is in range and visible.",
                              what.c_str());
            else
                std::snprintf(text, sizeof text,
                              "Not measured: %s did not rest for a second within %.0f s (spread %.1f mm, "
                              "%.1f allowed).",
                              what.c_str(), kPatienceS, 1e3 * spread_m_, 1e3 * spread_m_max_);
            return text;
        case State::moving:
            if (silent_) return what + " is lost: waiting for it";
            std::snprintf(text, sizeof text, "hold %s still: moves by %.1f mm, %.1f allowed", what.c_str(),
                          1e3 * std::max(spread_m_, drift_m_), 1e3 * spread_m_max_);
            return text;
        case State::resting:
        case State::done:
            std::snprintf(text, sizeof text, "measuring %s: %.0f %%, spread %.1f mm", what.c_str(),
                          100.0 * progress(), 1e3 * spread_m_);
            return text;
    }
    return {};
}

}  // namespace tact
