#include "hal/haply/inverse3.hpp"

#include <pthread.h>

#include <cstdio>

#include "ipc/base/error.hpp"
#include "ipc/base/quiet_thread.hpp"
#include "ipc/base/servo_clock.hpp"

namespace tact {

namespace {

constexpr Duration kHaplyPeriod = std::chrono::milliseconds(1);
constexpr int kFirstRounds = 100;  // until a usable pose
constexpr const char* kServiceFix =
    "install Haply's Inverse Service 3.5 or newer (haply.co, Haply Hub, or the .deb package), start it with "
    "sudo "
    "systemctl start haply-inverse-service, and set device.inverse_port to its WebSocket port";

[[noreturn]] void refuse_inverse(haply::Loss loss, const std::string& text,
                                 const Inverse3Settings& settings) {
    const std::string what = "opening the Inverse3" + (settings.serial.empty() ? "" : " " + settings.serial) +
                             " through the Inverse Service at 127.0.0.1:" + std::to_string(settings.port);
    const std::string listed = text.empty() ? "" : "; it lists: " + text;
    switch (loss) {
        case haply::Loss::no_service:
            throw StartupError(what, text,
                               std::string(kServiceFix) +
                                   "; the systemd unit tact-rt@ denies IP: deploy/units/README.md allows it");
        case haply::Loss::no_arm:
            throw StartupError(
                what, "the service does not list this arm" + listed,
                "plug the arm in, switch it on, and correct device.serial; Haply Hub shows its ID");
        case haply::Loss::several:
            throw StartupError(what, "several arms are connected" + listed,
                               "set device.serial to the ID of one");
        case haply::Loss::old_service:
            throw StartupError(
                what,
                "the service did not put the origin into the middle of the workspace: it is older "
                "than 3.5, or another program has configured the arm",
                kServiceFix);
        default:
            throw StartupError(what, "the service does not answer as documented", kServiceFix);
    }
}

}  // namespace

Inverse3::Inverse3(const Inverse3Settings& settings)
    : settings_(settings),
      own_clock_(std::make_unique<ServoClock>(Duration{0})),
      clock_(own_clock_.get()),
      channel_(std::make_unique<haply::InverseLink>(settings.port)) {}

Inverse3::Inverse3(const Inverse3Settings& settings, std::unique_ptr<haply::Channel> channel, Clock& clock)
    : settings_(settings), clock_(&clock), channel_(std::move(channel)) {}

Inverse3::~Inverse3() { close(); }

void Inverse3::close() noexcept {
    leave_.store(true, std::memory_order_relaxed);
    if (thread_.joinable()) thread_.join();
    if (pump_) pump_->finish();
    pump_.reset();
}

DeviceInfo Inverse3::open() {
    close();
    if (!settings_.serial.empty() && !haply::plain_id(settings_.serial))
        throw StartupError("device.serial = \"" + settings_.serial + "\" with driver \"inverse3\"",
                           "the ID of such an arm has letters, digits, - and _ only",
                           "set device.serial to the ID that Haply Hub shows, or remove it");
    pump_ = std::make_unique<haply::InversePump>(*channel_, settings_.serial);
    std::string text;
    haply::Loss loss = pump_->open(text);
    DeviceSample sample;
    bool sampled = false;
    for (int i = 0; loss == haply::Loss::none && !sampled && i < kFirstRounds; ++i) {
        pump_->round(clock_->now());
        sampled = pump_->read(sample, clock_->now()) != IoStatus::lost;
        if (!sampled) clock_->wait_until(clock_->now() + kHaplyPeriod);
    }
    if (loss == haply::Loss::none && !sampled) loss = haply::Loss::broken;
    if (loss != haply::Loss::none) {
        close();
        refuse_inverse(loss, text, settings_);
    }
    DeviceInfo info;
    info.name = pump_->type() == "minverse" ? "Haply Minverse" : "Haply Inverse3";
    info.serial = pump_->id();
    info.workspace_half_m =
        Vec3::Constant(pump_->type() == "minverse" ? haply::InverseLimits::kMinverseRadiusM
                                                   : haply::InverseLimits::kRadiusM);
    info.force_n_max = haply::InverseLimits::kForceN;
    info.force_n_continuous = 0.5 * haply::InverseLimits::kForceN;
    info.stiffness_n_m_max = haply::InverseLimits::kStiffnessNM;
    info.position_step_m = haply::InverseLimits::kStepM;
    if (settings_.thread) {
        leave_.store(false, std::memory_order_relaxed);
        thread_ = start_quiet_thread([this] { run(); });
        const std::string refused = raise_to_fifo(thread_.native_handle(), "the thread of the haptic device",
                                                  settings_.pump_priority);
        if (!refused.empty()) {
            if (settings_.say != nullptr)
                settings_.say(refused.c_str());
            else
                std::fprintf(stderr, "%s\n", refused.c_str());
        }
    }
    return info;
}

void Inverse3::run() noexcept {
    pthread_setname_np(pthread_self(), "inverse3");
    Instant next = clock_->now();
    while (!leave_.load(std::memory_order_relaxed)) {
        pump_->round(clock_->now());
        next = std::max(next + kHaplyPeriod, clock_->now());  // a late round is not caught up
        clock_->wait_until(next);
    }
}

void Inverse3::round() noexcept {
    if (pump_) pump_->round(clock_->now());
}

IoStatus Inverse3::read(DeviceSample& newest, Instant now) noexcept {
    return pump_ ? pump_->read(newest, now) : IoStatus::lost;
}

IoStatus Inverse3::write(const DeviceCommand& command, Instant /*now*/) noexcept {
    return pump_ ? pump_->write(command) : IoStatus::lost;
}

void Inverse3::relax() noexcept {
    if (pump_) pump_->relax();
}

haply::InverseCounts Inverse3::counts() const noexcept {
    return pump_ ? pump_->counts() : haply::InverseCounts{};
}

}  // namespace tact
