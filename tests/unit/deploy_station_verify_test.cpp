// The grades that tact station verify derives from its measurements, and the readers of its report.
#include <gtest/gtest.h>
#include <unistd.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <functional>
#include <limits>

#include "deploy/tact/metrics_station.hpp"
#include "deploy/tact/station/cyclictest.hpp"
#include "deploy/tact/station/judge.hpp"
#include "deploy/tact/station/smi.hpp"
#include "ipc/station/station_report.hpp"
#include "ipc/topics/health.hpp"

namespace tact::launch::deploy_station_verify_test {
namespace {

VerifyMetrics good() {
    VerifyMetrics f;
    f.seconds = 60.0;
    f.rate_hz = 1000.0;
    f.cycles = 60000;
    f.schedule_flags =
        kScheduleFifo | kSchedulePinned | kScheduleIsolated | kScheduleLocked | kScheduleDmaLatency;
    f.p50_us = 0.2;
    f.p99_us = 1.5;
    f.p999_us = 4.0;
    f.max_us = 12.5;
    f.core = 3;
    f.cyclictest_max_us = 20.0;
    f.smi_count = 0;
    f.kernel = "6.1-rt PREEMPT_RT";
    f.machine = "00ff";
    f.realtime_kernel = true;
    f.arguments = "quiet isolcpus=managed_irq,domain,3 nohz_full=3";
    f.arguments_wanted = "isolcpus=managed_irq,domain,3 nohz_full=3";
    f.governor = "performance";
    f.verified_at_s = 1'800'000'000;
    return f;
}

Grade grade_of(const std::function<void(VerifyMetrics&)>& change) {
    VerifyMetrics f = good();
    change(f);
    return worst_of(judge_station(f, {}));
}

TEST(StationJudge, a_quiet_station_passes) {
    for (const Check& c : judge_station(good(), {}))
        EXPECT_EQ(c.grade, Grade::pass) << c.name << ": " << c.text;
}

TEST(StationJudge, each_limit_counts_by_itself) {
    EXPECT_EQ(grade_of([](auto& f) { f.p999_us = 51.0; }), Grade::warn);
    EXPECT_EQ(grade_of([](auto& f) { f.p999_us = 201.0; }), Grade::fail);
    EXPECT_EQ(grade_of([](auto& f) { f.max_us = 201.0; }), Grade::warn);
    EXPECT_EQ(grade_of([](auto& f) { f.max_us = 1001.0; }), Grade::fail);
    EXPECT_EQ(grade_of([](auto& f) { f.max_us = std::numeric_limits<double>::quiet_NaN(); }), Grade::fail);
    EXPECT_EQ(grade_of([](auto& f) { f.cyclictest_max_us = 151.0; }), Grade::warn);
    EXPECT_EQ(grade_of([](auto& f) { f.cyclictest_max_us = 1001.0; }), Grade::fail);
    EXPECT_EQ(grade_of([](auto& f) { f.cyclictest_max_us.reset(); }), Grade::warn);
    EXPECT_EQ(grade_of([](auto& f) { f.cycles = 0; }), Grade::fail);
    EXPECT_EQ(grade_of([](auto& f) { f.overruns = 1; }), Grade::warn);
    EXPECT_EQ(grade_of([](auto& f) { f.skipped = 1; }), Grade::warn);
    EXPECT_EQ(grade_of([](auto& f) { f.allocations = 1; }), Grade::fail);
    EXPECT_EQ(grade_of([](auto& f) { f.page_faults = 1; }), Grade::fail);
    EXPECT_EQ(grade_of([](auto& f) { f.schedule_flags &= ~kScheduleIsolated; }), Grade::warn);
    EXPECT_EQ(grade_of([](auto& f) { f.realtime_kernel = false; }), Grade::warn);
    EXPECT_EQ(grade_of([](auto& f) { f.arguments = "quiet nohz_full=3"; }), Grade::warn);
    EXPECT_EQ(grade_of([](auto& f) { f.arguments_wanted.clear(); }), Grade::warn);
    EXPECT_EQ(grade_of([](auto& f) { f.governor = "powersave"; }), Grade::warn);
    EXPECT_EQ(grade_of([](auto& f) { f.governor.clear(); }), Grade::pass);
    EXPECT_EQ(grade_of([](auto& f) { f.smi_count = 2; }), Grade::warn);
    EXPECT_EQ(grade_of([](auto& f) { f.smi_count.reset(); }), Grade::pass);
}

TEST(StationReport, survives_write_and_read_with_its_thresholds) {
    const nlohmann::json j = station_report_json(good(), {});
    EXPECT_EQ(j["thresholds_us"]["lateness_p999"]["pass"], 50.0);
    EXPECT_EQ(j["kernel_arguments"]["wanted"], "isolcpus=managed_irq,domain,3 nohz_full=3");
    std::string refusal = "x";
    const auto r = parse_station_report(j.dump(), refusal);
    ASSERT_TRUE(r) << refusal;
    EXPECT_EQ(r->status, "pass");
    EXPECT_EQ(r->verified_at_s, 1'800'000'000);
    EXPECT_EQ(r->kernel, "6.1-rt PREEMPT_RT");
    EXPECT_EQ(r->p999_us, 4.0);
    EXPECT_EQ(r->max_us, 12.5);
    EXPECT_EQ(r->cyclictest_max_us, 20.0);
    EXPECT_EQ(r->smi_count, 0U);
}

TEST(StationReport, an_invalid_report_is_refused_with_a_reason) {
    const nlohmann::json whole = station_report_json(good(), {});
    std::vector<std::string> texts{"", "[]", "{", "{}", "null"};
    for (const char* const key :
         {"format", "version", "status", "verified_at_s", "machine", "kernel", "lateness_us"}) {
        nlohmann::json j = whole;
        j.erase(key);
        texts.push_back(j.dump());
    }
    nlohmann::json j = whole;
    j["status"] = "excellent";
    texts.push_back(j.dump());
    j = whole;
    j["lateness_us"]["max"] = -1.0;
    texts.push_back(j.dump());
    j["lateness_us"]["max"] = "late";
    texts.push_back(j.dump());
    for (const std::string& text : texts) {
        std::string refusal;
        EXPECT_FALSE(parse_station_report(text, refusal)) << text;
        EXPECT_FALSE(refusal.empty()) << text;
    }
    std::string refusal = "x";
    EXPECT_FALSE(read_station_report("/nonexistent/report.json", refusal));
    EXPECT_TRUE(refusal.empty());  // a missing report is not an error
    EXPECT_FALSE(read_station_report("/dev/zero", refusal));
    EXPECT_FALSE(refusal.empty());
}

TEST(StationReport, the_statement_has_age_machine_and_kernel) {
    std::string refusal;
    const StationReport r = *parse_station_report(station_report_json(good(), {}).dump(), refusal);
    const std::int64_t day = 24 * 3600;
    const StationStatement same =
        describe_station_report(r, r.verified_at_s + 3 * day, "00ff", "6.1-rt PREEMPT_RT");
    EXPECT_TRUE(same.good);
    EXPECT_EQ(
        same.text,
        "station report: pass, 3 days old, lateness p99.9 4.0 us, max 12.5 us; same machine and kernel");
    const StationStatement kernel = describe_station_report(r, r.verified_at_s + 60, "00ff", "6.12");
    EXPECT_FALSE(kernel.good);
    EXPECT_NE(kernel.text.find("1 minute old"), std::string::npos) << kernel.text;
    EXPECT_NE(kernel.text.find("another kernel"), std::string::npos) << kernel.text;
    EXPECT_NE(describe_station_report(r, 0, "11", "").text.find("another machine"), std::string::npos);
    StationReport failed = r;
    failed.status = "fail";
    EXPECT_FALSE(describe_station_report(failed, r.verified_at_s, "00ff", "6.1-rt PREEMPT_RT").good);
}

TEST(StationMetrics, have_status_time_and_lateness) {
    std::string refusal;
    const auto r = parse_station_report(station_report_json(good(), {}).dump(), refusal);
    const std::string text = station_metrics("session=\"lab\"", r, "00ff", "6.1-rt PREEMPT_RT");
    for (const char* const line :
         {"tact_station_report{session=\"lab\"} 1\n",
          "tact_station_status{session=\"lab\",status=\"pass\"} 1\n",
          "tact_station_status{session=\"lab\",status=\"fail\"} 0\n",
          "tact_station_applies{session=\"lab\"} 1\n",
          "tact_station_verified_timestamp_seconds{session=\"lab\"} 1800000000\n",
          "tact_station_lateness_seconds{session=\"lab\",quantile=\"0.999\"} 4e-06\n",
          "tact_station_lateness_seconds{session=\"lab\",quantile=\"1\"} 1.25e-05\n",
          "tact_station_cyclictest_max_seconds{session=\"lab\"} 2e-05\n",
          "tact_station_smi{session=\"lab\"} 0\n"})
        EXPECT_NE(text.find(line), std::string::npos) << line << text;
    EXPECT_NE(station_metrics("a=\"b\"", r, "00ff", "other").find("tact_station_applies{a=\"b\"} 0\n"),
              std::string::npos);
    const std::string none = station_metrics("a=\"b\"", std::nullopt, "", "");
    EXPECT_NE(none.find("tact_station_report{a=\"b\"} 0\n"), std::string::npos);
    EXPECT_EQ(none.find("tact_station_status"), std::string::npos);
}

TEST(StationCyclictest, runs_beside_the_controller_only_on_another_isolated_core) {
    const CyclictestPlace beside = place_cyclictest(3, {2, 3}, {3});
    EXPECT_TRUE(beside.beside);
    EXPECT_EQ(beside.core, 2);
    EXPECT_FALSE(place_cyclictest(3, {1, 3}, {1, 3}).beside);  // another thread of the servo's own core
    EXPECT_EQ(place_cyclictest(3, {3}, {3}).core, 3);
    EXPECT_FALSE(place_cyclictest(3, {3}, {3}).beside);
    EXPECT_EQ(place_cyclictest(-1, {}, {}).core, -1);
}

TEST(StationCyclictest, valid_output_is_read_and_other_output_is_ignored) {
    EXPECT_EQ(
        parse_cyclictest(R"({"thread": {"0": {"cycles": 5, "max": 17}, "1": {"cycles": 5, "max": 9}}})"),
        17.0);
    EXPECT_FALSE(parse_cyclictest(R"({"thread": {"0": {"cycles": 0, "max": 0}}})"));
    EXPECT_FALSE(parse_cyclictest(R"({"thread": {}})"));
    EXPECT_FALSE(parse_cyclictest("max 17"));
}

TEST(StationSmi, is_read_from_its_register_and_otherwise_gives_the_reason) {
    std::string name = (std::filesystem::temp_directory_path() / "smi-XXXXXX").string();
    const std::filesystem::path root = mkdtemp(name.data());
    std::filesystem::create_directories(root / "proc");
    std::filesystem::create_directories(root / "dev/cpu/2");
    std::ofstream(root / "proc/cpuinfo") << "vendor_id\t: GenuineIntel\n";
    EXPECT_NE(read_smi_count(2, root).why_not.find("modprobe msr"), std::string::npos);
    std::string registers(0x3C, '\0');
    registers[0x34] = 7;
    registers[0x35] = 1;
    registers[0x38] = 9;  // above the counter's 32 bits
    std::ofstream(root / "dev/cpu/2/msr", std::ios::binary) << registers;
    EXPECT_EQ(read_smi_count(2, root).count, 263U);
    std::ofstream(root / "proc/cpuinfo") << "vendor_id\t: AuthenticAMD\n";
    EXPECT_NE(read_smi_count(2, root).why_not.find("Intel"), std::string::npos);
    std::filesystem::remove_all(root);
    EXPECT_EQ(smi_between(0xFFFFFFFFU, 1), 2U);
}

}  // namespace
}  // namespace tact::launch::deploy_station_verify_test
