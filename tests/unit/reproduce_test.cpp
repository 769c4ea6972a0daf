// The evaluation of a run's samples: means are cycles over time, and the worst second is found.
#include "tests/reproduce/law_pairs.hpp"
#include "tests/reproduce/mesh_error.hpp"
#include "tests/reproduce/mesh_picture.hpp"
#include "tests/reproduce/own_session.hpp"
#include "tests/reproduce/rate_rows.hpp"
#include "tests/reproduce/sample_meshes.hpp"
#include "tests/reproduce/summary.hpp"
#include "tests/reproduce/surface_rows.hpp"

#include <gtest/gtest.h>
#include <sys/resource.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>

#include "deploy/tact/files.hpp"

namespace tact::launch::reproduce_test {
namespace {

// Ten samples per second: `slow` cycles per sample within [slow_from_s, slow_to_s), else `fast`.
std::vector<RateSample> samples(double seconds, std::uint64_t fast, std::uint64_t slow, double slow_from_s,
                                double slow_to_s) {
    std::vector<RateSample> all;
    RateSample s;
    for (int i = 0; i <= static_cast<int>(std::lround(seconds * 10.0)); ++i) {
        s.t_s = i * 0.1;
        s.vertices = i % 2 == 0 ? 1000 : 3000;
        s.fps = 20.0;
        s.level_force = i == 7 ? 0.5 : 1.0;
        all.push_back(s);
        s.cycle += s.t_s >= slow_from_s - 1e-9 && s.t_s < slow_to_s - 1e-9 ? slow : fast;
    }
    return all;
}

TEST(GovernorSummary, the_mean_rate_is_cycles_over_time_and_not_the_mean_of_rates) {
    auto some = samples(10.0, 100, 100, 0, 0);
    some.erase(some.begin() + 20, some.begin() + 60);  // a delayed launcher takes fewer samples
    const RateSummary r = summarize(some, 0.0, 10.0);
    EXPECT_DOUBLE_EQ(r.rate_mean_hz, 1000.0);
    EXPECT_DOUBLE_EQ(r.seconds, 10.0);
    EXPECT_DOUBLE_EQ(r.fps_mean, 20.0);
    EXPECT_DOUBLE_EQ(r.level_force_min, 0.5);
}

TEST(GovernorSummary, hunting_is_the_deviation_of_the_vertices_and_the_number_of_changes_of_the_level) {
    auto some = samples(10.0, 100, 100, 0, 0);  // 1000 and 3000 vertices by turns
    EXPECT_NEAR(summarize(some, 0.0, 10.0).vertices_mean, 2000.0, 10.0);
    EXPECT_NEAR(summarize(some, 0.0, 10.0).vertices_sd, 1000.0, 1.0);
    EXPECT_NEAR(summarize(some, 0.0, 10.0).pixels_mean, 1.0, 1e-9);
    for (std::size_t i = 0; i < some.size(); ++i) some[i].pixels = i % 2 == 0 ? 0.5 : 1.0;
    EXPECT_NEAR(summarize(some, 0.0, 10.0).pixels_mean, 0.75, 0.01);
    EXPECT_EQ(summarize(some, 0.0, 10.0).level_changes, 0);
    for (std::size_t i = 0; i < some.size(); ++i) {
        some[i].vertices = 2000;
        // A slow drift of 5 % counts in steps of a little more than 1 %; to and fro within 1 % does not count.
        some[i].level_mesh = i < 50 ? 0.5 + 0.0005 * static_cast<double>(i) : i % 2 == 0 ? 0.522 : 0.524;
    }
    EXPECT_NEAR(summarize(some, 0.0, 10.0).vertices_sd, 0.0, 1e-6);
    EXPECT_EQ(summarize(some, 0.0, 10.0).level_changes, 4);
}

TEST(GovernorSummary, the_worst_second_is_found_wherever_it_lies) {
    const RateSummary r = summarize(samples(10.0, 100, 40, 6.3, 7.3), 0.0, 10.0);
    EXPECT_NEAR(r.rate_worst_1s_hz, 400.0, 1e-6);
    EXPECT_NEAR(r.rate_mean_hz, (90 * 100 + 10 * 40) / 10.0, 1e-6);
}

TEST(GovernorSummary, half_a_slow_second_counts_half) {
    EXPECT_NEAR(summarize(samples(10.0, 100, 40, 2.0, 2.5), 0.0, 10.0).rate_worst_1s_hz, 700.0, 1e-6);
}

TEST(GovernorSummary, a_window_of_a_tenth_of_a_second_begins_between_two_samples) {
    std::vector<RateSample> some;
    for (int i = 0; i <= 100; ++i)  // every 30 ms, 1000 Hz; half of it from 1.5 s on
        some.push_back(
            {.t_s = 0.03 * i, .cycle = static_cast<std::uint64_t>(i <= 50 ? 30 * i : 1500 + 15 * (i - 50))});
    for (const RateWindow100& w : windows(some, 0.0, 3.0)) {
        if (w.t_s <= 1.5) {
            EXPECT_NEAR(w.rate_hz, 1000.0, 1e-6) << w.t_s;
        }
        if (w.t_s >= 1.6) {
            EXPECT_NEAR(w.rate_hz, 500.0, 1e-6) << w.t_s;
        }
    }
    EXPECT_NEAR(summarize(some, 0.0, 3.0).rate_worst_100ms_hz, 500.0, 1e-6);
    EXPECT_NEAR(settling_s(some, 0.0, 3.0, 500.0), 0.12, 1e-9);
    EXPECT_LT(settling_s(some, 1.6, 3.0, 1000.0), 0.0);
}

TEST(GovernorSummary, windows_with_other_programs_or_a_slower_core_count_as_disturbed) {
    std::vector<RateSample> some;
    RateSample s;
    for (int i = 0; i <= 1000; ++i) {
        s.t_s = 0.01 * i;
        some.push_back(s);
        const bool stranger = i >= 200 && i < 210, slower = i >= 600 && i < 620;
        s.cycle += stranger || slower ? 5 : 10;
        s.used_s[0] += stranger ? 0.005 : 0.01;  // the core is never idle
    }
    const RateSummary r = summarize(some, 0.0, 10.0, 1000.0);
    EXPECT_NEAR(r.rate_worst_100ms_hz, 500.0, 1e-6);
    EXPECT_GT(r.rate_worst_quiet_hz, 950.0);
    EXPECT_GT(r.disturbed_percent, 2.0);
    EXPECT_LT(r.disturbed_percent, 8.0);
    EXPECT_NEAR(r.foreign_share, 0.005, 1e-9);
}

// Slow most of the time: only another run gives the reference.
TEST(GovernorSummary, a_run_on_a_slow_core_is_compared_with_the_fast_time_of_all_runs) {
    std::vector<RateSample> slow, fast;
    RateSample s;
    for (int i = 0; i <= 200; ++i) {
        s.t_s = 0.01 * i;
        slow.push_back(s);
        s.cycle += i < 60 ? 10 : 7;  // of a core that is never idle
        s.used_s[0] += 0.01;
    }
    for (int i = 0; i <= 200; ++i) {
        fast.push_back({.t_s = 0.01 * i, .cycle = static_cast<std::uint64_t>(10 * i), .used_s = {0.01 * i}});
    }
    const double fast_s = fast_update_s(windows(fast, 0.0, 2.0));
    EXPECT_NEAR(fast_s, 1e-3, 1e-9);
    EXPECT_EQ(fast_update_s({}), 0.0);
    const RateSummary r = summarize(slow, 0.0, 2.0, 1000.0, fast_s);
    EXPECT_GT(r.disturbed_percent, 70.0);
    EXPECT_GT(r.rate_worst_quiet_hz, 940.0);
    EXPECT_EQ(summarize(fast, 0.0, 2.0, 1000.0, fast_s).disturbed_percent, 0.0);
}

// Older sums replace half of each update: nearly twice the rate on a core of the same speed.
TEST(GovernorSummary, an_update_with_a_part_of_its_work_counts_as_that_part) {
    std::vector<RateSample> some;
    RateSample s;
    const double half = kFixedPart + 0.5 * (1.0 - kFixedPart);
    for (int i = 0; i <= 100; ++i) {
        s.t_s = 0.1 * i;
        some.push_back(s);
        s.cycle += 200;
        s.given_up += 100.0;
        s.used_s[0] += 200 * 0.5e-3 * half;
    }
    for (const RateWindow100& w : windows(some, 0.0, 10.0)) {
        EXPECT_NEAR(w.recomputed_fraction, 0.5, 1e-9);
        EXPECT_NEAR(w.update_s, 0.5e-3, 1e-9);
    }
    EXPECT_NEAR(summarize(some, 0.0, 10.0).recomputed_fraction_mean, 0.5, 1e-9);
    EXPECT_NEAR(summarize(some, 0.0, 10.0).recomputed_fraction_least, 0.5, 1e-9);
}

// A run with a goal of 1000 Hz, sampled every 5 ms: slow while it starts, a dip of one window before 4.21 s, and with the load
// from 8 s on a dip to 69.8 % right at its beginning and one to 81 % later. The core is never idle.
std::vector<RateSample> run_with_dips() {
    std::vector<RateSample> all;
    RateSample s;
    double cycles = 0.0;
    for (int i = 0; i <= 3200; ++i) {
        s.t_s = 0.005 * i;
        s.load = i >= 1600;
        s.cycle = static_cast<std::uint64_t>(std::lround(cycles));
        all.push_back(s);
        double rate_hz = 1000.0;
        if (i < 100) rate_hz = 300.0;
        if (i >= 822 && i < 842) rate_hz = 960.0;
        if (i >= 1604 && i < 1624) rate_hz = 698.0;
        if (i >= 2400 && i < 2420) rate_hz = 810.0;
        cycles += 0.005 * rate_hz;
        s.used_s[0] += 5e-6 * rate_hz;  // an update costs a millisecond
        s.used_s[1] += 0.005 - 5e-6 * rate_hz;
    }
    return all;
}

TEST(RateRows, the_worst_window_of_each_part_is_that_of_the_plotted_data) {
    const auto samples = run_with_dips();
    const auto rows = rate_rows(samples, 2.0);
    const WorstWindow free = worst_window(rows, RunPart::no_load), loaded = worst_window(rows, RunPart::load),
                      start = worst_window(rows, RunPart::start);
    EXPECT_NEAR(free.rate_hz, 960.0, 11.0);  // a sample counts whole cycles
    EXPECT_NEAR(free.t_s, 4.21, 0.02);
    EXPECT_NEAR(loaded.rate_hz, 698.0, 11.0);
    EXPECT_NEAR(loaded.t_s, 8.12, 0.02);
    EXPECT_NEAR(start.rate_hz, 300.0, 11.0);
    // What the summary said before: the worst of what followed two seconds of settling.
    EXPECT_GT(summarize(samples, 10.0, 16.0, 1000.0).rate_worst_100ms_hz, 780.0);
    // By brute force over the rows, as a reader of rates.csv finds it.
    double lowest = 1e9;
    for (const RateRow& r : rows)
        if (r.sample.load) lowest = std::min(lowest, r.window.rate_hz);
    EXPECT_EQ(loaded.rate_hz, lowest);
}

TEST(RateRows, every_window_is_a_row_and_no_dip_is_lost_between_two_rows) {
    // A pause of 100 ms whose window ends at one sample alone: rows every 20 ms would show half of it.
    std::vector<RateSample> samples;
    RateSample s;
    for (int i = 0; i <= 1000; ++i) {
        s.t_s = 0.005 * i;
        samples.push_back(s);
        if (i < 501 || i >= 521) s.cycle += 5;
    }
    const auto rows = rate_rows(samples, 0.5);
    EXPECT_EQ(rows.size(), samples.size() - 20U);
    EXPECT_NEAR(worst_window(rows, RunPart::no_load).rate_hz, 0.0, 1e-6);
    EXPECT_EQ(rows.front().part, RunPart::start);
    EXPECT_EQ(worst_window(rows, RunPart::load).t_s, 0.0);  // there was none
}

TEST(RateRows, a_window_that_was_disturbed_counts_as_such_and_reused_work_is_found) {
    auto samples = run_with_dips();
    EXPECT_NEAR(worst_window(rate_rows(samples, 2.0), RunPart::load).quiet_rate_hz, 698.0, 11.0);
    for (std::size_t i = 0; i < samples.size(); ++i) {
        if (i > 1600)
            samples[i].used_s[0] -= i < 1700 ? 0.002 * static_cast<double>(i - 1600) : 0.2;  // others had it
        if (i > 2800) samples[i].given_up = 0.4 * static_cast<double>(samples[i].cycle - samples[2800].cycle);
    }
    const WorstWindow loaded = worst_window(rate_rows(samples, 2.0), RunPart::load);
    EXPECT_NEAR(loaded.rate_hz, 698.0, 11.0);
    EXPECT_NEAR(loaded.quiet_rate_hz, 810.0, 11.0);
    EXPECT_NEAR(loaded.recomputed_fraction_least, 0.6, 0.01);
}

TEST(Summary, is_a_table_of_published_and_measured_numbers) {
    const std::vector<SummaryRow> rows{{"5", "updates/s", "550", "1173", "a faster core"},
                                       {"7", "x", "1", "2", ""}};
    const std::string text = table_of(rows);
    EXPECT_NE(text.find("5    updates/s  550        1173"), std::string::npos) << text;
    EXPECT_NE(text.find("a faster core"), std::string::npos);
    EXPECT_EQ(json_of(rows)[0]["measured"], "1173");
}

TEST(GovernorSummary, only_the_samples_within_the_window_count) {
    const RateSummary r = summarize(samples(10.0, 100, 40, 5.0, 10.0), 0.0, 4.95);
    EXPECT_DOUBLE_EQ(r.rate_mean_hz, 1000.0);
    EXPECT_DOUBLE_EQ(r.rate_worst_1s_hz, 1000.0);
}

TEST(GovernorSummary, no_samples_give_zeros) {
    EXPECT_EQ(summarize({}, 0.0, 10.0).seconds, 0.0);
    EXPECT_EQ(summarize(samples(1.0, 100, 100, 0, 0), 5.0, 6.0).rate_mean_hz, 0.0);
}

// --- meshes ---

TriangleMesh square(double height) {
    TriangleMesh m;
    const auto z = static_cast<float>(height);
    m.position_m = {0, 0, z, 1, 0, z, 1, 1, z, 0, 1, z};
    m.triangle = {0, 1, 2, 0, 2, 3};
    return m;
}

// Differences 1, 2, 3, 6 by hand: mean 3, sum of squares 4 + 1 + 0 + 9 = 14, standard error sqrt(14 / 3 / 4). The drift of the
// machine from pair to pair does not enter.
TEST(LawPairs, a_difference_is_that_within_pairs_and_its_error_ignores_what_both_runs_share) {
    const PairedMean m = paired_mean({{11, 10}, {102, 100}, {1003, 1000}, {10006, 10000}});
    EXPECT_DOUBLE_EQ(m.first, (11.0 + 102.0 + 1003.0 + 10006.0) / 4.0);
    EXPECT_DOUBLE_EQ(m.second, (10.0 + 100.0 + 1000.0 + 10000.0) / 4.0);
    EXPECT_NEAR(m.difference, 3.0, 1e-9);
    EXPECT_NEAR(m.difference_error, std::sqrt(14.0 / 3.0 / 4.0), 1e-9);
    EXPECT_EQ(paired_mean({{2, 1}}).difference_error, 0.0);
}

TEST(LawPairs,
     each_column_of_both_laws_is_a_row_and_a_run_without_undisturbed_windows_is_left_out_of_that_one) {
    const auto run = [](const char* law, double rate_hz, double quiet_hz, int changes) {
        launch::Run r{.name = law, .law = law, .goal_hz = 1000.0};
        r.loaded.rate_mean_hz = rate_hz;
        r.loaded.level_changes = changes;
        r.worst_loaded.quiet_rate_hz = quiet_hz;
        return r;
    };
    const std::vector<LawPair> pairs{{run("elastic", 1001, 980, 0), run("sensitus", 999, 970, 30)},
                                     {run("elastic", 1003, 0, 2), run("sensitus", 999, 960, 30)}};
    const std::vector<SummaryRow> rows = summary_of(pairs);
    const auto measured = [&rows](const std::string& quantity) {
        for (const SummaryRow& r : rows)
            if (r.quantity.find(quantity) != std::string::npos) return r.measured;
        return std::string("no row");
    };
    EXPECT_EQ(measured("mean rate"), "elastic 100.20, sensitus 99.90: difference +0.30 +- 0.10 in 2 pairs");
    EXPECT_EQ(measured("worst undisturbed"), "fewer than two pairs have it");
    EXPECT_EQ(measured("changes of the level"),
              "elastic 1.0, sensitus 30.0: difference -29.0 +- 1.0 in 2 pairs");
    EXPECT_TRUE(summary_of(std::vector<LawPair>{pairs[0]}).empty());
}

TEST(Meshes, the_error_is_the_distance_of_the_surfaces_and_of_their_borders) {
    const MeshError same = mesh_error(square(0.0), square(0.0));
    EXPECT_EQ(same.max_m, 0.0);
    EXPECT_NEAR(same.diagonal_m, std::sqrt(2.0), 1e-6);
    const MeshError apart = mesh_error(square(0.0), square(0.25));
    EXPECT_NEAR(apart.rms_m, 0.25, 1e-6);
    EXPECT_NEAR(apart.max_m, 0.25, 1e-6);
    EXPECT_NEAR(apart.border_max_m, 0.25, 1e-6);
    TriangleMesh half = square(0.0);
    half.triangle.resize(3);  // without the corner (0, 1)
    const MeshError cut = mesh_error(square(0.0), half);
    EXPECT_NEAR(cut.max_m, std::sqrt(0.5), 1e-6);
    EXPECT_NEAR(cut.border_max_m, std::sqrt(0.5), 1e-6);
}

TEST(Meshes, the_sample_meshes_have_the_published_sizes_one_open_one_closed) {
    const TriangleMesh sheet = open_sheet();
    EXPECT_EQ(sheet.vertices(), 1250U);
    const TriangleMesh closed = chaperonin(2000);
    EXPECT_GE(closed.vertices(), 2000U);
    EXPECT_LT(closed.vertices(), 2400U);
    std::map<std::pair<std::uint32_t, std::uint32_t>, int> edges;
    for (std::size_t t = 0; t < closed.triangle.size(); t += 3)
        for (std::size_t i = 0; i < 3; ++i) {
            const std::uint32_t a = closed.triangle[t + i], b = closed.triangle[t + (i + 1) % 3];
            ++edges[{std::min(a, b), std::max(a, b)}];
        }
    for (const auto& [edge, n] : edges) ASSERT_EQ(n, 2);
}

TEST(Meshes, the_image_shows_front_back_and_white_background) {
    const TriangleMesh mesh = square(0.0);
    const auto middle = [&](const Vec3& eye) {
        const MeshImage i = draw_mesh(mesh, mesh, eye, false, 40, 40);
        EXPECT_EQ(i.rgb[0], 255);  // a corner of the image
        const std::size_t at = 3 * std::size_t{20 * 40 + 20};
        return std::array<int, 3>{i.rgb[at], i.rgb[at + 1], i.rgb[at + 2]};
    };
    const auto front = middle({0.3, -0.4, 1.0}), back = middle({0.3, -0.4, -1.0});
    EXPECT_GT(front[2], front[0]);
    EXPECT_GT(back[0], back[2]);
}

std::vector<TouchStep> steps_of(std::size_t count, double us, std::size_t slow, double slow_us) {
    std::vector<TouchStep> steps(count, {.force_n = Vec3::UnitX(), .us = 2.0 * us, .best_us = us});
    for (std::size_t i = 0; i < slow; ++i) steps[i].best_us = slow_us;
    return steps;
}

TEST(TouchRow, a_rate_is_one_over_the_mean_time_and_quality_follows_its_rule) {
    TouchRow row = row_of(steps_of(4000, 400.0, 0, 0.0));
    EXPECT_NEAR(row.rate_hz, 2500.0, 1e-6);
    EXPECT_EQ(quality(row), "good");
    EXPECT_EQ(quality(row_of(steps_of(4000, 400.0, 4, 1500.0))), "good");  // one in a thousand
    EXPECT_EQ(quality(row_of(steps_of(4000, 400.0, 5, 1500.0))), "bad");
    EXPECT_EQ(quality(row_of(steps_of(4000, 1001.0, 0, 0.0))), "breaks");
    row.jammed = 5;
    EXPECT_EQ(quality(row), "bad");
}

TEST(TouchRow, a_proxy_stuck_for_five_cycles_is_jammed_from_the_first_one) {
    std::vector<TouchStep> steps = steps_of(100, 1.0, 0, 0.0);
    for (std::size_t i = 10; i < 14; ++i) steps[i].stands = true;
    EXPECT_EQ(jammed_cycles(steps), 0U);
    for (std::size_t i = 14; i < 17; ++i) steps[i].stands = true;
    EXPECT_EQ(jammed_cycles(steps), 7U);
}

// Programs of nice -20 stall each other for a quarter of a second.
TEST(OwnSession, the_session_has_the_priority_and_its_programs_are_ordinary_within_it) {
    constexpr int kSkipped = 77;
    const int before = getpriority(PRIO_PROCESS, 0);
    const int code = in_own_session([before](Precedence reached) {
        const int now = getpriority(PRIO_PROCESS, 0);
        if (reached == Precedence::none) return kSkipped;
        if (reached == Precedence::programs) return now == -5 ? 0 : 1;
        const bool raised = read_small("/proc/self/autogroup").find("nice -20") != std::string::npos;
        return raised && now == before ? 0 : 1;
    });
    if (code == kSkipped) GTEST_SKIP() << "no right to raise a priority";
    EXPECT_EQ(code, 0);
}

}  // namespace
}  // namespace tact::launch::reproduce_test
