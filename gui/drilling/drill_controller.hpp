// Drilling metrics on display and in the report: distances to structures, warnings, the trainee's metrics.
//
// Frame     use() for a new scene; then follow() once a frame, after the bone's changes are known
// Thread    frame thread
#pragma once

#include <array>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <span>
#include <string>

#include "gui/dashboard/dashboard_state.hpp"
#include "gui/drilling/bone_content.hpp"
#include "gui/drilling/bone_follower.hpp"
#include "gui/drilling/drill_report.hpp"
#include "gui/drilling/drilling_panel.hpp"
#include "gui/link/controller.hpp"

namespace tact {

class DrillController {
public:
    void use(std::shared_ptr<const SceneContent> content);  // null: none
    // For a new controller, whose cycles and tools differ.
    void meet() { missed_ = 0; }
    void follow(Controller& controller, std::span<const BrickChange> changes, DashboardState& dashboard,
                DrillingState& state);
    // None in a scene without bone.
    [[nodiscard]] std::optional<DrillMetricsRow> metrics() const {
        return metrics_ ? std::optional(metrics_->metrics()) : std::nullopt;
    }
    // Does nothing for an empty path or a scene without bone. more: added to the report. Throws StartupError.
    void save(const std::string& path, const std::optional<BurrVisibility>& visibility,
              const nlohmann::json& more = nullptr) const;

private:
    enum class Nearness : std::uint8_t { far, amber, red };

    void take_cycles(Controller& controller);
    void take_bricks(std::span<const BrickChange> changes, DashboardState& state);
    void show(const DrillTopic& drill, DashboardState& dashboard, DrillingState& state);
    void report(DashboardState& state, std::string text, Grade grade) const;

    std::shared_ptr<const SceneContent> content_;
    const BoneContent* bone_ = nullptr;  // of content_
    std::unique_ptr<StructureWatch> watch_;
    std::unique_ptr<DrillMetrics> metrics_;
    std::vector<Nearness> nearness_;  // of the burr, per field
    std::uint64_t missed_ = 0;
};

}  // namespace tact
