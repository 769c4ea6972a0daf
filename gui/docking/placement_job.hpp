// Looks for places of one body with tact-search or tact-refine as a child.
//
// Child    so that a search takes no time that is counted as the display's, runs at low priority, and can be cancelled at any moment
// Fails by PlacementOutcome::error, with the child's message
// Thread   the frame thread; never waits
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "gui/base/child_job.hpp"
#include "gui/base/scratch_folder.hpp"
#include "gui/docking/fit_worker.hpp"
#include "gui/docking/found_places.hpp"

namespace tact {

// What a place is judged by.
enum class PlaceObjective : std::uint8_t {
    laplacian,     // correlation about the mean of the Laplacians of the densities
    correlation,   // of the densities
    mean_density,  // at the atoms, as the docking force; only uphill from the present place
};

struct PlacementRequest {
    FitBody body;
    std::vector<FitBody> subtracted;  // bodies whose density is taken out of the map
    PlaceObjective objective = PlaceObjective::laplacian;
    bool nearby = false;     // within 10 angstrom and 20 degrees; otherwise in the whole map
    std::string symmetry{};  // of a search: places of copies by this symmetry; empty: of the body alone
};

struct PlacementOutcome {
    FitBody start;  // the body as it was
    PlaceObjective objective = PlaceObjective::laplacian;
    bool nearby = false;
    std::string symmetry;           // as found: "C7" for "find"
    std::vector<FoundPlace> found;  // best first; one if nearby; the copies if there is a symmetry
    std::string error;              // not empty: failed
    bool cancelled = false;
};

// Tests put others in their place.
struct PlacementPrograms {
    std::string search = "tact-search", refine = "tact-refine";
};

class PlacementJob {
public:
    explicit PlacementJob(std::shared_ptr<const SceneContent> content, PlacementPrograms programs = {})
        : content_(std::move(content)), programs_(std::move(programs)) {}

    void start(const PlacementRequest& request);  // only if not running
    [[nodiscard]] bool running() const { return job_.running(); }
    [[nodiscard]] const PlacementOutcome& pending() const {
        return outcome_;
    }  // while running: without result
    // In [0, 1], as the child reports.
    [[nodiscard]] double progress() const;
    void cancel();
    [[nodiscard]] std::optional<PlacementOutcome> poll();  // once, when done

private:
    void finish(const ChildOutcome& ended);

    const std::shared_ptr<const SceneContent> content_;
    const PlacementPrograms programs_;
    std::unique_ptr<ScratchFolder> folder_;  // destroyed after the job
    ChildJob job_;
    PlacementOutcome outcome_;
};

}  // namespace tact
