// tact-emu: devices behind the kernel's own interfaces, for tests without hardware.
//
// Exit  0  it ended normally: by a signal, an order, or after its time
//       1  it could not start; one message gives problem, cause and fix
//       2  wrong usage
#include <poll.h>
#include <signal.h>
#include <sys/signalfd.h>
#include <unistd.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <array>
#include <cstdio>
#include <memory>
#include <set>
#include <string>
#include <vector>

#include "ipc/base/error.hpp"
#include "ipc/version/version.hpp"
#include "tests/emu/can_head.hpp"
#include "tests/emu/lines_part.hpp"
#include "tests/emu/part_requests.hpp"
#include "tests/emu/report.hpp"
#include "tests/emu/script.hpp"
#include "tests/emu/usb_arm.hpp"

namespace {

using namespace tact;
using namespace tact::emu;

struct Options {
    std::vector<std::string> arms;
    std::string tracker, faults, hand = "wander";
    double seconds = 0.0;
    unsigned rate_hz = 1000, watchdog_ms = 10;
    double slow = 1.0;
    std::uint64_t seed = 1;
    bool orders = false, json = false, check = false, no_ritual = false, unplugged = false;
    bool lines = false;
};

void describe(CLI::App& app, Options& o) {
    app.add_option("--arm", o.arms, "Arm on USB (dummy_hcd), as SERIAL[:MODEL]; repeat for more arms");
    app.add_option("--tracker", o.tracker,
                   "Head tracker on CAN, as INTERFACE[:classic|fd[:RATE_HZ[:SENSORS]]]");
    app.add_flag("--lines", o.lines, "Safety inputs on a CP2112 adapter (uhid, hid-cp2112)");
    app.add_option("--faults", o.faults, "File with faults and their times; the orders are listed below");
    app.add_flag("--orders", o.orders, "Read the same orders from standard input, one per line");
    app.add_option("--seconds", o.seconds, "Length of the run (s); 0: until a signal or the order \"leave\"")
        ->check(CLI::Range(0.0, 1e7));
    app.add_option("--rate-hz", o.rate_hz, "Rate of the arms' states (Hz)")->check(CLI::Range(100, 8000));
    app.add_option("--watchdog-ms", o.watchdog_ms,
                   "Watchdog of the arms (ms); larger for emulated processors")
        ->check(CLI::Range(1, 60'000));
    app.add_option("--hand", o.hand, "Motion of the hands on the arms: passive, wander or stroke");
    app.add_option("--seed", o.seed, "Random seed for the motion of hands and head");
    app.add_flag("--no-ritual", o.no_ritual, "Leave out the calibration ritual of the arms");
    app.add_option("--slow", o.slow, "Factor on the duration of the calibration ritual")
        ->check(CLI::Range(0.6, 100.0));
    app.add_flag("--unplugged", o.unplugged, "Start with the arms unplugged, until the order \"plug\"");
    app.add_flag("--json", o.json, "Print reports as JSON, one object per line");
    app.add_flag("--check", o.check, "Read and check all options and files, then exit");
    std::string orders = "Orders, each optionally after \"at SECONDS s\":\n";
    for (const ActionRow& row : actions()) {
        std::string usage = row.words;
        for (const NumberRange& n : row.numbers) usage += std::string(" ") + n.name;
        if (row.part == Part::arm) usage += " [ARM]";
        orders +=
            "  " + usage + std::string(usage.size() < 32 ? 32 - usage.size() : 1, ' ') + row.what + "\n";
    }
    app.footer(orders);
}

// Orders from a pipe or a terminal, one line at a time.
class Input {
public:
    // False: the input ended.
    bool take(std::vector<std::string>& lines) {
        std::array<char, 1024> bytes{};
        const ssize_t n = ::read(STDIN_FILENO, bytes.data(), bytes.size());
        if (n <= 0) return false;
        for (const char c : std::span(bytes).first(static_cast<std::size_t>(n))) {
            if (c == '\n') {
                lines.push_back(std::exchange(line_, {}));
            } else if (line_.size() <= kLineMax) {  // one more than allowed, so that the line is refused
                line_ += c;
            }
        }
        return true;
    }

private:
    std::string line_;
};

class Emulator {
public:
    Emulator(const Options& o, Report& report, std::vector<Order> script)
        : report_(report), script_(std::move(script)), seconds_(o.seconds), listens_(o.orders) {
        std::uint16_t boot = static_cast<std::uint16_t>(o.seed);
        for (const std::string& text : o.arms) {
            const ArmRequest request = parse_arm(text);
            BoardSettings s;
            s.arm = request.metrics;
            s.serial = request.serial;
            s.hand.script = o.hand;
            s.hand.seed = o.seed + arms_.size();
            s.rate_hz = static_cast<std::uint16_t>(o.rate_hz);
            s.watchdog_ms = static_cast<std::uint16_t>(o.watchdog_ms);
            s.boot = ++boot;
            s.ritual = !o.no_ritual;
            s.ritual_slow = o.slow;
            arms_.push_back(std::make_unique<UsbArm>(s, report));
        }
        if (o.lines) lines_ = std::make_unique<LinesPart>(report);
        if (!o.tracker.empty()) {
            const TrackerRequest request = parse_tracker(o.tracker);
            SimHeadSettings s;
            s.can = request.can;
            s.seed = o.seed;
            tracker_ = std::make_unique<CanHead>(s, request.interface, report);
        }
    }

    void start(bool plugged) {
        for (const auto& arm : arms_) arm->start();
        if (tracker_) tracker_->start();
        start_ = Monotonic::now();
        if (plugged) apply({.at = {}, .action = Action::plug, .numbers = {}, .arm = {}});
        if (lines_) lines_->apply({.at = {}, .action = Action::lines_plug, .numbers = {}, .arm = {}});
        report_.say({Monotonic::now(), "emulator", "", "state", "ready"});
    }

    void run(int signals) {
        while (!over_) {
            const Instant now = Monotonic::now();
            if (next_ < script_.size() && now - start_ >= script_[next_].at.value_or(Duration{0})) {
                try_to_obey(script_[next_++]);
                continue;
            }
            if (seconds_ > 0.0 && to_s(now - start_) >= seconds_) break;
            std::array<pollfd, 2> wait{pollfd{signals, POLLIN, 0},
                                       pollfd{listens_ ? STDIN_FILENO : -1, POLLIN, 0}};
            if (::poll(wait.data(), wait.size(), wait_ms(now)) <= 0) continue;
            if (wait[0].revents != 0) break;
            if (wait[1].revents != 0) listen();
        }
        report_.say({Monotonic::now(), "emulator", "", "state", "leaving"});
    }

private:
    [[nodiscard]] int wait_ms(Instant now) const {
        Duration left = std::chrono::seconds(1);
        if (next_ < script_.size())
            left = std::min(left, start_ + script_[next_].at.value_or(Duration{0}) - now);
        if (seconds_ > 0.0)
            left = std::min(left, start_ + Duration(static_cast<std::int64_t>(seconds_ * 1e9)) - now);
        return static_cast<int>(left / std::chrono::milliseconds(1)) + 1;
    }

    void listen() {
        std::vector<std::string> lines;
        if (!input_.take(lines)) listens_ = false;
        for (const std::string& line : lines) {
            try {
                if (auto order = parse_order(line, "order")) {
                    if (order->at) {
                        later(std::move(*order));
                    } else {
                        apply(*order);
                    }
                }
            } catch (const std::exception& e) {
                refused(e.what());
            }
        }
    }

    // Adds an order at its place among the pending ones.
    void later(Order order) {
        order.at = *order.at + (Monotonic::now() - start_);
        const auto place =
            std::upper_bound(script_.begin() + static_cast<std::ptrdiff_t>(next_), script_.end(), order,
                             [](const Order& a, const Order& b) { return a.at < b.at; });
        if (script_.size() < 2 * kOrdersMax) script_.insert(place, std::move(order));
    }

    void refused(const std::string& why) { report_.say({Monotonic::now(), "emulator", "", "refused", why}); }

    void try_to_obey(const Order& order) {
        try {
            apply(order);
        } catch (const std::exception& e) {
            refused(e.what());
        }
    }

    void apply(const Order& order) {
        if (order.action == Action::leave) over_ = true;
        if (order.action == Action::status) {
            for (const auto& arm : arms_) arm->say_status();
            if (tracker_) tracker_->say_status();
            if (lines_) lines_->say_status();
        }
        const Part part = row_of(order.action).part;
        bool done = part == Part::all;
        for (const auto& arm : arms_)
            if (order.arm.empty() || order.arm == arm->serial()) done |= arm->apply(order);
        if (tracker_) done |= tracker_->apply(order);
        if (lines_) done |= lines_->apply(order);
        if (!done && !(part == Part::arm && arms_.empty() && order.action == Action::plug))
            refused(std::string(row_of(order.action).words) + ": unknown part " + order.arm);
    }

    Report& report_;
    std::vector<Order> script_;
    std::size_t next_ = 0;
    double seconds_;
    bool listens_, over_ = false;
    Instant start_{};
    Input input_;
    std::vector<std::unique_ptr<UsbArm>> arms_;
    std::unique_ptr<CanHead> tracker_;
    std::unique_ptr<LinesPart> lines_;
};

void check(const Options& o) {
    if (o.arms.empty() && o.tracker.empty() && !o.lines)
        throw StartupError("tact-emu", "no part is requested",
                           "give --arm SERIAL, --tracker INTERFACE or --lines");
    std::set<std::string> serials;
    for (const std::string& text : o.arms) {
        if (!serials.insert(parse_arm(text).serial).second)
            throw StartupError("--arm " + text, "another arm has this serial",
                               "give each arm its own serial");
    }
    if (!o.tracker.empty()) static_cast<void>(checked(parse_tracker(o.tracker).can));
}

int run(const Options& o) {
    check(o);
    std::vector<Order> script = o.faults.empty() ? std::vector<Order>{} : read_script(o.faults);
    if (o.check) {
        std::printf("tact-emu: parts and %zu orders: no problems\n", script.size());
        return 0;
    }
    // Before the first thread, which inherits the mask. A closed reader does not end the emulator.
    signal(SIGPIPE, SIG_IGN);
    sigset_t stop;
    sigemptyset(&stop);
    for (const int s : {SIGINT, SIGTERM, SIGHUP}) sigaddset(&stop, s);
    pthread_sigmask(SIG_BLOCK, &stop, nullptr);
    const int signals = signalfd(-1, &stop, SFD_CLOEXEC);

    Report report(o.json);
    Emulator emulator(o, report, std::move(script));
    emulator.start(!o.unplugged);
    emulator.run(signals);
    return 0;
}

}  // namespace

int main(int argc, char** argv) {
    CLI::App app{
        "tact-emu: emulated devices behind the kernel's USB, CAN and GPIO, for tests without hardware"};
    app.set_version_flag("--version", program_version("tact-emu"));
    Options options;
    describe(app, options);
    try {
        app.parse(argc, argv);
    } catch (const CLI::ParseError& e) {
        return app.exit(e) == 0 ? 0 : 2;
    }
    try {
        return run(options);
    } catch (const std::exception& e) {
        std::fprintf(stderr, "tact-emu: %s\n", e.what());
        return 1;
    }
}
