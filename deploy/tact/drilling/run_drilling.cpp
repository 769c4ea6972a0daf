// A drilling run: removed bone in the table; tools and trainee's performance in the report.
#include <array>
#include <cstdio>
#include <nlohmann/json.hpp>

#include "deploy/tact/drilling/drilling.hpp"
#include "deploy/tact/drilling/report_drilling.hpp"
#include "deploy/tact/observer.hpp"

namespace tact::launch {
namespace {

class DrillingRun final : public SystemRun {
public:
    std::vector<std::string> window_options(const std::function<std::filesystem::path()>& scratch) override {
        trainee_ = scratch() / "drilling.json";
        return {"--report", trainee_.string()};
    }

    void sample(const RtRegion& region, Sample& sample) const override {
        const auto drill = newest(region.drill);
        if (!drill) return;
        const double taken_mm3 = 1e9 * static_cast<double>(drill->removed_levels) * drill->level_m3;
        sample.particles = true;
        sample.heading = "  bone removed";
        sample.own = {{"bone_taken_mm3", taken_mm3, 3}};
        std::array<char, 64> text{};
        std::snprintf(text.data(), text.size(), "  %7.1f mm3", taken_mm3);
        sample.line_end = text.data();
    }

    void report(const RtRegion& region, nlohmann::json& report) const override {
        if (nlohmann::json drilling = drilling_report(region, trainee_); drilling.is_object())
            report["drilling"] = std::move(drilling);
    }

private:
    std::filesystem::path trainee_;  // written by the window; empty without one
};

}  // namespace

std::unique_ptr<SystemRun> open_drilling_run(const SceneFile& /*scene*/) {
    return std::make_unique<DrillingRun>();
}

std::string drilling_report_summary(const nlohmann::json& report) {
    return report.contains("drilling") ? drilling_summary(report["drilling"]) : std::string();
}

}  // namespace tact::launch
