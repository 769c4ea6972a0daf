#include "gui/drilling/strokes.hpp"

namespace tact {

void Strokes::end_at(const Point& to, StrokeMetrics& metrics) const {
    const double length_m = (to.at_m - from_.at_m).norm();
    if (length_m < kLeastM) return;
    ++metrics.count;
    metrics.length_m += length_m;
    metrics.time_s += to.t_s - from_.t_s;
}

void Strokes::step(double t_s, const Vec3& at_m, bool cuts) {
    const Point now{t_s, at_m};
    if (cuts) cut_s_ = t_s;
    if (!under_way_) {
        if (!cuts) return;
        under_way_ = true;
        from_ = farthest_ = now;
        far_m_ = 0.0;
        return;
    }
    const double far_m = (at_m - from_.at_m).norm();
    if (far_m >= far_m_) {
        farthest_ = now;
        far_m_ = far_m;
    }
    const bool pause = t_s - cut_s_ > kPauseS;
    if (!pause && far_m > far_m_ - kBackM) return;
    end_at(farthest_, done_);
    from_ = farthest_;
    farthest_ = now;
    far_m_ = (at_m - from_.at_m).norm();
    under_way_ = !pause;
}

StrokeMetrics Strokes::metrics() const {
    StrokeMetrics all = done_;
    if (under_way_) end_at(farthest_, all);
    return all;
}

}  // namespace tact
