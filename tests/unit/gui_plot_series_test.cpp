// The memory of the plots: bounded, and the extremes survive decimation.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>

#include "gui/dashboard/drawn_texts.hpp"
#include "gui/dashboard/plot.hpp"
#include "gui/dashboard/plot_series.hpp"
#include "gui/dashboard/widgets.hpp"
#include "tests/unit/gui_dashboard_fixture.hpp"

namespace tact::gui_plot_series_test {
namespace {

struct Extremes {
    float low = std::numeric_limits<float>::max(), high = std::numeric_limits<float>::lowest();
};
Extremes of(const std::vector<PlotBin>& bins) {
    Extremes e;
    for (const PlotBin& b : bins) {
        e.low = std::min(e.low, b.low);
        e.high = std::max(e.high, b.high);
    }
    return e;
}

TEST(PlotSeries, every_window_shows_the_extremes_of_its_own_samples) {
    PlotSeries series;
    std::mt19937 random(7);
    std::normal_distribution<float> noise(0.0F, 1.0F);
    std::vector<std::pair<double, float>> all;
    for (int i = 0; i < 400'000; ++i) {
        const double t = 0.1 * i;  // eleven hours at ten a second
        const float v = i == 123'456 ? 1000.0F : noise(random);
        series.add(t, static_cast<double>(v));
        all.emplace_back(t, v);
    }
    std::vector<PlotBin> bins;
    const double now = all.back().first;
    for (const double span : {20.0, 60.0, 600.0, 3600.0, 6.0 * 3600.0, 11.0 * 3600.0}) {
        series.window(now - span, now, bins);
        ASSERT_FALSE(bins.empty());
        EXPECT_LE(bins.size(), PlotSeries::kBins);
        const double width = bins.front().width_s;
        Extremes inside, around;
        for (const auto& [t, v] : all) {
            if (t >= now - span) inside.low = std::min(inside.low, v), inside.high = std::max(inside.high, v);
            if (t >= now - span - width)
                around.low = std::min(around.low, v), around.high = std::max(around.high, v);
        }
        const Extremes shown = of(bins);
        EXPECT_LE(shown.low, inside.low) << span;
        EXPECT_GE(shown.high, inside.high) << span;
        EXPECT_GE(shown.low, around.low) << span;
        EXPECT_LE(shown.high, around.high) << span;
    }
}

TEST(PlotSeries, a_spike_is_found_at_its_time_in_a_window_of_an_hour) {
    PlotSeries series;
    for (int i = 0; i < 36'000; ++i) series.add(0.1 * i, i == 20'000 ? 5.0 : 1.0);
    std::vector<PlotBin> bins;
    series.window(0.0, 3600.0, bins);
    int found = 0;
    for (const PlotBin& b : bins)
        if (b.high == 5.0F) {
            ++found;
            EXPECT_LE(b.t_s, 2000.0);
            EXPECT_GT(b.t_s + b.width_s, 2000.0);
        }
    EXPECT_EQ(found, 1);
}

TEST(PlotSeries, bins_come_in_order_and_do_not_overlap) {
    PlotSeries series;
    for (int i = 0; i < 50'000; ++i) series.add(0.016 * i, std::sin(0.01 * i));
    std::vector<PlotBin> bins;
    series.window(100.0, 700.0, bins);
    ASSERT_GT(bins.size(), 100U);
    for (std::size_t i = 1; i < bins.size(); ++i)
        EXPECT_GE(bins[i].t_s, bins[i - 1].t_s + bins[i - 1].width_s - 1e-9);
}

TEST(PlotSeries, memory_does_not_grow) {
    PlotSeries series;
    const std::size_t before = series.memory_bytes();
    for (int i = 0; i < 100'000; ++i) series.add(i, i);
    EXPECT_EQ(series.memory_bytes(), before);
    EXPECT_LT(before, 128U * 1024U);
}

TEST(PlotSeries, non_finite_values_and_decreasing_times_are_dropped) {
    PlotSeries series;
    series.add(1.0, std::nan(""));
    series.add(1.0, std::numeric_limits<double>::infinity());
    series.add(1.0, 1e300);  // beyond the range of float
    series.add(std::nan(""), 1.0);
    series.add(-5.0, 1.0);
    EXPECT_TRUE(series.empty());
    series.add(10.0, 2.0);
    series.add(9.0, 77.0);
    std::vector<PlotBin> bins;
    series.window(0.0, 20.0, bins);
    ASSERT_EQ(bins.size(), 1U);
    EXPECT_EQ(bins[0].high, 2.0F);
    series.window(20.0, 0.0, bins);
    EXPECT_TRUE(bins.empty());
}

TEST(PlotAxis, linear_axis_covers_the_value_with_round_marks) {
    for (const double high : {0.003, 0.9, 1.0, 1.05, 7.3, 20.0, 999.0, 123456.0}) {
        const Axis axis = linear_axis(high, 4);
        EXPECT_GE(axis.high, high * (1.0 - 1e-9));
        EXPECT_LE(axis.high, 2.6 * high);
        EXPECT_GE(axis.mark.size(), 2U);
        EXPECT_LE(axis.mark.size(), 6U);
        EXPECT_EQ(axis.mark.front(), 0.0);
        EXPECT_NEAR(axis.mark.back(), axis.high, 1e-9 * axis.high);
    }
    EXPECT_EQ(linear_axis(std::nan(""), 4).high, 1.0);
}

TEST(PlotAxis, one_slow_frame_does_not_stretch_the_axis) {
    std::vector<float> ms(300, 16.0F);
    EXPECT_EQ(axis_top(ms), 16.0);
    ms[7] = 1500.0F;
    EXPECT_EQ(axis_top(ms), 16.0);
    for (std::size_t i = 0; i < 30; ++i) ms[i] = 1500.0F;  // not one, but a tenth of all
    EXPECT_EQ(axis_top(ms), 1500.0);
    std::vector<float> near(300, 16.0F);
    near[7] = 22.0F;  // shown as it is
    EXPECT_EQ(axis_top(near), 22.0);
    std::vector<float> few{16.0F, 1500.0F, 16.0F};
    EXPECT_EQ(axis_top(few), 1500.0);
    few.clear();
    EXPECT_EQ(axis_top(few), 0.0);
}

TEST(Plot, a_slow_frame_is_marked_and_written_and_the_axis_stays_readable) {
    test::TestDashboard d(1280.0F, 720.0F, 1.0F);
    History& h = d.state.history;
    for (int i = 0; i < 600; ++i) h.frame_s.add(0.1 * i, i == 300 ? 1.5 : 0.016);
    h.now_s = 60.0;
    const auto shown = [&](const std::string& text) {
        const auto texts = drawn_texts(*ImGui::GetDrawData());
        return std::any_of(texts.begin(), texts.end(), [&](const DrawnText& t) { return t.text == text; });
    };
    d.frame();
    EXPECT_TRUE(shown("max 1500 ms"));
    EXPECT_TRUE(shown("20"));
    EXPECT_FALSE(shown("1500"));  // a mark of the axis
    h.now_s = 100.0;              // the slow frame has left the minute
    for (int i = 600; i < 1000; ++i) h.frame_s.add(0.1 * i, 0.016);
    d.frame();
    EXPECT_FALSE(shown("max 1500 ms"));
    EXPECT_TRUE(shown("20"));
}

TEST(PlotAxis, log_axis_spans_whole_decades) {
    const Axis axis = log_axis(2.7, 180.0);
    EXPECT_DOUBLE_EQ(axis.low, 1.0);
    EXPECT_DOUBLE_EQ(axis.high, 1000.0);
    EXPECT_EQ(axis.mark.size(), 4U);
    EXPECT_GT(log_axis(0.0, 0.0).high, log_axis(0.0, 0.0).low);
}

TEST(Numbers, that_round_to_zero_have_no_sign) {
    EXPECT_EQ(fixed(-0.004, 2), "0.00");
    EXPECT_EQ(fixed(-0.0, 4), "0.0000");
    EXPECT_EQ(fixed(-0.4, 0), "0");
    EXPECT_EQ(fixed(-0.006, 2), "-0.01");
    EXPECT_EQ(fixed(-10.0, 2), "-10.00");
    EXPECT_EQ(fixed(2.0, 2), "2.00");
}

}  // namespace
}  // namespace tact::gui_plot_series_test
