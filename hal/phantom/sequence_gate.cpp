#include "hal/phantom/packets.hpp"

namespace tact::phantom {

Order SequenceGate::refused(std::uint16_t boot, std::uint32_t sequence) noexcept {
    if (!started_) return Order::taken;
    if (boot != boot_) {
        ++counts_.restarted;
        return Order::restarted;
    }
    const auto ahead = static_cast<std::int32_t>(sequence - newest_);
    if (ahead > 0) return Order::taken;
    ++(ahead == 0 ? counts_.repeated : counts_.stale);
    return ahead == 0 ? Order::repeated : Order::stale;
}

void SequenceGate::take(std::uint16_t boot, std::uint32_t sequence) noexcept {
    if (started_) counts_.lost += sequence - newest_ - 1U;
    started_ = true;
    boot_ = boot;
    newest_ = sequence;
    ++counts_.taken;
}

Order SequenceGate::check(std::uint16_t boot, std::uint32_t sequence) noexcept {
    const Order order = refused(boot, sequence);
    if (order == Order::taken) take(boot, sequence);
    return order;
}

Order SequenceGate::check(std::uint16_t boot, std::uint32_t sequence, std::uint32_t time_us) noexcept {
    const Order order = refused(boot, sequence);
    if (order != Order::taken) return order;
    if (timed_ && static_cast<std::int32_t>(time_us - newest_us_) <= 0) {
        ++counts_.clock;
        return Order::clock;
    }
    take(boot, sequence);
    timed_ = true;
    newest_us_ = time_us;
    return order;
}

}  // namespace tact::phantom
