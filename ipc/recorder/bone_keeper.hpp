// Keeps the drilled bone of a controller in a file (ipc/scene/bone/drilled_bone.hpp) while it is drilled.
//
// Killed    controller: the bone stays in shared memory until its last brick is written. Keeper: what was drilled in the
//           last kBoneWriteEvery is lost.
// Strokes   bricks are written with the stroke that changed them. A keeper that gets no time for more than the pause
//           between two strokes takes both for one.
// File      made with the first brick. A full disk is reported, and writing goes on when there is space.
// Ends      when the controller ends, after `seconds`, or when stop() returns true
// Thread    one; sleeps between rounds
// Errors    StartupError
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <string>

#include "ipc/base/clock.hpp"

namespace tact::record {

struct BoneKeeperSettings {
    std::filesystem::path file;  // must not exist
    std::filesystem::path
        resumed;  // file that the controller started with; empty: none. Its content comes first.
    std::string session = "default";
    double wait_s = 0.0;   // for a controller; 0: no limit
    double seconds = 0.0;  // then it ends; 0: with the controller
    std::function<bool()> stop = [] { return false; };
};

struct BoneKept {
    bool drilled = false;  // else there is no file
    bool complete = true;  // all that changed is in the file
    std::uint32_t strokes = 0;
    std::uint64_t frames = 0, bytes = 0;
};

inline constexpr Duration kBoneWriteEvery = std::chrono::milliseconds(500);

BoneKept keep_bone(const BoneKeeperSettings& settings, const std::function<void(const std::string&)>& say);

}  // namespace tact::record
