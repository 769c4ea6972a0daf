// The metrics for Prometheus: from a region, without one, from a hostile one; over HTTP and as a file.
#include "deploy/tact/metrics.hpp"

#include <gtest/gtest.h>
#include <httplib.h>

#include <cmath>
#include <cstring>
#include <fstream>
#include <map>
#include <sstream>
#include <thread>

#include "deploy/tact/child.hpp"
#include "deploy/tact/files.hpp"
#include "ipc/base/error.hpp"
#include "ipc/base/histogram.hpp"
#include "ipc/topics/text.hpp"
#include "ipc/version/version.hpp"
#include "tests/unit/deploy_metrics_region.hpp"

namespace tact::launch::deploy_metrics_test {
namespace {

// The value of a line that begins with this text and a space; NaN: no such line.
double value_of(const std::string& text, const std::string& line) {
    const std::size_t at = text.find("\n" + line + " ");
    return at == std::string::npos ? NAN : std::stod(text.substr(at + line.size() + 2));
}

TEST(Metrics, report_rate_lateness_levels_and_faults_by_cause) {
    const auto region = a_region();
    Metrics metrics("lab");
    fault(*region, RunReason::device_lost);
    metrics.follow(*region, 1);
    fault(*region, RunReason::device_lost);
    fault(*region, RunReason::force_not_finite);
    metrics.follow(*region, 1);
    const std::string text = metrics.text(region.get());
    EXPECT_EQ(value_of(text, "tact_up{session=\"lab\"}"), 1.0);
    EXPECT_EQ(value_of(text, "tact_build_info{session=\"lab\",version=\"" + std::string(version()) + "\"}"),
              1.0);
    EXPECT_EQ(value_of(text, "tact_force_rate_hertz{session=\"lab\"}"), 998.5);
    EXPECT_EQ(value_of(text, "tact_servo_overruns_total{session=\"lab\"}"), 3.0);
    EXPECT_EQ(value_of(text, "tact_state{session=\"lab\",state=\"active\"}"), 1.0);
    EXPECT_EQ(value_of(text, "tact_state{session=\"lab\",state=\"fault\"}"), 0.0);
    EXPECT_EQ(value_of(text, "tact_level{session=\"lab\",path=\"docking.force\"}"), 0.25);
    EXPECT_EQ(value_of(text, "tact_frame_time_seconds{session=\"lab\"}"), 0.02);
    EXPECT_EQ(value_of(text, "tact_device_bus_errors_total{session=\"lab\",hand=\"1\",kind=\"lost\"}"), 7.0);
    EXPECT_EQ(value_of(text, "tact_motor_heat_ratio{session=\"lab\",hand=\"1\"}"), 0.5);
    EXPECT_TRUE(std::isnan(value_of(text, "tact_motor_heat_ratio{session=\"lab\",hand=\"2\"}")));
    EXPECT_TRUE(std::isnan(value_of(text, "tact_motor_winding_celsius{session=\"lab\",hand=\"1\"}")));
    EXPECT_EQ(value_of(text, "tact_motor_winding_max_celsius{session=\"lab\",hand=\"2\"}"), 120.0);
    EXPECT_EQ(value_of(text, "tact_tracker_fresh{session=\"lab\"}"), 1.0);
    EXPECT_EQ(value_of(text, "tact_tracker_errors_total{session=\"lab\",kind=\"missed\"}"), 4.0);
    EXPECT_EQ(value_of(text, "tact_frames_total{session=\"lab\"}"), 400.0);
    EXPECT_EQ(value_of(text, "tact_frames_late_total{session=\"lab\"}"), 2.0);
    EXPECT_EQ(value_of(text, "tact_frame_seconds{session=\"lab\",quantile=\"0.99\"}"), 0.75);
    const std::string bone = "{session=\"lab\",pass=\"bone\",quantile=\"0.99\"}";
    EXPECT_EQ(value_of(text, "tact_pass_work_seconds" + bone), 0.25);
    EXPECT_EQ(value_of(text, "tact_pass_drawn_seconds" + bone), 0.5);
    EXPECT_EQ(value_of(text, "tact_path_work_seconds{session=\"lab\",path=\"gui.volume\",quantile=\"0.5\"}"),
              0.0625);
    // Unknown values are not exported.
    EXPECT_EQ(text.find("tact_pass_drawn_seconds{session=\"lab\",pass=\"swap\""), std::string::npos);
    const auto cause = [&](RunReason reason) {
        return value_of(text, std::string("tact_faults_total{session=\"lab\",cause=\"") +
                                  run_reason_name(reason) + "\"}");
    };
    EXPECT_EQ(cause(RunReason::device_lost), 2.0);
    EXPECT_EQ(cause(RunReason::force_not_finite), 1.0);
    const auto below = [&](const char* edge) {
        return value_of(
            text, std::string("tact_servo_lateness_seconds_bucket{session=\"lab\",le=\"") + edge + "\"}");
    };
    EXPECT_EQ(below("1e-06"), 2.0);
    EXPECT_EQ(below("2e-06"), 3.0);
    EXPECT_EQ(below("5e-05"), 4.0);
    EXPECT_EQ(below("0.01"), 4.0);
    EXPECT_EQ(below("+Inf"), 5.0);
    EXPECT_EQ(value_of(text, "tact_servo_lateness_seconds_count{session=\"lab\"}"), 5.0);
    EXPECT_NEAR(value_of(text, "tact_servo_lateness_seconds_sum{session=\"lab\"}"), 0.04, 0.003);
}

TEST(Metrics, an_exited_controller_is_down_and_has_no_metrics) {
    const auto region = a_region();
    Metrics metrics("lab");
    fault(*region, RunReason::device_lost);
    metrics.follow(*region, 1);
    const std::string text = metrics.text(nullptr);
    EXPECT_EQ(value_of(text, "tact_up{session=\"lab\"}"), 0.0);
    EXPECT_EQ(text.find("tact_force_rate_hertz"), std::string::npos);
    EXPECT_NE(text.find("tact_faults_total{"), std::string::npos);  // a counter does not decrease
}

// The counts by cause.
std::map<std::string, double> causes_of(const std::string& text) {
    std::map<std::string, double> causes;
    std::istringstream lines(text);
    const std::string begin = "tact_faults_total{session=\"lab\",cause=\"";
    for (std::string line; std::getline(lines, line);) {
        if (line.rfind(begin, 0) != 0) continue;
        const std::size_t end = line.find("\"} ");
        causes[line.substr(begin.size(), end - begin.size())] = std::stod(line.substr(end + 3));
    }
    return causes;
}

TEST(Metrics, every_cause_is_exported_at_zero_before_its_first_fault) {
    Metrics metrics("lab");
    std::map<std::string, double> wanted{{"unknown", 0.0}};
    for (int r = 0; r <= 255; ++r)
        if (const auto reason = static_cast<RunReason>(r); latches_fault(reason))
            wanted[run_reason_name(reason)] = 0.0;
    EXPECT_EQ(wanted.size(), 14U);
    EXPECT_EQ(causes_of(metrics.text(nullptr)), wanted);  // no controller yet
    const auto region = a_region();
    metrics.follow(*region, 1);
    EXPECT_EQ(causes_of(metrics.text(region.get())), wanted);
    for (int r = -1; r <= 256; ++r) {  // for any value of a controller, the set of causes stays the same
        EventTopic e{};
        e.code = static_cast<std::uint16_t>(EventCode::fault_latched);
        e.a = r;
        region->events.push(e);
        metrics.follow(*region, 1);
    }
    for (auto& [cause, count] : wanted) count = 1.0;
    wanted["unknown"] = 258.0 - 13.0;
    EXPECT_EQ(causes_of(metrics.text(region.get())), wanted);
    EXPECT_EQ(causes_of(metrics.text(nullptr)), wanted);
}

TEST(Metrics, faults_add_up_across_controllers_and_are_never_counted_twice) {
    Metrics metrics("lab");
    const auto first = a_region(), second = a_region();
    fault(*first, RunReason::device_lost);
    metrics.follow(*first, 1);  // an exporter that started after the fault
    metrics.follow(*first, 1);
    EXPECT_EQ(causes_of(metrics.text(first.get()))["device_lost"], 1.0);
    fault(*first, RunReason::device_lost);
    metrics.left(*first, 1);  // counted although it was read after the controller's end
    EXPECT_EQ(causes_of(metrics.text(nullptr))["device_lost"], 2.0);
    metrics.follow(*first, 1);  // connected again
    EXPECT_EQ(causes_of(metrics.text(first.get()))["device_lost"], 2.0);
    EXPECT_EQ(value_of(metrics.text(first.get()), "tact_controllers_seen_total{session=\"lab\"}"), 1.0);
    fault(*second, RunReason::device_lost);
    metrics.follow(*second, 2);
    const std::string text = metrics.text(second.get());
    EXPECT_EQ(causes_of(text)["device_lost"], 3.0);
    EXPECT_EQ(value_of(text, "tact_controllers_seen_total{session=\"lab\"}"), 2.0);
    for (std::uint64_t i = 0; i < 3000; ++i) second->events.push({});
    metrics.follow(*second, 2);
    EXPECT_GT(value_of(metrics.text(nullptr), "tact_events_missed_total{session=\"lab\"}"), 1000.0);
}

TEST(Metrics, a_killed_controller_differs_from_one_that_ended_in_order) {
    Metrics metrics("lab");
    const std::string name = "tact_controller_ended_in_order{session=\"lab\"}";
    EXPECT_TRUE(std::isnan(value_of(metrics.text(nullptr), name)));  // no controller seen
    const auto region = a_region();
    metrics.follow(*region, 1);
    metrics.left(*region, 1);  // active until the end
    EXPECT_EQ(value_of(metrics.text(nullptr), name), 0.0);
    HealthTopic h{};
    h.state = static_cast<std::uint8_t>(RunState::off);
    region->health.publish(h);
    metrics.follow(*region, 1);
    EXPECT_TRUE(std::isnan(value_of(metrics.text(region.get()), name)));
    metrics.left(*region, 1);
    EXPECT_EQ(value_of(metrics.text(nullptr), name), 1.0);
}

TEST(Metrics, a_hostile_region_still_gives_a_readable_page) {
    const auto region = std::make_unique<RtRegion>();
    HealthTopic h{};
    std::memset(static_cast<void*>(&h), 0xFF, sizeof h);
    region->health.publish(h);
    LevelsTopic l{};
    std::memset(static_cast<void*>(&l), 0xFF, sizeof l);
    std::memcpy(l.path[0].path, "a\"b\\c\nd", 8);
    l.path[0].level = 1.0F;
    region->levels.publish(l);
    DisplayTopic p{};
    std::memset(static_cast<void*>(&p), 0x7F, sizeof p);
    region->picture.publish(p);
    EventTopic e{};
    e.code = static_cast<std::uint16_t>(EventCode::fault_latched);
    e.a = NAN;
    region->events.push(e);
    Metrics metrics("a\"b");
    metrics.follow(*region, 1);
    std::istringstream lines(metrics.text(region.get()));
    for (std::string line; std::getline(lines, line);) {
        ASSERT_FALSE(line.empty());
        EXPECT_EQ(line.find("nan"), std::string::npos) << line;
        EXPECT_EQ(line.rfind(line[0] == '#' ? "# " : "tact_", 0), 0U) << line;
    }
}

TEST(Metrics, are_answered_over_http_on_the_loopback) {
    MetricsServer server("127.0.0.1", 0);
    ASSERT_GT(server.port(), 0);
    httplib::Client client("127.0.0.1", server.port());
    EXPECT_EQ(client.Get("/metrics")->status, 503);  // nothing offered yet
    for (const char* const text : {"tact_up 1\n", "tact_up 0\n"}) {
        server.offer(text);
        const auto answer = client.Get("/metrics");
        ASSERT_TRUE(answer);
        EXPECT_EQ(answer->status, 200);
        EXPECT_EQ(answer->body, text);
        EXPECT_NE(answer->get_header_value("Content-Type").find("version=0.0.4"), std::string::npos);
    }
    EXPECT_EQ(client.Get("/../etc/passwd")->status, 404);
    EXPECT_THROW(MetricsServer("127.0.0.1", server.port()), StartupError);
    EXPECT_THROW(MetricsServer("203.0.113.7", 0), StartupError);
}

TEST(Metrics, a_file_is_replaced_atomically) {
    const ScratchFolder folder;
    const auto path = folder.path() / "tact.prom";
    for (const char* const text : {"long text\n", "short\n"}) {
        write_textfile(path, text);
        std::ifstream in(path);
        EXPECT_EQ((std::string{std::istreambuf_iterator<char>(in), {}}), text);
    }
    EXPECT_FALSE(std::filesystem::exists(path.string() + ".partial"));
    EXPECT_THROW(write_textfile(folder.path() / "none" / "tact.prom", "x"), StartupError);
}

TEST(Metrics, promtool_accepts_the_page_and_the_rules) {
    const std::filesystem::path promtool = find_in_path("promtool");
    if (promtool.empty()) GTEST_SKIP() << "there is no promtool in PATH (./deploy/test fetches one)";
    const ScratchFolder folder;
    const auto region = a_region();
    Metrics metrics("lab");
    fault(*region, RunReason::device_lost);
    metrics.follow(*region, 1);
    write_textfile(folder.path() / "page", metrics.text(region.get()));
    const auto runs = [&](const std::string& words) {
        return std::system(("cd deploy/monitoring && '" + promtool.string() + "' " + words).c_str());
    };
    EXPECT_EQ(runs("check metrics < '" + (folder.path() / "page").string() + "'"), 0);
    EXPECT_EQ(runs("check config prometheus.yml"), 0);
    EXPECT_EQ(runs("test rules tact_rules_test.yml"), 0);
}

}  // namespace
}  // namespace tact::launch::deploy_metrics_test
