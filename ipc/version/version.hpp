// The version of this build, to trace a report, a recording or a scene to its source. Thread-safe, constant.
//
//   0.1.0                  the version of CMakeLists.txt alone: built from sources without their git history
//   0.1.0+731.g45fd877     731 commits in the history, at commit 45fd877
//   0.1.0+731.g45fd877.dirty   the same with uncommitted changes
//
// CMake's -DTACT_BUILD_VERSION=... replaces all of it (used by packages).
#pragma once

#include <string>

namespace tact {

const char* version();
// "tact-rt 0.1.0+731.g45fd877"
std::string program_version(const char* program);

}  // namespace tact
