// For the leak sanitizer: what libraries lose by themselves, in tests that lead them there.
//
// libhdf5   some hundred bytes for each damaged file that it refuses.
// GDCM      80 bytes for a picture in JPEG-LS that is cut short.
#pragma once

extern "C" const char* __lsan_default_suppressions();  // NOLINT(bugprone-reserved-identifier)
extern "C" [[gnu::used]] inline const char*
__lsan_default_suppressions() {  // NOLINT(bugprone-reserved-identifier)
    return "leak:libhdf5\nleak:libgdcmMSFF\n";
}
