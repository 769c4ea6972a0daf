// Draws the traces: one lane per unit over a common time axis, with a min-max band per pixel column so that no spike
// is lost, and single cycles if only few are visible.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>

#include "gui/dashboard/panels.hpp"
#include "gui/dashboard/plot.hpp"
#include "gui/dashboard/traces.hpp"
#include "gui/dashboard/widgets.hpp"

namespace tact {
namespace {

constexpr std::array<ImU32, 5> kTraceColours{colour::kAccent, colour::kOrange, colour::kGreen, colour::kPink,
                                             colour::kSecondHand};

struct Lane {
    const char* unit = "";
    std::array<TraceChannel, kTraceChannels> channel{};
    std::size_t channels = 0;
};

std::size_t lanes_of(const TracesState& t, std::array<Lane, kTraceChannels>& lanes) {
    std::size_t count = 0;
    for (std::size_t i = 0; i < kTraceChannels; ++i) {
        if (!t.channels.test(i)) continue;
        const char* const unit = trace_channel(static_cast<TraceChannel>(i)).unit;
        std::size_t at = 0;
        while (at < count && std::strcmp(lanes[at].unit, unit) != 0) ++at;
        if (at == count) lanes[count++].unit = unit;
        lanes[at].channel[lanes[at].channels++] = static_cast<TraceChannel>(i);
    }
    return count;
}

struct LanePen {
    const Theme& theme;
    ImDrawList* draw;
    const TraceScope& scope;
    const TraceStore& store;
    float x0, x1;          // of the time axis
    float y0 = 0, y1 = 0;  // of the lane
    Axis axis{};
    std::size_t first = 0, last = 0;  // visible cycles

    [[nodiscard]] float line() const { return theme.small->FontSize; }
    [[nodiscard]] float x(std::int64_t ns) const {
        const double u = static_cast<double>(ns - scope.begin_ns()) /
                         static_cast<double>(scope.end_ns() - scope.begin_ns());
        return x0 + static_cast<float>(std::clamp(u, -1.0, 2.0)) * (x1 - x0);
    }
    [[nodiscard]] float y(double v) const {
        const double u = (v - axis.low) / (axis.high - axis.low);
        return y1 - static_cast<float>(std::clamp(u, -1.0, 2.0)) * (y1 - y0);
    }
    [[nodiscard]] float width(const std::string& text) const {
        return theme.small->CalcTextSizeA(line(), 1e9F, 0.0F, text.c_str()).x;
    }
    void label(ImVec2 at, ImU32 c, const std::string& text) const {
        draw->AddText(theme.small, line(), at, c, text.c_str());
    }
};

void draw_channel(const LanePen& pen, TraceChannel channel, ImU32 c) {
    const double scale = trace_channel(channel).scale;
    static thread_local std::vector<ImVec2> points;
    points.clear();
    const auto flush = [&] {
        if (points.size() == 1) pen.draw->AddCircleFilled(points[0], pen.theme.px(1.5F), c, 8);
        pen.draw->AddPolyline(points.data(), static_cast<int>(points.size()), c, 0, pen.theme.px(1.3F));
        points.clear();
    };
    const auto columns = static_cast<std::size_t>(std::max(pen.x1 - pen.x0, 1.0F));
    // One cycle beyond each end, so that lines reach the border.
    const std::size_t first = pen.first > 0 ? pen.first - 1 : 0,
                      last = std::min(pen.last + 1, pen.store.size());
    if (last - first <= 2 * columns) {
        const bool dots = (last - first) * 8 < columns;
        for (std::size_t i = first; i < last; ++i) {
            const auto v = static_cast<double>(trace_value(pen.store.at(i), channel));
            if (pen.store.gap_before(i) || std::isnan(v)) flush();
            if (std::isnan(v)) continue;
            points.push_back({pen.x(pen.store.at(i).taken_at_ns), pen.y(scale * v)});
            if (dots) pen.draw->AddCircleFilled(points.back(), pen.theme.px(2.0F), c, 8);
        }
        return flush();
    }
    const double step_ns =
        static_cast<double>(pen.scope.end_ns() - pen.scope.begin_ns()) / static_cast<double>(columns);
    std::size_t from = pen.first;
    float before_low = 0.0F, before_high = 0.0F;
    bool before = false;
    for (std::size_t i = 0; i < columns && from < pen.last; ++i) {
        const auto until_ns =
            pen.scope.begin_ns() + static_cast<std::int64_t>(static_cast<double>(i + 1) * step_ns);
        const std::size_t to = std::min(pen.store.find(until_ns), pen.last);
        const TraceExtremes e = pen.store.extremes(channel, from, to);
        from = std::max(from, to);
        if (!e.any) {
            before = false;
            continue;
        }
        float top = pen.y(scale * static_cast<double>(e.high)),
              bottom = pen.y(scale * static_cast<double>(e.low));
        const float x = pen.x0 + static_cast<float>(i);
        const float own_top = top, own_bottom = bottom;
        if (before) {  // joined to the previous pixel
            top = std::min(top, before_low);
            bottom = std::max(bottom, before_high);
        }
        pen.draw->AddRectFilled({x, top}, {x + 1.0F, std::max(bottom, top + pen.theme.px(1.3F))}, c);
        before_low = own_bottom;
        before_high = own_top;
        before = true;
    }
}

// Range of the visible values; around the middle if they are constant.
Axis lane_axis(const LanePen& pen, const Lane& lane) {
    double low = 1e300, high = -1e300;
    for (std::size_t k = 0; k < lane.channels; ++k) {
        const TraceExtremes e = pen.store.extremes(lane.channel[k], pen.first, pen.last);
        if (!e.any) continue;
        const double scale = trace_channel(lane.channel[k]).scale;
        low = std::min(low, scale * static_cast<double>(e.low));
        high = std::max(high, scale * static_cast<double>(e.high));
    }
    if (low > high) low = 0.0, high = 1.0;
    return range_axis(low, high, std::max(2, static_cast<int>((pen.y1 - pen.y0) / pen.theme.px(26.0F))));
}

std::string lane_text(const LanePen& pen, TraceChannel channel) {
    const TraceChannelInfo& info = trace_channel(channel);
    const auto at = [&](std::int64_t ns) {
        const std::size_t i = std::min(pen.store.find(ns), pen.store.size() - 1);
        return info.scale * static_cast<double>(trace_value(pen.store.at(i), channel));
    };
    if (pen.store.empty()) return info.name;
    if (!pen.scope.cursors) return std::string(info.name) + " " + format("%.4g", at(pen.scope.end_ns()));
    const double a = at(pen.scope.cursor_ns(0)), b = at(pen.scope.cursor_ns(1));
    return std::string(info.name) + format(" A %.4g  B %.4g  B - A %.4g", a, b, b - a);
}

void draw_lane(LanePen& pen, const Lane& lane, const TriggerSettings* trigger, float legend_x1) {
    pen.axis = lane_axis(pen, lane);
    float last_label = 1e9F;
    for (const double v : pen.axis.mark) {
        const float y = std::round(pen.y(v));
        pen.draw->AddRectFilled({pen.x0, y}, {pen.x1, y + 1.0F}, colour::kGrid);
        if (last_label - y < 1.05F * pen.line()) continue;
        last_label = y;
        const std::string text = format("%g", std::fabs(v) < 1e-12 ? 0.0 : v);
        pen.label({pen.x0 - pen.theme.px(4.0F) - pen.width(text), y - 0.55F * pen.line()}, colour::kDim,
                  text);
    }
    pen.draw->PushClipRect({pen.x0, pen.y0 - 1.0F}, {pen.x1, pen.y1 + 1.0F}, true);
    for (std::size_t k = 0; k < lane.channels; ++k)
        draw_channel(pen, lane.channel[k], kTraceColours[k % kTraceColours.size()]);
    if (trigger != nullptr) {
        const double level = trigger->level * trace_channel(trigger->channel).scale;
        const float y = pen.y(level);
        for (float x = pen.x0; x < pen.x1; x += pen.theme.px(8.0F))
            pen.draw->AddRectFilled({x, y}, {x + pen.theme.px(3.0F), y + 1.0F}, colour::kWatch);
    }
    pen.draw->PopClipRect();
    // The labels lie over the top of the lane; a dark background keeps them readable.
    float x = pen.x0 + pen.theme.px(4.0F);
    const float y = pen.y0 - 1.05F * pen.line();
    pen.label({x, y}, colour::kText, "[" + std::string(lane.unit) + "]");
    x += pen.width("[" + std::string(lane.unit) + "]") + pen.theme.px(10.0F);
    for (std::size_t k = 0; k < lane.channels; ++k) {
        const std::string words = lane_text(pen, lane.channel[k]);
        if (x + pen.width(words) > legend_x1) break;
        pen.draw->AddRectFilled({x, y + 0.47F * pen.line()},
                                {x + pen.theme.px(8.0F), y + 0.47F * pen.line() + pen.theme.px(3.0F)},
                                kTraceColours[k % kTraceColours.size()]);
        x += pen.theme.px(11.0F);
        pen.label({x, y}, colour::kDim, words);
        x += pen.width(words) + pen.theme.px(12.0F);
    }
}

void mouse(TracesState& t, float x0, float x1) {
    TraceScope& scope = t.scope;
    const ImGuiIO& io = ImGui::GetIO();
    const double share =
        std::clamp(static_cast<double>((io.MousePos.x - x0) / std::max(x1 - x0, 1.0F)), 0.0, 1.0);
    if (ImGui::IsItemHovered() && io.MouseWheel != 0.0F) {
        const auto about = scope.begin_ns() + static_cast<std::int64_t>(1e9 * share * scope.span_s());
        scope.zoom(std::pow(0.8, static_cast<double>(io.MouseWheel)), about);
    }
    if (ImGui::IsItemActivated()) {
        t.dragged = -1;
        for (int which = 0; which < 2; ++which) {
            const float x =
                x0 + static_cast<float>(scope.cursor[static_cast<std::size_t>(which)]) * (x1 - x0);
            if (scope.cursors && std::fabs(io.MousePos.x - x) < 8.0F) t.dragged = which;
        }
    }
    if (!ImGui::IsItemActive()) return;
    if (t.dragged >= 0) {
        scope.cursor[static_cast<std::size_t>(t.dragged)] = share;
    } else if (io.MouseDelta.x != 0.0F) {
        scope.pan(-static_cast<double>(io.MouseDelta.x / std::max(x1 - x0, 1.0F)) * scope.span_s());
    }
}

void time_marks(const LanePen& pen, float below) {
    // Round times, relative to the right end or to the trigger.
    const double span_s = pen.scope.span_s();
    const std::int64_t zero = pen.scope.triggered_ns() != 0 ? pen.scope.triggered_ns() : pen.scope.end_ns();
    const Axis marks =
        linear_axis(span_s, std::max(2, static_cast<int>((pen.x1 - pen.x0) / pen.theme.px(90.0F))));
    const double step_s = marks.mark.size() > 1 ? marks.mark[1] : span_s;
    const double from_s = 1e-9 * static_cast<double>(pen.scope.begin_ns() - zero), to_s = from_s + span_s;
    for (double s = std::ceil(from_s / step_s - 1e-6) * step_s; s <= to_s + 1e-9 * span_s; s += step_s) {
        const float x = std::round(pen.x(zero + static_cast<std::int64_t>(1e9 * s)));
        if (x < pen.x0 - 1.0F || x > pen.x1 + 1.0F) continue;
        pen.draw->AddRectFilled({x, pen.y0}, {x + 1.0F, below}, colour::kGrid);
        const std::string text = std::fabs(s) < 1e-9 * span_s ? "0" : duration_text(s);
        pen.label({std::clamp(x - 0.5F * pen.width(text), pen.x0, pen.x1 - pen.width(text)),
                   below + pen.theme.px(1.0F)},
                  colour::kDim, text);
    }
}

}  // namespace

void draw_trace_lanes(const Theme& theme, DashboardState& state, ImVec2 size) {
    TracesState& t = state.traces;
    const ImVec2 at = ImGui::GetCursorScreenPos();
    size = {std::max(size.x, theme.px(60.0F)), std::max(size.y, theme.px(40.0F))};
    ImGui::InvisibleButton("##lanes", size);
    const float gutter = theme.px(44.0F);
    mouse(t, at.x + gutter, at.x + size.x - 1.0F);

    std::array<Lane, kTraceChannels> lanes{};
    const std::size_t count = lanes_of(t, lanes);
    const TraceScope& scope = t.scope;
    LanePen pen{theme, ImGui::GetWindowDrawList(), scope, scope.shown(), at.x + gutter, at.x + size.x - 1.0F};
    if (count == 0 || pen.store.empty()) {
        pen.label({at.x + gutter, at.y + 0.5F * size.y}, colour::kDim,
                  count == 0 ? "no channel selected" : "no cycle yet");
        return;
    }
    pen.first = pen.store.find(scope.begin_ns());
    pen.last = std::min(pen.store.find(scope.end_ns() + 1), pen.store.size());
    const float foot = at.y + size.y - 1.2F * pen.line(), each = (foot - at.y) / static_cast<float>(count);
    pen.y0 = at.y;
    time_marks(pen, foot);
    for (std::size_t i = 0; i < count; ++i) {
        pen.y0 = at.y + static_cast<float>(i) * each + 1.15F * pen.line();
        pen.y1 = at.y + static_cast<float>(i + 1) * each - theme.px(3.0F);
        const TriggerSettings& s = scope.trigger();
        const bool of_lane = scope.run() != TraceRun::roll && s.source == TriggerSource::channel &&
                             std::strcmp(trace_channel(s.channel).unit, lanes[i].unit) == 0;
        draw_lane(pen, lanes[i], of_lane ? &s : nullptr, pen.x1);
    }
    const auto upright = [&](float x, ImU32 c, const char* name) {
        pen.draw->AddRectFilled({x, at.y}, {x + theme.px(1.0F), foot}, c);
        pen.draw->AddText(theme.small, pen.line(), {x + theme.px(3.0F), foot - 1.1F * pen.line()}, c, name);
    };
    if (scope.triggered_ns() >= scope.begin_ns() && scope.triggered_ns() <= scope.end_ns() &&
        scope.triggered_ns() != 0)
        upright(pen.x(scope.triggered_ns()), colour::kWatch, "T");
    if (scope.cursors) {
        upright(pen.x(scope.cursor_ns(0)), colour::kText, "A");
        upright(pen.x(scope.cursor_ns(1)), colour::kText, "B");
    }
}

}  // namespace tact
