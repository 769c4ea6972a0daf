// The files of deploy/ that a station gets, as of the build of this program (shipped_files.cpp.in).
#pragma once

namespace tact::launch::shipped {

extern const char* const kUdevRules;
extern const char* const kLimits;
extern const char* const kCanUp;
extern const char* const kCanService;
extern const char* const kStationTune;
extern const char* const kStationService;

}  // namespace tact::launch::shipped
