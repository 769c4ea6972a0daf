#include "tests/emu/usb_arm.hpp"

#include <linux/usb/ch9.h>
#include <linux/usb/functionfs.h>
#include <poll.h>
#include <time.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>

#include "tests/emu/usb_descriptors.hpp"

namespace tact::emu {

namespace {

constexpr Duration kNotYet = std::chrono::milliseconds(2);  // after a transfer that ended with ESHUTDOWN
constexpr Duration kNews = std::chrono::milliseconds(100);  // how often a thread checks whether to end
constexpr Duration kLate =
    std::chrono::milliseconds(50);  // with more delay, the clock restarts at the current time

std::uint32_t board_us(Instant now) noexcept { return static_cast<std::uint32_t>(to_ns(now) / 1000); }

void sleep_until(Instant t) noexcept {
    const timespec ts{to_ns(t) / 1'000'000'000, to_ns(t) % 1'000'000'000};
    while (clock_nanosleep(CLOCK_MONOTONIC, TIMER_ABSTIME, &ts, nullptr) == EINTR) {
    }
}

const char* name_of(phantom::AmplifierState s) noexcept {
    switch (s) {
        case phantom::AmplifierState::off:
            return "off";
        case phantom::AmplifierState::on:
            return "on";
        case phantom::AmplifierState::tripped:
            return "tripped";
        case phantom::AmplifierState::fault:
            return "fault";
    }
    return "unknown";
}

}  // namespace

UsbArm::UsbArm(const BoardSettings& settings, Report& report)
    : serial_(settings.serial),
      report_(report),
      board_(settings),
      gadget_(settings.serial, "Tact arm (emulated)", settings.rate_hz),
      tick_(std::chrono::nanoseconds(500'000'000 / settings.rate_hz)) {}

UsbArm::~UsbArm() {
    leave_.store(true);
    gadget_.unplug();  // ends blocked transfers
    fresh_.notify_all();
    plugged_in_.notify_all();
    for (std::thread* t : {&clock_, &to_host_, &from_host_, &control_})
        if (t->joinable()) t->join();
}

void UsbArm::start() {
    if (clock_.joinable()) return;
    clock_ = std::thread([this] { live_clock(); });
    control_ = std::thread([this] { live_control(); });
    to_host_ = std::thread([this] { live_to_host(); });
    from_host_ = std::thread([this] { live_from_host(); });
}

void UsbArm::say(const char* what, std::string detail, Instant at) noexcept {
    report_.say({at, "arm", serial_, what, std::move(detail)},
                {{"states", states_.load()}, {"commands", commands_.load()}});
}

void UsbArm::say_status() {
    const std::lock_guard lock(mutex_);
    const auto& a = board_.amplifier();
    report_.say({Monotonic::now(), "arm", serial_, "status", name_of(a.state())},
                {{"plugged", gadget_.plugged() ? 1U : 0U},
                 {"configured", configured_ ? 1U : 0U},
                 {"states", states_.load()},
                 {"commands", commands_.load()},
                 {"command_seen", a.command_seen()},
                 {"refused", a.refused()},
                 {"unfetched", board_.unfetched()},
                 {"bits", a.status()},
                 {"flowing", seen_.flowing ? 1U : 0U}});
}

// Reports each change of the board once, with the time of the step that caused it.
void UsbArm::look(Instant now) noexcept {
    if (board_.hand_free() != seen_.hand_free)
        say("hand", (seen_.hand_free = board_.hand_free()) ? "free" : "calibrates", now);
    const phantom::Amplifier& a = board_.amplifier();
    if (a.state() != seen_.amplifier) say("amplifier", name_of(seen_.amplifier = a.state()), now);
    const auto& ma = a.current_ma();
    const bool flowing = std::any_of(ma.begin(), ma.end(), [](std::int16_t i) { return i != 0; });
    if (flowing != seen_.flowing) say("currents", (seen_.flowing = flowing) ? "flowing" : "zero", now);
}

void UsbArm::live_clock() noexcept {
    Instant due = Monotonic::now();
    while (!leave_.load(std::memory_order_relaxed)) {
        due += tick_;
        sleep_until(due);
        const std::lock_guard lock(mutex_);
        const Instant now = Monotonic::now();
        if (now - due > kLate) due = now;
        if (thaw_at_ != Instant{} && now >= thaw_at_) {
            thaw_at_ = Instant{};
            board_.faults().frozen = false;
            say("silence", "over", now);
        }
        board_.tick(board_us(now));
        look(now);
        fresh_.notify_one();
    }
}

bool UsbArm::is_configured() noexcept {
    std::unique_lock lock(mutex_);
    return plugged_in_.wait_for(lock, kNews, [this] { return leave_.load() || configured_; });
}

void UsbArm::configured_is(bool on) noexcept {
    const std::lock_guard lock(mutex_);
    if (configured_ == on) return;
    configured_ = on;
    std::array<std::byte, kPacketBytesMax> packet{};
    for (std::size_t size = 0; on && board_.next_packet(packet, size);) {  // from before it was plugged in
    }
    plugged_in_.notify_all();
    say("usb", on ? "configured" : "gone", Monotonic::now());
}

void UsbArm::live_to_host() noexcept {
    std::array<std::byte, kPacketBytesMax> packet{};
    while (!leave_.load(std::memory_order_relaxed)) {
        if (!is_configured()) continue;
        if (stall_.exchange(false)) {
            // FunctionFS halts an endpoint that is used in the wrong direction, but not while a packet lies in its
            // FIFO.
            const ssize_t n = ::read(gadget_.to_host_fd(), packet.data(), packet.size());
            const bool later = n < 0 && errno == EAGAIN;
            if (later) {
                stall_.store(true);
                sleep_until(Monotonic::now() + kNotYet);
                continue;
            }
            say("stall", n < 0 && errno == EBADMSG ? "halted" : "not halted", Monotonic::now());
        }
        std::size_t size = 0;
        {
            std::unique_lock lock(mutex_);
            fresh_.wait_for(lock, kNews, [&] {
                return leave_.load(std::memory_order_relaxed) || board_.next_packet(packet, size);
            });
        }
        if (size == 0) continue;
        if (::write(gadget_.to_host_fd(), packet.data(), size) == static_cast<ssize_t>(size)) {
            states_.fetch_add(1, std::memory_order_relaxed);
        } else {
            sleep_until(Monotonic::now() + kNotYet);
        }
    }
}

void UsbArm::live_from_host() noexcept {
    std::array<std::byte, kPacketBytesMax> packet{};
    while (!leave_.load(std::memory_order_relaxed)) {
        if (!is_configured()) continue;
        const ssize_t n = ::read(gadget_.from_host_fd(), packet.data(), packet.size());
        if (n < 0) {
            sleep_until(Monotonic::now() + kNotYet);
            continue;
        }
        const std::lock_guard lock(mutex_);
        const Instant now = Monotonic::now();
        commands_.fetch_add(1, std::memory_order_relaxed);
        board_.receive(std::span(packet).first(static_cast<std::size_t>(n)), board_us(now));
        look(now);
        fresh_.notify_one();
    }
}

void UsbArm::live_control() noexcept {
    while (!leave_.load(std::memory_order_relaxed)) {
        pollfd ready{gadget_.control_fd(), POLLIN, 0};
        if (::poll(&ready, 1, static_cast<int>(kNews / std::chrono::milliseconds(1))) <= 0) continue;
        usb_functionfs_event event{};
        if (::read(gadget_.control_fd(), &event, sizeof event) != static_cast<ssize_t>(sizeof event)) {
            sleep_until(Monotonic::now() + kNotYet);
            continue;
        }
        if (event.type == FUNCTIONFS_ENABLE) configured_is(true);
        if (event.type == FUNCTIONFS_DISABLE || event.type == FUNCTIONFS_UNBIND) configured_is(false);
        if (event.type == FUNCTIONFS_SETUP) {  // no request is supported: the wrong direction refuses it
            std::byte none{};
            const bool in = (event.u.setup.bRequestType & USB_DIR_IN) != 0;
            const ssize_t refused =
                in ? ::read(gadget_.control_fd(), &none, 0) : ::write(gadget_.control_fd(), &none, 0);
            static_cast<void>(refused);
        }
    }
}

void UsbArm::fault_of(const Order& o) {
    BoardFaults& f = board_.faults();
    const auto n = static_cast<unsigned>(o.numbers[0]);
    switch (o.action) {
        case Action::silence:
            f.frozen = true;
            thaw_at_ = Monotonic::now() + std::chrono::milliseconds(n);
            break;
        case Action::corrupt:
            f.corrupt = n;
            break;
        case Action::repeat:
            f.repeat = n;
            break;
        case Action::reorder:
            f.reorder = n;
            break;
        case Action::drop:
            f.drop = n;
            break;
        case Action::brown_out:
            f.causes |= phantom::status::kBrownOut;
            break;
        case Action::hot:
            f.causes |= phantom::status::kOverTemperature;
            break;
        case Action::over_current:
            f.causes |= phantom::status::kOverCurrent;
            break;
        case Action::safety_open:
            f.causes |= phantom::status::kSafetyOpen;
            break;
        case Action::count_lost:
            f.count_lost = true;
            break;
        case Action::encoder_stuck:
            f.stuck_encoder = o.numbers[0];
            break;
        case Action::encoder_jump:
            f.jump[n] += o.numbers[1];
            break;
        case Action::drive_dead:
            f.dead_drive = o.numbers[0];
            break;
        case Action::deaf:
            f.deaf = true;
            break;
        case Action::restart:
            board_.restart(board_us(Monotonic::now()));
            break;
        case Action::press:
            board_.press(static_cast<std::uint16_t>(n));
            break;
        case Action::hand_hold:
            board_.hold(1e-3 * Vec3(o.numbers[0], o.numbers[1], o.numbers[2]));
            break;
        case Action::hand_free:
            board_.hold(std::nullopt);
            break;
        case Action::calibrate:
            board_.calibrate_again();
            break;
        default:  // well
            f = {};
            thaw_at_ = Instant{};
            break;
    }
}

bool UsbArm::apply(const Order& order) {
    if (row_of(order.action).part != Part::arm) return false;
    if (order.action == Action::plug) {
        gadget_.plug();
        say("usb", "plugged", Monotonic::now());
    } else if (order.action == Action::unplug) {
        const Instant at = Monotonic::now();
        gadget_.unplug();
        say("usb", "unplugged", at);
    } else if (order.action == Action::stall) {
        stall_.store(true);
        say("fault", "stall", Monotonic::now());
    } else {
        const std::lock_guard lock(mutex_);
        const Instant now = Monotonic::now();
        fault_of(order);
        say("fault", row_of(order.action).words, now);
        look(now);
    }
    return true;
}

}  // namespace tact::emu
