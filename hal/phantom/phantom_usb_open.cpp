// The part on the main thread: finds the board, exchanges the first packets, starts the pump's thread.
#include <algorithm>
#include <cstdio>

#include "hal/phantom/phantom_usb.hpp"
#include "hal/probe/known_devices.hpp"
#include "hal/usb/bus_fault.hpp"
#include "hal/usb/libusb_bus.hpp"
#include "ipc/base/error.hpp"

namespace tact {

using phantom::Link;
using phantom::LinkRefusal;
using usb::BusFault;
using usb::BusFinding;

namespace {

constexpr Duration kFirstMax =
    std::chrono::seconds(2);  // until the first state, or for ten states of the longest permitted age

std::string name_of(const std::string& serial) {
    return serial.empty() ? "the arm's USB board" : "the arm's USB board " + serial;
}

std::string awaited(const BusFinding& found, const std::string& serial) {
    const std::string most =
        std::to_string(std::chrono::duration_cast<std::chrono::seconds>(PhantomUsb::kFindMax).count());
    const char* const why = found.fault == BusFault::missing  ? "it is not connected"
                            : found.fault == BusFault::denied ? "this user has no access right"
                            : found.fault == BusFault::busy   ? "another program uses it"
                                                              : "it is not ready yet";
    return "waiting up to " + most + " s for " + name_of(serial) + ": " + why;
}

[[noreturn]] void refuse(const BusFinding& found, const std::string& serial) {
    const std::string what = "opening " + name_of(serial);
    const std::string there = found.detail.empty() ? "" : "; connected: " + found.detail;
    switch (found.fault) {
        case BusFault::missing:
            throw StartupError(
                what, "no such board is connected" + there,
                "plug it in and switch it on, or correct device.serial; lsusb lists the connected devices");
        case BusFault::several:
            throw StartupError(what, "several boards are connected" + there,
                               "set device.serial in the configuration to the one to use");
        case BusFault::twins:
            throw StartupError(what, "two boards have this serial number",
                               "give each board its own serial number; until then, plug in only one of them");
        case BusFault::slow:
            throw StartupError(what, "it runs at full speed, with frames of 1 ms",
                               "plug it into a high-speed USB 2 port, without a slow hub in between");
        default:
            usb::refuse_open(what, found);
    }
}

}  // namespace

PhantomUsb::PhantomUsb(const PhantomUsbSettings& settings)
    : PhantomUsb(settings,
                 usb::make_libusb_bus({.interface = probe::kPhantomInterface, .high_speed = true})) {}

PhantomUsb::PhantomUsb(const PhantomUsbSettings& settings, std::unique_ptr<usb::Bus> bus)
    : settings_(settings),
      arm_(arm_parameters(settings.arm)),
      calibration_(arm_.parameters()),
      velocity_(arm_),
      watch_(arm_.parameters()),
      bus_(std::move(bus)),
      pump_(std::make_unique<phantom::UsbPump>(*bus_, settings.serial, settings.watchdog_max,
                                               std::max(phantom::UsbPump::kSilence, settings.hold_max))) {}

PhantomUsb::~PhantomUsb() {
    relax();
    thread_.stop();
    pump_->close();
}

DeviceInfo PhantomUsb::open() {
    if (opened_) return describe();
    find_board();
    wait_for_first_state();
    opened_ = true;
    if (settings_.thread) {
        const std::string refused =
            thread_.start(*pump_, *bus_, "usb", "the arm's USB", settings_.pump_priority);
        if (!refused.empty()) say(refused);
    }
    return describe();
}

void PhantomUsb::say(const std::string& text) const {
    if (settings_.say != nullptr) return settings_.say(text.c_str());
    std::fprintf(stderr, "%s\n", text.c_str());
}

void PhantomUsb::find_board() {
    const Instant end = bus_->now() + kFindMax;
    BusFault said = BusFault::none;
    while (true) {
        const BusFinding found = pump_->open();
        if (found.fault == BusFault::none) return;
        if (!usb::may_pass(found.fault) || bus_->now() >= end) refuse(found, settings_.serial);
        if (found.fault != said) say(awaited(found, settings_.serial));
        said = found.fault;
        static_cast<void>(bus_->wait({}, std::chrono::milliseconds(50)));
    }
}

std::string PhantomUsb::versions() const {
    return std::to_string(news_.info.version_low) + " to " + std::to_string(news_.info.version_high);
}

void PhantomUsb::wait_for_first_state() {
    const Instant end = bus_->now() + std::max<Duration>(kFirstMax, 10 * settings_.hold_max);
    while (bus_->now() < end) {
        pump_->round(std::chrono::milliseconds(5));
        if (!pump_->read(news_)) continue;
        if (news_.link == Link::refused) {
            const std::string what =
                "the arm's USB board " + std::string(phantom::text_of(news_.info.serial));
            if (news_.refusal == LinkRefusal::version) {
                throw StartupError(what,
                                   "it supports versions " + versions() + " of the protocol, this program " +
                                       std::to_string(phantom::kVersion),
                                   "update the firmware or the program to a common version");
            }
            const std::string fix = "fix the board's firmware; hal/phantom/PROTOCOL.md specifies its packets";
            if (news_.refusal == LinkRefusal::serial)
                throw StartupError(what, "its serial number differs from its USB descriptor", fix);
            throw StartupError(what,
                               "it reports values that are not permitted: a rate of " +
                                   std::to_string(news_.info.rate_hz) + " Hz with a watchdog of " +
                                   std::to_string(news_.info.watchdog_ms) + " ms",
                               fix + "; device.watchdog_us allows a watchdog of more than 100 ms");
        }
        if (news_.link == Link::open && news_.states > 0) return;
    }
    throw StartupError(
        "the arm's USB board",
        (news_.link == Link::open ? "the board sends no states (" : "the board does not answer (") +
            summary(news_.counts) + ")",
        "switch the board off and on; hal/phantom/PROTOCOL.md specifies its packets");
}

DeviceInfo PhantomUsb::describe() const {
    const ArmParameters& p = arm_.parameters();
    DeviceInfo info;
    info.name = p.name + " on " + std::string(phantom::text_of(news_.info.model));
    info.serial = std::string(phantom::text_of(news_.info.serial));
    info.workspace_half_m = p.workspace_half_m;
    info.force_n_max = p.force_n_max;
    info.force_n_continuous = p.force_n_continuous;
    info.torque_n_m_max = p.wrist == Wrist::driven ? p.torque_n_m_max.minCoeff() : 0.0;
    info.stiffness_n_m_max = p.stiffness_n_m_max;
    info.position_step_m = arm_.position_step_m(p.calibration_rad);
    return info;
}

}  // namespace tact
