// Copying plain data through shared memory without a data race.
//
// A record is copied as 64-bit words with atomic loads and stores, so that a torn read is never undefined
// behaviour; the sequence numbers around the copy show whether the words belong together. Stores release
// and loads acquire: a reader that loaded one word of a newer record is thus guaranteed to see the odd
// sequence number that was stored before it. On x86-64 these are plain moves, as relaxed ones would be.
// Fences between relaxed words would be correct too, but the thread sanitizer does not support fences and
// could not verify them.
#pragma once

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <type_traits>

#include "ipc/base/rt.hpp"

namespace tact {

template <class T>
struct SharedWords {
    static_assert(std::is_trivially_copyable_v<T> && sizeof(T) % sizeof(std::uint64_t) == 0);
    static constexpr std::size_t kCount = sizeof(T) / sizeof(std::uint64_t);

    std::atomic<std::uint64_t> word[kCount];
    static_assert(std::atomic<std::uint64_t>::is_always_lock_free);

    void store(const T& value) noexcept TACT_RT {
        const auto* const bytes = reinterpret_cast<const unsigned char*>(&value);
        for (std::size_t i = 0; i < kCount; ++i) {
            std::uint64_t w;
            std::memcpy(&w, bytes + i * sizeof w, sizeof w);
            word[i].store(w, std::memory_order_release);  // pairs with load()
        }
    }
    void load(T& value) const noexcept TACT_RT {
        auto* const bytes = reinterpret_cast<unsigned char*>(&value);
        for (std::size_t i = 0; i < kCount; ++i) {
            const std::uint64_t w = word[i].load(std::memory_order_acquire);  // pairs with store()
            std::memcpy(bytes + i * sizeof w, &w, sizeof w);
        }
    }
};

}  // namespace tact
