// Actions on bodies other than holding them: measure, undo, refine, copy, take snapshots, save.
//
// Reads    the bodies that the controller publishes; changes them only by the commands it returns
// Does     the slow work in the background: metrics on a thread; search, refinement and saving in programs of their own
// Thread   frame thread
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "gui/base/child_job.hpp"
#include "gui/docking/body_list.hpp"
#include "gui/docking/docking_panels.hpp"
#include "gui/docking/fit_history.hpp"
#include "gui/docking/fit_worker.hpp"
#include "gui/docking/place_finder.hpp"
#include "gui/docking/poses_json.hpp"
#include "gui/link/command_sender.hpp"
#include "ipc/scene/session/session_file.hpp"

namespace tact {

class FitController {
public:
    // Another scene, or none: resets everything.
    void use(std::shared_ptr<const SceneContent> content);
    // Call once a frame; topic: of the attached controller, or null; contour: that counts as inside. Adds commands that became due.
    // residues: their fit is wanted (outcome()).
    void follow(const BodyList& list, const BodiesTopic* topic, double contour, bool residues,
                std::vector<Command>& commands);
    void perform(const FitRequest& request, const BodyList& list, std::vector<Command>& commands);
    // Bodies and snapshots, to and from a session.
    void add_to(Session& session, const BodyList& list) const;
    void restore(const Session& session);
    // At the end: waits for a save in progress, at most this long.
    void finish_saving(Duration patience);
    // Fills the panels' state; takes the user's choice of an objective from it.
    void describe(const BodyList& list, const BodiesTopic* topic, FittingState& state, FitState& fit);

    [[nodiscard]] const PlaceFinder& finder() const { return finder_; }
    [[nodiscard]] const FitOutcome& outcome() const { return outcome_; }  // the newest

private:
    void report(Grade grade, std::string text);
    void show(const std::optional<PlaceFinder::Message>& message);
    void keep(const std::string& name, const FitHistory::Places& places);
    void copy(const ShownBody& body, const BodyList& list, std::vector<Command>& commands);
    void save(const BodyList& list);
    [[nodiscard]] static std::vector<PosedBody> posed(const BodyList& list);
    void place(std::span<const FitHistory::Move> moves, const BodyList& list, std::vector<Command>& commands);

    std::shared_ptr<const SceneContent> content_;
    std::unique_ptr<FitWorker> fit_;
    PlaceFinder finder_;
    FitOutcome outcome_;
    FitHistory history_;
    ChildJob saving_;
    std::string saving_to_;
    std::string message_;
    Grade message_grade_ = Grade::unknown;
    std::vector<FitBody> bodies_;
    double contour_ = 0.0;  // that counts as inside
};

}  // namespace tact
