// The part on the main thread: finds the device, loads its firmware, starts the pump's thread.
#include <cstdio>

#include "hal/falcon/falcon.hpp"
#include "hal/usb/bus_fault.hpp"
#include "ipc/base/error.hpp"

namespace tact {

using falcon::BootFault;
using falcon::Link;
using usb::BusFault;
using usb::BusFinding;

namespace {

constexpr Duration kFirstMax = std::chrono::seconds(90);  // with the firmware written up to three times

[[noreturn]] void refuse(const BusFinding& found, const std::string& serial) {
    const std::string what = "opening the Falcon" + (serial.empty() ? "" : " " + serial);
    const std::string there = found.detail.empty() ? "" : "; connected: " + found.detail;
    switch (found.fault) {
        case BusFault::missing:
            throw StartupError(
                what, "no such device is connected" + there,
                "plug in its USB cable and power supply, or correct device.serial; lsusb lists "
                "it as 0403:cb48");
        case BusFault::several:
            throw StartupError(what, "several are connected" + there,
                               "set device.serial in the configuration to the one to use");
        case BusFault::twins:
            throw StartupError(what, "two devices have this serial number", "unplug one of them");
        default:
            usb::refuse_open(what, found);
    }
}

[[noreturn]] void refuse(BootFault fault, const std::string& serial) {
    const std::string what = "starting the Falcon" + (serial.empty() ? "" : " " + serial);
    if (fault == BootFault::no_firmware)
        throw StartupError(what, boot_fault_text(fault),
                           "set device.firmware to the file that came with the device's own software; Tact "
                           "does not include it");
    throw StartupError(what, boot_fault_text(fault),
                       "check that its power supply is plugged in; unplug USB and power for a moment; "
                       "hal/falcon/PROTOCOL.md lists the expected replies");
}

}  // namespace

Falcon::Falcon(const FalconSettings& settings) : Falcon(settings, falcon::make_ftdi_bus()) {}

Falcon::Falcon(const FalconSettings& settings, std::unique_ptr<usb::Bus> bus)
    : settings_(settings),
      legs_(settings.geometry),
      bus_(std::move(bus)),
      pump_(std::make_unique<falcon::Pump>(*bus_, settings.serial, legs_.rad_per_count())) {}

Falcon::~Falcon() {
    relax();
    thread_.stop();
    pump_->close();
}

DeviceInfo Falcon::open() {
    if (opened_) return describe();
    if (!settings_.firmware.empty()) pump_->give(falcon::read_firmware(settings_.firmware));
    find();
    wait_for_first_reply();
    opened_ = true;
    if (settings_.thread) {
        const std::string refused =
            thread_.start(*pump_, *bus_, "falcon", "the Falcon's bus", settings_.pump_priority);
        if (!refused.empty()) say(refused);
    }
    return describe();
}

void Falcon::say(const std::string& text) const {
    if (settings_.say != nullptr) return settings_.say(text.c_str());
    std::fprintf(stderr, "%s\n", text.c_str());
}

void Falcon::find() {
    const Instant end = bus_->now() + kFindMax;
    bool said = false;
    while (true) {
        const BusFinding found = pump_->open();
        serial_ = found.serial;
        if (found.fault == BusFault::none) return;
        if (!usb::may_pass(found.fault) || bus_->now() >= end) refuse(found, settings_.serial);
        if (!said) say("waiting up to 5 s for the Falcon: it is not connected or not ready yet");
        said = true;
        static_cast<void>(bus_->wait({}, std::chrono::milliseconds(50)));
    }
}

void Falcon::wait_for_first_reply() {
    const Instant start = bus_->now();
    bool said = false;
    while (bus_->now() - start < kFirstMax) {
        pump_->round(std::chrono::milliseconds(1));
        if (!pump_->read(news_)) continue;
        if (news_.link == Link::refused) refuse(news_.boot_fault, serial_);
        if (news_.link == Link::open && news_.replies > 0) return;
        if (!said && bus_->now() - start > std::chrono::seconds(1)) {
            say("loading the Falcon's firmware: about ten seconds");
            said = true;
        }
    }
    throw StartupError("the Falcon " + serial_, "the device does not answer (" + summary(news_.counts) + ")",
                       "unplug USB and power for a moment, then plug them in again");
}

DeviceInfo Falcon::describe() const {
    DeviceInfo info;
    info.name = "Novint Falcon";
    info.serial = serial_;
    info.workspace_half_m = Vec3::Constant(falcon::kWorkspaceHalfM);
    info.force_n_max = falcon::kForceMaxN;
    info.force_n_continuous = kForceContinuousN;
    info.stiffness_n_m_max = kStiffnessNM;
    info.position_step_m = legs_.position_step_m();
    return info;
}

}  // namespace tact
