// Orders on their way to the servo thread. Arm and disarm have a slot each; all others share a ring.
//
// Arm, disarm   overtake all other orders and are never lost to them. The newest of each kind counts: one that was
//               not taken yet is replaced, and the answer to the newest stands for both.
// Others        in order. A ring that is full loses the oldest.
// Thread        push(): housekeeping. take(), next(): servo; neither ever waits.
#pragma once

#include <algorithm>
#include <atomic>
#include <cstdint>

#include "ipc/base/rt.hpp"
#include "ipc/shm/ring.hpp"
#include "ipc/topics/command.hpp"
#include "ipc/topics/record.hpp"

namespace tact {

class ServoOrders {
public:
    void push(const ServoOrder& order) noexcept {
        if (std::atomic<std::uint64_t>* const slot = slot_of(static_cast<CommandKind>(order.kind)))
            slot->store(std::min(order.sequence, kNone - 1), std::memory_order_relaxed);
        else
            ring_.push(order);
    }
    // An arm or a disarm, once; of all that it says only its sequence number matters. False: there is none.
    [[nodiscard]] bool take(CommandKind kind, ServoOrder& order) noexcept TACT_RT {
        std::atomic<std::uint64_t>* const slot = slot_of(kind);
        if (slot == nullptr || slot->load(std::memory_order_relaxed) == kNone) return false;
        order = {.sequence = slot->exchange(kNone, std::memory_order_relaxed),
                 .value = 0.0,
                 .kind = static_cast<std::uint32_t>(kind),
                 .index = 0};
        return true;
    }
    // The next of the others. False: there is none.
    [[nodiscard]] bool next(RingCursor& cursor, ServoOrder& order) const noexcept TACT_RT {
        return ring_.next(cursor, order);
    }

private:
    static constexpr std::uint64_t kNone = ~std::uint64_t{0};  // no sequence number: an empty slot

    // Relaxed: a slot is one word and refers to nothing else.
    std::atomic<std::uint64_t>* slot_of(CommandKind kind) noexcept {
        if (kind == CommandKind::arm) return &arm_;
        return kind == CommandKind::disarm ? &disarm_ : nullptr;
    }

    std::atomic<std::uint64_t> arm_{kNone}, disarm_{kNone};
    Ring<ServoOrder, 64> ring_{};
};
static_assert(std::atomic<std::uint64_t>::is_always_lock_free);

}  // namespace tact
