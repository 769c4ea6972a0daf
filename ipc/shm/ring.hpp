// A sequence of records from one writer to any number of readers, between processes.
//
// Writer   push(): never waits, overwrites the oldest
// Reader   owns a RingCursor; next() returns the next record, or false without one, and counts the records
//          that the reader missed because it was lapped. A record is returned completely or not at all, in
//          order, once.
// Death    a writer that dies inside push() has not counted that record; readers never get it
#pragma once

#include <atomic>
#include <cstdint>

#include "ipc/base/rt.hpp"
#include "ipc/shm/words.hpp"

namespace tact {

struct RingCursor {
    std::uint64_t next = 1;    // number of the next record; the first is 1
    std::uint64_t missed = 0;  // records lost to lapping so far
};

template <class T, std::uint64_t Capacity>
class alignas(64) Ring {
    static_assert(Capacity >= 4 && (Capacity & (Capacity - 1)) == 0);

public:
    static constexpr std::uint64_t kCapacity = Capacity;

    void push(const T& value) noexcept TACT_RT {
        const std::uint64_t n = pushed_.load(std::memory_order_relaxed) + 1;
        Cell& cell = cells_[n % Capacity];
        cell.sequence.store(2 * n - 1, std::memory_order_relaxed);  // before the words; pairs with next()
        cell.words.store(value);
        cell.sequence.store(2 * n, std::memory_order_release);  // pairs with the first load in next()
        pushed_.store(n, std::memory_order_release);            // pairs with pushed()
    }

    // False: nothing new. A lapped cursor moves to the oldest record that is safe to read, half a ring
    // behind the newest, and cursor.missed grows. A count that decreases (a faulty writer) resets it.
    [[nodiscard]] bool next(RingCursor& cursor, T& value) const noexcept TACT_RT {
        for (int i = 0; i < 4; ++i) {
            const std::uint64_t n = pushed();
            if (cursor.next == 0 || cursor.next > n + 1) cursor.next = n + 1;
            if (cursor.next == n + 1) return false;
            if (n - cursor.next >= Capacity - 1) lapped(cursor, n);
            const Cell& cell = cells_[cursor.next % Capacity];
            if (cell.sequence.load(std::memory_order_acquire) == 2 * cursor.next) {
                T copy;
                cell.words.load(copy);
                // After the words; pairs with the odd store in push().
                if (cell.sequence.load(std::memory_order_relaxed) == 2 * cursor.next) {
                    value = copy;
                    ++cursor.next;
                    return true;
                }
            }
            lapped(cursor, pushed());
        }
        return false;
    }

    [[nodiscard]] std::uint64_t pushed() const noexcept TACT_RT {
        return pushed_.load(std::memory_order_acquire);
    }
    // A cursor at the next record to come.
    [[nodiscard]] RingCursor tail() const noexcept { return {pushed() + 1, 0}; }

private:
    struct Cell {
        std::atomic<std::uint64_t> sequence;
        SharedWords<T> words;
    };
    static void lapped(RingCursor& cursor, std::uint64_t n) noexcept {
        const std::uint64_t oldest = n > Capacity / 2 ? n - Capacity / 2 : 1;
        if (oldest > cursor.next) {
            cursor.missed += oldest - cursor.next;
            cursor.next = oldest;
        }
    }
    std::atomic<std::uint64_t> pushed_;
    Cell cells_[Capacity];
};

}  // namespace tact
