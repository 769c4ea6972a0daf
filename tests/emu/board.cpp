// The wrench at the tip from the joints' torques: tau = J^T w, so w = (J J^T + d^2)^-1 J tau, with a small d
// that keeps it finite at singularities.
#include "tests/emu/board.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "ipc/base/error.hpp"

namespace tact::emu {

namespace {

using phantom::AmplifierState;

constexpr double kSingular = 1e-3;          // metres, and radians for the wrist
constexpr std::uint32_t kStepUs = 1'000;    // longest step of the physics
constexpr std::uint32_t kPauseUs = 50'000;  // longest pause that is simulated
// The ritual, in seconds after the first command; before it the arm waits in its calibration pose. A later ritual
// begins with the way back to that pose.
constexpr double kBackS = 1.0;
constexpr double kPressS = 0.3, kReleaseS = 0.5, kLeaveS = 1.2, kFreeS = 2.2;

std::array<char, 16> text(const std::string& s) {
    std::array<char, 16> out{};
    if (s.empty() || s.size() > out.size())
        throw StartupError("emulated board \"" + s + "\"", "a name has 1 to 16 characters", "choose another");
    for (std::size_t i = 0; i < s.size(); ++i) {
        if (s[i] < ' ' || s[i] > '~')
            throw StartupError("emulated board", "the name is not printable", "use plain letters");
        out[i] = s[i];
    }
    return out;
}

std::array<std::uint16_t, 6> limits_ma(const ArmParameters& p) {
    std::array<std::uint16_t, 6> ma{};
    for (Eigen::Index i = 0; i < 6; ++i) {
        if (p.joint_n_m_per_a[i] != 0.0)
            ma[static_cast<std::size_t>(i)] =
                static_cast<std::uint16_t>(std::clamp(p.current_a_max[i] * 1e3, 0.0, 32767.0));
    }
    return ma;
}

Wrench wrench_at_tip(const ArmKinematics& arm, const Joint6& q, const Joint6& tau) noexcept {
    if (arm.parameters().wrist != Wrist::driven) {
        const Jacobian3 j = arm.jacobian(q);
        const Jacobian3 a = j * j.transpose() + kSingular * kSingular * Jacobian3::Identity();
        return {a.inverse() * (j * tau.head<3>()), Vec3::Zero()};
    }
    const Jacobian6 j = arm.jacobian6(q);
    const Jacobian6 a = j * j.transpose() + kSingular * kSingular * Jacobian6::Identity();
    const Joint6 w = a.llt().solve(j * tau);
    return {w.head<3>(), w.tail<3>()};
}

}  // namespace

EmulatedBoard::EmulatedBoard(const BoardSettings& settings)
    : settings_(settings),
      arm_(arm_parameters(settings.arm)),
      max_ma_(limits_ma(arm_.parameters())),
      amplifier_(settings.boot, max_ma_, settings.watchdog_ms * 1000U),
      hand_(settings.hand, arm_.parameters().workspace_half_m),
      zero_(settings.power_on),
      boot_(settings.boot) {
    info_.rate_hz = settings.rate_hz;
    info_.watchdog_ms = settings.watchdog_ms;
    info_.serial = text(settings.serial);
    info_.model = text(settings.model);
    info_.current_ma_max = max_ma_;
    if (settings.rate_hz < 100 || settings.rate_hz > 8000)
        throw StartupError("emulated board",
                           "the rate " + std::to_string(settings.rate_hz) + " Hz is outside 100 to 8000",
                           "choose a rate inside the range");
}

bool EmulatedBoard::hand_free() const noexcept { return ritual_s() >= kFreeS; }

double EmulatedBoard::ritual_s() const noexcept {
    return settings_.ritual ? static_cast<double>(ritual_us_) * 1e-6 / settings_.ritual_slow : kFreeS;
}

void EmulatedBoard::calibrate_again() noexcept {
    if (hand_free()) ritual_us_ = -static_cast<std::int64_t>(kBackS * 1e6 * settings_.ritual_slow);
}

double EmulatedBoard::hottest_c() const noexcept {
    double c = 0.0;
    for (const MotorHeat& h : heat_) c = std::max(c, h.winding_c);
    return c;
}

Pose EmulatedBoard::tool_pose() const noexcept {
    const double since_s = ritual_s();
    const double t =
        since_s < 0.0 ? -since_s / kBackS : std::clamp((since_s - kLeaveS) / (kFreeS - kLeaveS), 0.0, 1.0);
    if (t >= 1.0) return hand_.pose();
    const double share = t * t * (3.0 - 2.0 * t);  // starts and ends at rest
    const Pose rest = arm_.pose(arm_.parameters().calibration_rad);
    return {rest.p_m + share * (hand_.pose().p_m - rest.p_m), rest.q.slerp(share, hand_.pose().q)};
}

std::array<std::int16_t, 6> EmulatedBoard::flowing_ma() const noexcept {
    std::array<std::int16_t, 6> ma = amplifier_.current_ma();
    if (faults_.dead_drive >= 0 && faults_.dead_drive < 6)
        ma[static_cast<std::size_t>(faults_.dead_drive)] = 0;
    return ma;
}

void EmulatedBoard::step(double dt_s) noexcept {
    const ArmParameters& p = arm_.parameters();
    const std::array<std::int16_t, 6> ma = flowing_ma();
    shown_ = {};
    if (amplifier_.state() == AmplifierState::on) {
        Joint6 q;
        static_cast<void>(arm_.inverse(tool_pose(), q));
        Joint6 tau = -arm_.gravity_n_m(q);
        for (Eigen::Index i = 0; i < 6; ++i)
            tau[i] += p.joint_n_m_per_a[i] * 1e-3 * ma[static_cast<std::size_t>(i)];
        shown_ = wrench_at_tip(arm_, q, tau);
    }
    if (hand_free()) hand_.step(Duration(static_cast<std::int64_t>(dt_s * 1e9)), shown_);
    if (!p.heat_known) return;
    for (std::size_t i = 0; i < 3; ++i) heat_[i] = heated(p.heat, heat_[i], ma[i] * 1e-3, dt_s);
}

void EmulatedBoard::move(std::uint32_t now_us) noexcept {
    if (!started_) {
        started_ = true;
        moved_us_ = due_us_ = now_us;
    }
    std::uint32_t left = now_us - moved_us_;
    if (left > 0x7FFF'FFFFU) return;  // the clock went backwards
    if (spoken_ || ritual_us_ < 0) ritual_us_ += left;
    moved_us_ = now_us;
    left = std::min(left, kPauseUs);
    while (left > 0) {
        const std::uint32_t part = std::min(left, kStepUs);
        step(part * 1e-6);
        left -= part;
    }
}

void EmulatedBoard::receive(std::span<const std::byte> bytes, std::uint32_t now_us) noexcept {
    if (faults_.frozen) return;
    move(now_us);
    phantom::Query query;
    if (decode(bytes, query) == phantom::PacketFault::none) {
        info_.boot = boot_;
        spoken_ = common_version(query, info_) == phantom::kVersion;
        const auto bytes_of_info = encode(info_);
        answer_ = {bytes_of_info, bytes_of_info.size()};
        return;
    }
    if (spoken_ && !faults_.deaf) static_cast<void>(amplifier_.receive(bytes, now_us));
}

void EmulatedBoard::tick(std::uint32_t now_us) noexcept {
    move(now_us);
    const ArmParameters& p = arm_.parameters();
    std::uint16_t causes = faults_.causes;
    if (p.heat_known && hottest_c() > p.heat.winding_c_max) causes |= phantom::status::kOverTemperature;
    amplifier_.tick(now_us, causes);
    const auto late = static_cast<std::int32_t>(now_us - due_us_);
    if (late < 0) return;
    const std::uint32_t period = 1'000'000U / settings_.rate_hz;
    due_us_ += period;
    if (late > static_cast<std::int32_t>(period)) due_us_ = now_us + period;  // no bursts
    if (spoken_ && !faults_.frozen) send_state(now_us);
}

phantom::State EmulatedBoard::state(std::uint32_t now_us) noexcept {
    phantom::State s;
    s.sequence = ++sequence_;
    s.time_us = now_us;
    s.command_seen = amplifier_.command_seen();
    Joint6 q;
    static_cast<void>(arm_.inverse(tool_pose(), q));
    s.counts = arm_.counts(q, zero_);
    for (std::size_t i = 0; i < 6; ++i) {
        const std::int64_t at = std::int64_t{s.counts[i]} + faults_.jump[i];
        s.counts[i] = static_cast<std::int32_t>(std::clamp<std::int64_t>(at, INT32_MIN, INT32_MAX));
        if (static_cast<int>(i) == faults_.stuck_encoder) s.counts[i] = sent_counts_[i];
    }
    sent_counts_ = s.counts;
    s.current_ma = flowing_ma();
    s.status = amplifier_.status();
    if (faults_.count_lost) s.status |= phantom::status::kCountLost;
    const ArmParameters& p = arm_.parameters();
    const double t = ritual_s();
    if (p.calibration == CalibrationStyle::automatic && !faults_.count_lost)
        s.status |= phantom::status::kCalibrated;
    s.inputs = static_cast<std::uint16_t>(pressed_ & phantom::input::kButtons);
    if (t >= kPressS && t < kReleaseS) s.inputs |= 1U;
    if (p.calibration == CalibrationStyle::inkwell && t >= 0.0 && t < kLeaveS)
        s.inputs |= phantom::input::kInkwell;
    s.boot = boot_;
    s.commands_refused = amplifier_.refused();
    return s;
}

void EmulatedBoard::send_state(std::uint32_t now_us) noexcept {
    auto bytes = encode(state(now_us));
    if (faults_.corrupt > 0) {
        --faults_.corrupt;
        bytes[8 + sequence_ % 48] ^= std::byte{1};
    }
    if (faults_.drop > 0) {
        --faults_.drop;
        return;
    }
    if (faults_.reorder > 0 && held_back_.size == 0) {
        --faults_.reorder;
        held_back_ = {bytes, bytes.size()};
        return;
    }
    put(bytes);
    if (faults_.repeat > 0) {
        --faults_.repeat;
        put(bytes);
    }
    if (held_back_.size > 0) put(std::span(held_back_.bytes).first(held_back_.size));
    held_back_.size = 0;
}

void EmulatedBoard::put(std::span<const std::byte> bytes) noexcept {
    if (count_ == kQueue) {
        first_ = (first_ + 1) % kQueue;
        --count_;
        ++unfetched_;
    }
    Packet& p = queue_[(first_ + count_++) % kQueue];
    p.size = std::min(bytes.size(), p.bytes.size());
    std::copy_n(bytes.begin(), p.size, p.bytes.begin());
}

bool EmulatedBoard::next_packet(std::array<std::byte, 64>& packet, std::size_t& size) noexcept {
    if (answer_.size > 0) {  // an answer does not wait behind unfetched states
        packet = answer_.bytes;
        size = std::exchange(answer_.size, 0);
        return true;
    }
    if (count_ == 0) return false;
    packet = queue_[first_].bytes;
    size = queue_[first_].size;
    first_ = (first_ + 1) % kQueue;
    --count_;
    return true;
}

void EmulatedBoard::restart(std::uint32_t now_us) noexcept {
    ++boot_;
    amplifier_ = phantom::Amplifier(boot_, max_ma_, settings_.watchdog_ms * 1000U);
    for (std::size_t i = 0; i < 6; ++i) zero_[i] = settings_.power_on[i] + 101 * (boot_ - settings_.boot);
    spoken_ = false;
    sequence_ = 0;
    count_ = 0;
    answer_.size = held_back_.size = 0;
    ritual_us_ = 0;
    shown_ = {};
    moved_us_ = due_us_ = now_us;
}

}  // namespace tact::emu
