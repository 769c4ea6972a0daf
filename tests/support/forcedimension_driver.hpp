// The substitute library of the tests, a clock that runs it, and a fixture with the driver on both.
#pragma once

#include <dlfcn.h>

#include <cstdlib>
#include <memory>
#include <string>

#include "hal/forcedimension/force_dimension.hpp"
#include "tests/support/fake_fd.hpp"
#include "tests/support/says.hpp"
#include "tests/support/vendor_driver.hpp"

namespace tact {

inline FakeFd& fake_fd_of(const char* path) {
    void* const library = dlopen(path, RTLD_NOW | RTLD_LOCAL);
    if (library == nullptr) std::abort();
    return *reinterpret_cast<FakeFdAccess>(dlsym(library, kFakeFdAccess))();
}
inline FakeFd& fake_fd_library() {
    static FakeFd& f = fake_fd_of(TACT_FAKE_FD);
    return f;
}

class FdClock final : public PumpClock<ForceDimension> {
public:
    FdClock() : PumpClock([] { fake_fd_library().tick(); }) {}
};

inline std::string& said() {
    static std::string text;
    return text;
}

inline ForceDimensionSettings fd_settings() {
    ForceDimensionSettings s;
    s.library = TACT_FAKE_FD;
    s.thread = false;
    s.say = [](const char* text) { said() += std::string(text) + "\n"; };
    return s;
}

class ForceDimensionTest : public VendorDriverTest<ForceDimension, FdClock> {
protected:
    ForceDimensionTest() { fake().reset(); }
    static FakeFd& fake() { return fake_fd_library(); }
    static FakeFdArm& arm() { return fake().arms[0]; }

    void open() override {
        clock.device = nullptr;
        device.reset();
        device = std::make_unique<ForceDimension>(settings, clock);
        info = device->open();
        clock.device = device.get();
        command.enable = false;
    }
    [[nodiscard]] Vec3 shown() const override {
        return {arm().force_n[1].load(), arm().force_n[2].load(), arm().force_n[0].load()};
    }

    ForceDimensionSettings settings = fd_settings();
};

}  // namespace tact
