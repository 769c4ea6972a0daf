// The surface kept fine around the tool, between controller, panel and view.
//
// In mode chr the cut that is drawn follows the controller's: its probe, its radius, its filter. A person's change is a
// command, and is seen once the controller has it. In other modes the window keeps one of its own, with the same form.
// Thread   frame thread; the cut is moved on a thread of its own.
#pragma once

#include <memory>
#include <optional>
#include <vector>

#include "gui/dashboard/dashboard_state.hpp"
#include "gui/surface/detail_panel.hpp"
#include "gui/surface/detail_worker.hpp"
#include "ipc/topics/touch.hpp"

namespace tact {

class DetailController {
public:
    // Another scene.
    void use(std::shared_ptr<const SceneContent> content, DetailState& state);
    // shown: a person's choice; on by itself where the controller begins to keep one.
    // touch: of the controller, null without one. Requests are for the controller. What is to be drawn, where it is new.
    std::optional<DetailMesh> follow(const TouchTopic* touch, bool& shown, DetailState& state,
                                     std::vector<Request>& requests);

private:
    std::shared_ptr<const SceneContent> content_;
    std::unique_ptr<DetailWorker> worker_;  // from when it was first shown
    std::optional<DetailRequest> requested_;
    bool of_controller_before_ = false;
    std::optional<FilterForm> asked_;  // of the controller, until it has it
    int frames_asked_ = 0;
};

}  // namespace tact
