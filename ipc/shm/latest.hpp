// Seqlock value: the newest value of a state, from one writer to any number of readers, between processes.
//
// Writer   publish(): never waits; a few tens of nanoseconds per KiB
// Reader   read(): tries a bounded number of times; false leaves the caller's old value unchanged. A value
//          is returned completely or not at all.
// Death    a writer that dies inside publish() leaves the last complete value readable: it was writing to
//          another slot
// Errors   readers mask the index and limit their tries, so a faulty writer can only corrupt the value
#pragma once

#include <atomic>
#include <cstdint>

#include "ipc/base/rt.hpp"
#include "ipc/shm/words.hpp"

namespace tact {

template <class T>
class alignas(64) Latest {
public:
    static constexpr std::uint64_t kSlots = 4;
    static constexpr int kTries = 8;

    // For the single writer only. All zero bytes are a valid empty Latest.
    void publish(const T& value) noexcept TACT_RT {
        const std::uint64_t n = newest_.load(std::memory_order_relaxed) + 1;
        Slot& slot = slots_[n % kSlots];
        // Before the words, which are stored with release; pairs with the second check in read().
        slot.sequence.store(2 * n - 1, std::memory_order_relaxed);
        slot.words.store(value);
        slot.sequence.store(2 * n, std::memory_order_release);  // pairs with the first load in read()
        newest_.store(n, std::memory_order_release);            // pairs with count()
    }

    // For any reader. False: nothing published yet, or the writer lapped every try. `number` becomes count() as of
    // the value.
    [[nodiscard]] bool read(T& value, std::uint64_t* number = nullptr) const noexcept TACT_RT {
        for (int i = 0; i < kTries; ++i) {
            const std::uint64_t n = count();
            if (n == 0) return false;
            const Slot& slot = slots_[n % kSlots];
            if (slot.sequence.load(std::memory_order_acquire) != 2 * n) continue;
            T copy;
            slot.words.load(copy);
            // After the words, which are loaded with acquire; pairs with the odd store in publish().
            if (slot.sequence.load(std::memory_order_relaxed) != 2 * n) continue;
            value = copy;
            if (number != nullptr) *number = n;
            return true;
        }
        return false;
    }

    // Number of published values, to detect a new one.
    [[nodiscard]] std::uint64_t count() const noexcept TACT_RT {
        return newest_.load(std::memory_order_acquire);
    }

private:
    struct alignas(64) Slot {
        std::atomic<std::uint64_t> sequence;  // 2n - 1 while value n is being written, 2n after
        SharedWords<T> words;
    };
    std::atomic<std::uint64_t> newest_;
    Slot slots_[kSlots];
};

}  // namespace tact
