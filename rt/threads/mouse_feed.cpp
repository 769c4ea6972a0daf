#include "rt/threads/mouse_feed.hpp"

#include <spdlog/spdlog.h>

#include <algorithm>
#include <chrono>

namespace tact {

namespace {

constexpr std::uint8_t code_of(MouseLead lead) { return static_cast<std::uint8_t>(lead); }
static_assert(MouseHand::kStaleAfter == Duration(kMouseStaleNs), "the window is told when the hand lets go");
constexpr Duration kStateEvery = std::chrono::milliseconds(100);

}  // namespace

MouseFeed::MouseFeed(const MouseFeedSettings& settings) : settings_(settings) {
    for (std::size_t i = 0; i < kMouseHands; ++i) {
        state_.lead[i] = code_of(settings_.hand[i] != nullptr ? MouseLead::may : MouseLead::none);
        state_.wanted[i] = static_cast<std::uint8_t>(settings_.wanted[i]);
    }
}

void MouseFeed::publish(std::size_t hand, const MouseTarget& target) {
    const MouseLead lead = target.holds != 0 ? MouseLead::leads : MouseLead::may;
    changed_ = changed_ || state_.lead[hand] != code_of(lead);
    state_.lead[hand] = code_of(lead);
    sent_[hand] = target;
    settings_.hand[hand]->publish(target);
}

std::uint64_t MouseFeed::pass_on(const Latest<MouseTopic>& from, Instant now) {
    const std::uint64_t count = from.count();
    MouseTopic t{};
    if (count == seen_ || !from.read(t)) return 0;
    seen_ = count;
    if (!sensible(t) || t.generation != settings_.generation || settings_.hand[t.hand] == nullptr) {
        ++state_.refused;
        return 1;
    }
    ++state_.accepted;
    const Pose T_world_tool{Vec3(t.pos_world_m), Quat(t.quat_world_tool_xyzw[3], t.quat_world_tool_xyzw[0],
                                                      t.quat_world_tool_xyzw[1], t.quat_world_tool_xyzw[2])
                                                     .normalized()};
    const Pose T_dev_tool = settings_.T_dev_world * T_world_tool;
    MouseTarget target{};
    target.arrived_ns = to_ns(now);
    std::copy_n(T_dev_tool.p_m.data(), 3, target.pos_dev_m);
    std::copy_n(T_dev_tool.q.coeffs().data(), 4, target.quat_dev_tool_xyzw);
    target.buttons = t.holds != 0 ? t.buttons : 0U;
    target.holds = t.holds;
    if (target.holds != 0) {
        changed_ = changed_ || state_.by[t.hand] != t.device;
        state_.by[t.hand] = t.device;
    }
    publish(t.hand, target);
    // One mouse holds one hand.
    const std::size_t other = 1U - t.hand;
    if (target.holds != 0 && sent_[other].holds != 0) {
        sent_[other].holds = 0;
        publish(other, sent_[other]);
    }
    return 0;
}

void MouseFeed::let_go() {
    for (std::size_t i = 0; i < kMouseHands; ++i) {
        if (sent_[i].holds == 0) continue;
        sent_[i].holds = 0;
        publish(i, sent_[i]);
    }
}

bool MouseFeed::follow(Instant now) {
    for (std::size_t i = 0; i < kMouseHands; ++i) {
        if (state_.lead[i] != code_of(MouseLead::leads) || to_ns(now) - sent_[i].arrived_ns <= kMouseStaleNs)
            continue;
        state_.lead[i] = code_of(MouseLead::stale);
        ++state_.stale;
        changed_ = true;
        spdlog::warn("no target from the {} for {} ms: hand {} relaxes", kLeadDeviceNames[state_.by[i]],
                     kMouseStaleNs / 1'000'000, i + 1);
    }
    if (!changed_ && now - told_at_ < kStateEvery) return false;
    changed_ = false;
    told_at_ = now;
    return true;
}

bool MouseFeed::leads() const {
    return std::any_of(std::begin(state_.lead), std::end(state_.lead),
                       [](std::uint8_t lead) { return lead == code_of(MouseLead::leads); });
}

MouseStateTopic MouseFeed::state(Instant now) const {
    MouseStateTopic t = state_;
    t.taken_at_ns = to_ns(now);
    return t;
}

}  // namespace tact
