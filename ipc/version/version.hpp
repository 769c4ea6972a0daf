// The name of this build, so that a report, a recording or a scene can be traced to its source. Thread-safe, constant.
//
//   0.1.0                  the version of CMakeLists.txt alone: built from sources without their history
//   0.1.0+731.g45fd877     731 commits in, at commit 45fd877
//   0.1.0+731.g45fd877.dirty   the same with changes that are not committed
//
// -DTACT_BUILD_VERSION=... of CMake replaces all of it (packages do that).
#pragma once

#include <string>

namespace tact {

const char* version();
// "tact-rt 0.1.0+731.g45fd877"
std::string program_version(const char* program);

}  // namespace tact
