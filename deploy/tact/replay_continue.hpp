// Continues in a live run from the moment that a replay shows: its bodies, and its bone as it was drilled until then.
//
// Files    in <state folder>/from-replay, named after the recording and the moment: FILE-12.345s.json, FILE-12.345s.bone
// Errors   StartupError
// Thread   any; waits for tact-record, which copies the bone
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "ipc/topics/regions.hpp"

namespace tact::launch {

struct ReplayMoment {
    double at_s = 0.0;  // in the recording
    std::filesystem::path scene;
    std::filesystem::path poses;  // empty: the scene has no bodies
    std::filesystem::path bone;   // empty: nothing was drilled
};

// region: of a replay that waits at the moment, and serves this session.
[[nodiscard]] ReplayMoment keep_moment(const RtRegion& region, const ReplayTopic& replay,
                                       const std::string& session);
// Words of `tact` that start the live run.
[[nodiscard]] std::vector<std::string> run_words(const ReplayMoment& moment);

}  // namespace tact::launch
