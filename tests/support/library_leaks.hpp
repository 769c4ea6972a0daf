// Suppressions for the leak sanitizer: leaks inside libraries, in tests that provoke them.
//
// libhdf5   some hundred bytes for each damaged file that it refuses.
// GDCM      80 bytes for a truncated JPEG-LS image.
#pragma once

extern "C" const char* __lsan_default_suppressions();  // NOLINT(bugprone-reserved-identifier)
extern "C" [[gnu::used]] inline const char*
__lsan_default_suppressions() {  // NOLINT(bugprone-reserved-identifier)
    return "leak:libhdf5\nleak:libgdcmMSFF\n";
}
