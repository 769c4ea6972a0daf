// Undo and redo of gestures, acceptance, and snapshots.
//
// Gesture   from one boundary to the next. A boundary is a grip (the hand takes hold), a placement by command,
//           or a selection: BodiesTopic.grips, .placements and .active. Motion below a hundredth of an ångström
//           or of a degree is no gesture; the limit is a whole one while the hand keeps holding a body that undo
//           or the like has moved.
// Gives     lists of moves, which the caller sends as one placement each. Motion is ignored until the controller
//           has made the moves, or for kPatience observations.
// Bounds    the last kGesturesMax gestures, kSnapshotsMax snapshots.
// Thread    one.
#pragma once

#include <cstdint>
#include <deque>
#include <span>
#include <string>
#include <vector>

#include "ipc/base/pose.hpp"

namespace tact {

class FitHistory {
public:
    static constexpr std::size_t kGesturesMax = 200, kSnapshotsMax = 50;
    static constexpr int kPatience = 300;
    struct Move {
        std::uint32_t id = 0;  // of the body
        Pose T_model_body;     // target pose
    };
    using Places = std::vector<Move>;
    struct Boundary {
        std::uint64_t grips = 0, placements = 0;
        std::uint32_t active = 0;
        friend bool operator==(const Boundary&, const Boundary&) = default;
    };

    void clear();
    // Call once a frame with every body. Falling counters belong to another controller and clear the history.
    void observe(std::span<const Move> now, const Boundary& boundary);

    [[nodiscard]] std::size_t undoable() const;
    [[nodiscard]] std::size_t redoable() const { return undone_.size(); }
    Places undo();    // includes a gesture in progress
    Places redo();    // empty after another gesture
    Places revert();  // to the last accepted poses, at first the initial ones; can itself be undone
    void accept();    // undo and revert then go back no farther than this

    [[nodiscard]] const Places& places() const { return now_; }
    // Of all bodies, as they are or will be. Returns false if there are too many, or the name exists.
    bool snapshot(const std::string& name, const Places& places);
    bool snapshot(const std::string& name) { return snapshot(name, now_); }
    Places restore(const std::string& name);
    [[nodiscard]] std::vector<std::string> snapshots() const;
    [[nodiscard]] const Places& places_of(const std::string& snapshot) const;  // empty: there is none

private:
    void commit();  // ends the gesture in progress
    Places go(const Places& to);

    bool begun_ = false;
    std::uint64_t awaited_ = 0;  // placements until go() is carried out
    int patience_ = 0;           // 0: not waiting
    bool resumed_ = false;       // no boundary since go() was carried out
    Boundary boundary_;
    Places now_, base_, accepted_;
    std::deque<Places> done_;  // poses before each gesture, oldest first
    std::vector<Places> undone_;
    struct Snapshot {
        std::string name;
        Places places;
    };
    std::vector<Snapshot> snapshots_;
};

}  // namespace tact
