// Places for a body: searches and refinements, the list of what was found, its ghosts, and the pull towards it.
//
// Reads    the bodies that the controller publishes; changes them only by the commands it returns
// Thread   frame thread; the work is done by children (placement_job.hpp)
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "gui/dashboard/status_text.hpp"
#include "gui/docking/body_list.hpp"
#include "gui/docking/docking_panels.hpp"
#include "gui/docking/molecules.hpp"
#include "gui/docking/placement_job.hpp"
#include "gui/link/command_sender.hpp"

namespace tact {

// A copy of the body that the hand may move.
[[nodiscard]] bool is_free_copy(const ShownBody& other, const ShownBody& body);

class PlaceFinder {
public:
    struct Message {
        Grade grade = Grade::good;
        std::string text;  // empty: the last message no longer holds
    };

    explicit PlaceFinder(PlacementPrograms programs = {}) : programs_(std::move(programs)) {}

    // Another scene with a map and structures, or none: forgets everything.
    void use(std::shared_ptr<const SceneContent> content);
    // Call once a frame; topic: of the attached controller, or null. Adds commands that became due.
    std::optional<Message> follow(const BodyList& list, const BodiesTopic* topic,
                                  std::vector<Command>& commands);
    // In the whole map, or nearby. Does nothing while another one runs.
    std::optional<Message> look(const ShownBody& body, bool nearby, const BodyList& list);
    void cancel();

    // A place found for this body; none: there is none.
    [[nodiscard]] std::optional<Pose> found(std::uint32_t body, std::size_t place) const;
    // All places of a search with a symmetry: the body and its free copies go to the nearest ones, new copies to the others.
    std::optional<Message> place_copies(const ShownBody& body, const BodyList& list,
                                        std::vector<Command>& commands) const;
    // Of the best places, those nearest to the body, at most three.
    [[nodiscard]] std::vector<DrawnBody> ghosts(const BodyList& list) const;
    // Fills the panel's state, and takes the user's choices from it.
    void describe(const BodyList& list, const BodiesTopic* topic, SearchState& state);

private:
    Message take(PlacementOutcome done, const BodyList& list, const BodiesTopic* topic,
                 std::vector<Command>& commands);
    [[nodiscard]] double away_m(const Pose& place, const Pose& here) const;  // of the atoms
    [[nodiscard]] std::vector<FitBody> subtracted(std::uint32_t body, const BodyList& list) const;
    // Tells the controller the places found and whether they pull, when that changes.
    void send_pull(const BodiesTopic* topic, std::vector<Command>& commands);

    const PlacementPrograms programs_;
    std::shared_ptr<const SceneContent> content_;
    std::unique_ptr<PlacementJob> job_;
    PlacementOutcome found_;       // of the last search
    double found_radius_m_ = 0.0;  // radius of gyration of its structure
    PlaceObjective objective_ = PlaceObjective::laplacian;
    std::string symmetry_;       // of the next search
    std::uint32_t options_ = 0;  // DockingOption, in effect
    bool pull_ = false;          // wanted by the user
    bool pull_asked_ = false;    // as the controller was asked last
    bool places_sent_ = false;   // the controller has the places of found_
};

}  // namespace tact
