// Keeps the surface fine around the tool; connects controller, panel and view.
//
// In mode chr the drawn cut follows the controller's probe, radius and filter. A change by the user is sent as a
// command and is visible once the controller applies it. In other modes the window keeps its own cut with the same
// form.
// Thread   frame thread; the cut is updated on its own thread.
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
    // For another scene.
    void use(std::shared_ptr<const SceneContent> content, DetailState& state);
    // shown: the user's choice; switched on when the controller begins to refine. touch: from the controller, or
    // null. `requests` are for the controller. Returns the mesh to draw, if it is new.
    std::optional<DetailMesh> follow(const TouchTopic* touch, bool& shown, DetailState& state,
                                     std::vector<Request>& requests);

private:
    std::shared_ptr<const SceneContent> content_;
    std::unique_ptr<DetailWorker> worker_;  // created when first shown
    std::optional<DetailRequest> requested_;
    bool of_controller_before_ = false;
    std::optional<FilterForm> asked_;  // sent to the controller, not yet applied
    int frames_asked_ = 0;
};

}  // namespace tact
