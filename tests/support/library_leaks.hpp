// Suppressions of the leak sanitizer for leaks inside libraries.
//
// libhdf5   about a hundred bytes per damaged file that it refuses.
// GDCM      80 bytes per truncated JPEG-LS image.
#pragma once

extern "C" const char* __lsan_default_suppressions();  // NOLINT(bugprone-reserved-identifier)
extern "C" [[gnu::used]] inline const char*
__lsan_default_suppressions() {  // NOLINT(bugprone-reserved-identifier)
    return "leak:libhdf5\nleak:libgdcmMSFF\n";
}
