// A USB device implemented by this program: a configfs gadget with one FunctionFS function, on a controller of
// dummy_hcd.
//
// Life     the constructor creates it, plug() and unplug() connect it to the bus, the destructor removes every
//          trace; leftovers of a killed emulator with the same serial are removed first
// Reads    of the endpoints block in the kernel; unplug() wakes them with ESHUTDOWN, and until it is plugged they
//          return EAGAIN
// Fails by StartupError with the fix: no rights, missing modules, no free controller
// Thread   plug() and unplug() on one
#pragma once

#include <string>

#include "hal/phantom/packets.hpp"

namespace tact::emu {

class Gadget {
public:
    // serial: is_serial() of script.hpp.
    Gadget(const std::string& serial, const std::string& product, std::uint16_t rate_hz);
    ~Gadget();
    Gadget(const Gadget&) = delete;
    Gadget& operator=(const Gadget&) = delete;

    void plug();
    void unplug() noexcept;
    [[nodiscard]] bool plugged() const noexcept { return plugged_; }
    [[nodiscard]] const std::string& controller() const noexcept { return controller_; }

    [[nodiscard]] int control_fd() const noexcept { return control_; }
    [[nodiscard]] int to_host_fd() const noexcept { return to_host_; }
    [[nodiscard]] int from_host_fd() const noexcept { return from_host_; }

private:
    void build(const std::string& product, std::uint16_t rate_hz);
    void remove() noexcept;

    std::string serial_, folder_, mount_point_, controller_;
    int control_ = -1, to_host_ = -1, from_host_ = -1;
    bool plugged_ = false;
};

}  // namespace tact::emu
