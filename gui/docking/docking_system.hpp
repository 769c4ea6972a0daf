// Docking in the window: bodies, their fit, and contours of the map.
//
// Thread   frame thread
#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "gui/docking/body_list.hpp"
#include "gui/docking/contour_option.hpp"
#include "gui/docking/docking_layer.hpp"
#include "gui/docking/docking_panels.hpp"
#include "gui/docking/fit_controller.hpp"
#include "gui/system/scene_system.hpp"

namespace tact {

class DockingSystem : public SceneSystem {
public:
    // contours: replace the scene's own unless empty.
    explicit DockingSystem(std::vector<ContourOption> contours) : options_(std::move(contours)) {}

    [[nodiscard]] SystemPanels& panels() override { return panels_; }
    void use(const std::shared_ptr<const SceneContent>& content, std::unique_ptr<SceneStart> start,
             SceneView& view, const SystemContext& context) override;
    void close() override;
    void attach(const SystemContext& context) override;
    void read(const Controller::Fresh& fresh, const SystemContext& context) override;
    bool perform(KeyAction what, std::size_t place, const SystemContext& context) override;
    void click(const Sight& sight, const SystemContext& context) override;
    void turn_wheel(double steps) override;
    void choose_by_wheel(double steps) override;
    void add_to(LoadTopic& load) const override;
    [[nodiscard]] std::optional<Vec3> tool_at(std::size_t hand, const SystemContext& context) const override;
    void adapt() override;
    void prepare(std::int64_t now_ns, bool sharp, ViewFrame& frame, const SystemContext& context) override;
    void refine() override;
    [[nodiscard]] bool add_to_key(ContentKey& key) const override;
    void drawn(const SystemContext& context) override;
    void add_to(Session& session) const override;
    void restore(const Session& session) override;
    void finish(const SystemContext& context) override;

private:
    // What is shown as the contour, and what "inside" refers to: the first contour, as the person set it.
    void count_contour();
    void colour_by_fit();
    void label(const ViewFrame& frame, const SystemContext& context);
    void describe_shape(const Controller& controller, FittingState& fitting) const;
    void follow_bodies(std::int64_t now_ns, const SystemContext& context);

    const std::vector<ContourOption> options_;
    DockingPanels panels_;
    std::shared_ptr<const SceneContent> content_;
    SceneView* view_ = nullptr;
    std::unique_ptr<DockingLayer> layer_;
    FitController fit_controller_;
    BodyList list_;
    std::vector<DrawnBody> drawn_;
    std::string message_;            // of the last action, as shown
    std::uint64_t coloured_by_ = 0;  // number of the outcome
    float molecules_level_ = 1.0F;   // keeps the controller's newest value
};

}  // namespace tact
