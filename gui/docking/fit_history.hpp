// Undo and redo of gestures, acceptance, snapshots: what a person may go back to.
//
// Gesture   from one boundary to the next. A boundary is a grip (the hand takes hold), a placement by command
//           or a selection: BodiesTopic.grips, .placements and .active. Where no body moved by a hundredth of
//           an ångström or of a degree, there was no gesture; nor by one whole where the hand just goes on
//           holding what was moved by undo or its like.
// Gives     lists of moves, which the caller sends as one placement each. Until the controller has made them
//           (or kPatience looks), what the bodies do in between counts for nothing.
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
        Pose T_model_body;     // where it is to go
    };
    using Places = std::vector<Move>;
    struct Boundary {
        std::uint64_t grips = 0, placements = 0;
        std::uint32_t active = 0;
        friend bool operator==(const Boundary&, const Boundary&) = default;
    };

    void clear();
    // Once a frame, with every body. Counters that go back belong to another controller: all is forgotten.
    void observe(std::span<const Move> now, const Boundary& boundary);

    [[nodiscard]] std::size_t undoable() const;
    [[nodiscard]] std::size_t redoable() const { return undone_.size(); }
    Places undo();    // also a gesture that is under way
    Places redo();    // nothing once another gesture was made
    Places revert();  // to what was accepted last, at first to the beginning; can itself be undone
    void accept();    // from here on undo and revert go back to here and no farther

    // False where there are too many, or the name is there already.
    bool snapshot(const std::string& name);
    Places restore(const std::string& name);
    [[nodiscard]] std::vector<std::string> snapshots() const;

private:
    void commit();  // ends the gesture that is under way
    Places go(const Places& to);

    bool begun_ = false;
    std::uint64_t awaited_ = 0;  // placements until go() is carried out
    int patience_ = 0;           // 0: nothing is awaited
    bool resumed_ = false;       // no boundary since go() was carried out
    Boundary boundary_;
    Places now_, base_, accepted_;
    std::deque<Places> done_;  // places before each gesture, oldest first
    std::vector<Places> undone_;
    struct Snapshot {
        std::string name;
        Places places;
    };
    std::vector<Snapshot> snapshots_;
};

}  // namespace tact
