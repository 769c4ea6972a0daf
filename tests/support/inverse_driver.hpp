// The driver of Haply's arms with the tests' Inverse Service, and the clock that runs both.
#pragma once

#include "hal/haply/inverse3.hpp"
#include "tests/support/fake_inverse.hpp"
#include "tests/support/vendor_driver.hpp"

namespace tact {

class InverseClock final : public PumpClock<Inverse3> {
public:
    InverseClock()
        : PumpClock([this] {
              if (service != nullptr) service->tick();
          }) {}

    FakeInverse* service = nullptr;
};

inline Inverse3Settings inverse_settings() {
    Inverse3Settings s;
    s.thread = false;
    return s;
}

}  // namespace tact
