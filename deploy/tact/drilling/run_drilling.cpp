// A drilling run: removed bone in the table; tools and trainee's performance in the report.
#include <array>
#include <cstdio>
#include <nlohmann/json.hpp>

#include "deploy/tact/drilling/drilling.hpp"
#include "deploy/tact/drilling/kept_bone.hpp"
#include "deploy/tact/drilling/report_drilling.hpp"
#include "deploy/tact/observer.hpp"

namespace tact::launch {
namespace {

class DrillingRun final : public SystemRun {
public:
    explicit DrillingRun(const SceneFile& scene) : scene_(scene.name()), scene_checksum_(scene.checksum()) {}

    std::vector<std::string> keeper_arguments(RunOptions& options) override {
        std::string resumed = options.controller_value("--resume");
        if (resumed == "last") resumed = last_bone_file(scene_checksum_);
        if (!resumed.empty()) {
            resumed = std::filesystem::absolute(resumed);
            options.set_controller_value("--resume", resumed);
        }
        kept_ = options.keep.empty() ? new_bone_file(scene_, resumed) : options.keep;
        std::vector<std::string> words{"--bone", kept_.string(), "--session", options.session};
        if (!resumed.empty()) words.insert(words.end(), {"--bone-from", resumed});
        return words;
    }

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
        nlohmann::json drilling = drilling_report(region, trainee_);
        if (!drilling.is_object()) return;
        drilling["kept_in"] =
            std::filesystem::exists(kept_) ? nlohmann::json(kept_.string()) : nlohmann::json(nullptr);
        report["drilling"] = std::move(drilling);
    }

private:
    std::filesystem::path scene_, kept_;
    std::uint64_t scene_checksum_;
    std::filesystem::path trainee_;  // written by the window; empty without one
};

}  // namespace

std::unique_ptr<SystemRun> open_drilling_run(const SceneFile& scene) {
    return std::make_unique<DrillingRun>(scene);
}

std::string drilling_report_summary(const nlohmann::json& report) {
    return report.contains("drilling") ? drilling_summary(report["drilling"]) : std::string();
}

}  // namespace tact::launch
