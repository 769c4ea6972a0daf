#include "hal/haply/inverse_pump.hpp"

#include <exception>
#include <utility>

#include "ipc/base/shortened.hpp"

namespace tact::haply {

namespace {

constexpr double kHaplyReachM = 0.5, kHaplySpeedMS = 20.0;

bool bounded(const Vec3& v, double most) noexcept { return v.allFinite() && v.cwiseAbs().maxCoeff() <= most; }

// From x right, y away, z up to x right, y up, z to the user, and back.
Vec3 from_service(const Vec3& v) noexcept { return {v.x(), v.z(), -v.y()}; }
Vec3 to_service(const Vec3& v) noexcept { return {v.x(), -v.z(), v.y()}; }

Quat turn_from_service(const Quat& q) noexcept {
    const Vec3 axis = from_service(q.vec());
    return {q.w(), axis.x(), axis.y(), axis.z()};
}

}  // namespace

InversePump::InversePump(Channel& channel, std::string id)
    : channel_(&channel), published_(std::make_unique<Latest<InverseCounts>>()), id_(std::move(id)) {
    sample_.quat_xyzw[3] = 1.0;
}

Loss InversePump::ask(const std::string& message, InverseState& state) {
    if (!channel_->send(message)) return Loss::broken;
    const ReadResult result = channel_->receive(text_, kAnswerMax);
    if (result != ReadResult::message) return result == ReadResult::need_more ? Loss::silent : Loss::broken;
    const auto parsed = parse(text_, id_);
    if (!parsed) {
        ++counts_.refused_messages;
        return Loss::broken;
    }
    state = *parsed;
    return state.found ? Loss::none : Loss::no_arm;
}

Loss InversePump::open(std::string& text) {
    open_ = false;
    text = channel_->open();
    if (!text.empty()) return Loss::no_service;
    // On connection, the service lists all arms by itself.
    if (channel_->receive(text_, InverseLink::kOpenMax) != ReadResult::message) return Loss::silent;
    const auto inventory = parse(text_, id_);
    if (!inventory) return Loss::broken;
    for (const std::string& id : inventory->ids) text += (text.empty() ? "" : ", ") + id;
    if (!inventory->found) return inventory->ids.size() > 1 && id_.empty() ? Loss::several : Loss::no_arm;
    InverseState state;
    if (const Loss loss = ask(configure_message(inventory->id), state); loss != Loss::none) return loss;
    if (const Loss loss = ask(full_state_message(inventory->id), state); loss != Loss::none) return loss;
    // The origin and the axes are what this driver computes with: a service that ignores the request is too old.
    if (!state.configured || state.preset != kPreset || state.basis != kBasis) return Loss::old_service;
    id_ = inventory->id;  // from now on this arm, also after a loss
    type_ = state.type;
    open_ = true;
    return Loss::none;
}

void InversePump::lose(Loss why, Instant now) {
    ++counts_.lost;
    counts_.last = why;
    gate_.fail(now);
    open_ = false;
    channel_->close();
    retry_at_ = now + kReopenEvery;
}

void InversePump::round(Instant now) noexcept {
    ++counts_.rounds;
    try {
        if (open_) {
            exchange(now);
        } else if (now >= retry_at_) {
            retry_at_ = now + kReopenEvery;
            std::string text;
            const Loss loss = open(text);
            if (loss == Loss::none) {
                ++counts_.reopened;
            } else {
                counts_.last = loss;
                channel_->close();
            }
        }
    } catch (const std::exception&) {  // memory is exhausted
        lose(Loss::broken, now);
    }
    if (mail_.fetch(command_)) {
        gate_.apply(command_, now, true, !open_);
        counts_.watchdog_trips = gate_.trips();
    }
    publish();
}

std::string InversePump::next_message() {
    if (gate_.state() != DeviceState::powered) return probe_message(id_);
    const Vec3 force_n = Eigen::Map<const Vec3>(command_.force_n);
    if (force_n.allFinite())
        return force_message(id_, to_service(shortened(force_n, InverseLimits::kForceN)));
    ++counts_.refused_commands;
    return force_message(id_, Vec3::Zero());
}

void InversePump::exchange(Instant now) {
    InverseState state;
    const std::int64_t shown_ns = std::exchange(sent_answers_ns_, gate_.take_answered());
    if (const Loss loss = ask(next_message(), state); loss != Loss::none) return lose(loss, now);
    ++counts_.states;
    if (!state.usable) {
        ++counts_.not_usable;
        gate_.fail(now);
    }
    usable_ = state.usable;
    take(state, now, shown_ns);
}

void InversePump::take(const InverseState& state, Instant now, std::int64_t shown_ns) {
    if (!state.posed || !bounded(state.at_m, kHaplyReachM) || !bounded(state.speed_m_s, kHaplySpeedMS)) {
        ++counts_.refused_samples;
        return;
    }
    const Vec3 at_m = from_service(state.at_m), speed_m_s = from_service(state.speed_m_s);
    const Quat q = state.turn ? turn_from_service(*state.turn) : Quat::Identity();
    for (int i = 0; i < 3; ++i) {
        sample_.pos_m[i] = at_m[i];
        sample_.linear_m_s[i] = speed_m_s[i];
    }
    for (int i = 0; i < 4; ++i) sample_.quat_xyzw[i] = q.coeffs()[i];
    if (shown_ns != 0) sample_.delay_ns = to_ns(now) - shown_ns + kTransport.count();
    sample_.buttons = state.buttons;
    sample_.hand_present = 1;
    sample_.taken_at_ns = to_ns(now);
    ++sample_.sequence;
}

void InversePump::publish() noexcept {
    sample_.state = static_cast<std::uint8_t>(gate_.state());
    sample_.ended = open_ ? 0 : 1;
    const DeviceNotice notice =
        !open_ ? (counts_.last == Loss::silent ? DeviceNotice::silent : DeviceNotice::gone)
        : gate_.state() == DeviceState::fault
            ? (usable_ ? DeviceNotice::restarted : DeviceNotice::not_initialized)
        : gate_.state() == DeviceState::watchdog_tripped ? DeviceNotice::watchdog_tripped
                                                         : DeviceNotice::none;
    sample_.notice = static_cast<std::uint8_t>(notice);
    sample_.bus.packets = saturated(counts_.states);
    sample_.bus.refused = saturated(counts_.refused_messages + counts_.refused_samples);
    sample_.bus.transfers_failed = saturated(counts_.lost);
    sample_.bus.reconnects = saturated(counts_.reopened);
    if (sample_.sequence > 0) mail_.publish(sample_);
    published_->publish(counts_);
}

void InversePump::finish() noexcept {
    try {
        // No force from this message on. The answer is awaited: the service has then taken the message.
        InverseState state;
        if (open_) static_cast<void>(ask(probe_message(id_), state));
    } catch (const std::exception&) {
        counts_.last = Loss::broken;
    }
    channel_->close();
    open_ = false;
}

InverseCounts InversePump::counts() const noexcept {
    InverseCounts c;
    static_cast<void>(published_->read(c));
    return c;
}

}  // namespace tact::haply
