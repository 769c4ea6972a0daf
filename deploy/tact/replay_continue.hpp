// Continues in a live run from the moment that a replay shows: its bodies, and its bone as it was drilled until then.
//
// Files    a session in <state folder>/from-replay, named after the recording and the moment: FILE-12.345s.tact-session, and FILE-12.345s.bone if
//          something was drilled
// Errors   StartupError
// Thread   any; waits for tact-record, which copies the bone
#pragma once

#include <filesystem>
#include <string>

#include "ipc/topics/regions.hpp"

namespace tact::launch {

// region: of a replay that waits at the moment, and serves this session. Returns the file, for tact run.
[[nodiscard]] std::filesystem::path keep_moment(const RtRegion& region, const ReplayTopic& replay,
                                                const std::string& session);

}  // namespace tact::launch
