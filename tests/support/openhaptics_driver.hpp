// The tests' libHD.so and the clock that runs its scheduler.
#pragma once

#include <dlfcn.h>

#include <cstdlib>

#include "hal/openhaptics/open_haptics.hpp"
#include "tests/support/fake_hd.hpp"
#include "tests/support/vendor_driver.hpp"

namespace tact {

inline FakeHd& fake_hd_library() {
    static FakeHd* const f = [] {
        void* const library = dlopen(TACT_FAKE_HD, RTLD_NOW | RTLD_LOCAL);
        if (library == nullptr) std::abort();
        return reinterpret_cast<FakeHdAccess>(dlsym(library, kFakeHdAccess))();
    }();
    return *f;
}

// The library runs one cycle of its scheduler per millisecond.
class HdClock final : public PumpClock<OpenHaptics> {
public:
    HdClock() : PumpClock([] { fake_hd_library().tick(); }) {}
};

inline OpenHapticsSettings hd_settings() {
    OpenHapticsSettings s;
    s.library = TACT_FAKE_HD;
    return s;
}

}  // namespace tact
