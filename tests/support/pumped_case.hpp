// The case of a driver on a PumpClock in the contract suite.
#pragma once

#include <algorithm>
#include <functional>
#include <memory>

#include "tests/contract/haptic_device_contract.hpp"
#include "tests/support/vendor_driver.hpp"

namespace tact {

// make: a fresh emulated device and its driver on the clock, which outlives the suite.
template <class Device>
DeviceCase pumped_case(const char* name, PumpClock<Device>& clock,
                       const std::function<std::unique_ptr<Device>()>& make) {
    return {name,
            [&clock, make]() -> std::unique_ptr<HapticDevice> {
                clock.device = nullptr;
                clock.jump(Monotonic::now());
                std::unique_ptr<Device> device = make();
                clock.device = device.get();
                return device;
            },
            [&clock](Instant now, Duration d) {
                clock.wait_until(std::max(now, clock.now()) + d);
                return clock.now();
            }};
}

}  // namespace tact
