// Passes the newest value from one thread to another in a process, wait-free and without copies.
//
// Three buffers: one being written, one being read, and the newest in between. One writer, one reader.
#pragma once

#include <array>
#include <atomic>
#include <cstdint>

#include "ipc/base/rt.hpp"

namespace tact {

template <class T>
class TripleBuffer {
public:
    TripleBuffer() = default;
    explicit TripleBuffer(const T& each) : buffer_{each, each, each} {}
    // Writer.
    [[nodiscard]] T& back() noexcept TACT_RT { return buffer_[back_]; }
    void publish() noexcept TACT_RT {
        back_ = between_.exchange(back_ | kFresh, std::memory_order_acq_rel) & kIndex;
    }
    // Reader: the newest value; unchanged until the next call.
    [[nodiscard]] const T& newest() noexcept TACT_RT {
        if ((between_.load(std::memory_order_relaxed) & kFresh) != 0)
            front_ = between_.exchange(front_, std::memory_order_acq_rel) & kIndex;
        return buffer_[front_];
    }
    // Reader: the value of the last newest().
    [[nodiscard]] const T& same() const noexcept TACT_RT { return buffer_[front_]; }

private:
    static constexpr std::uint32_t kFresh = 4, kIndex = 3;
    std::array<T, 3> buffer_{};
    std::uint32_t back_ = 0;
    alignas(64) std::atomic<std::uint32_t> between_{1};
    alignas(64) std::uint32_t front_ = 2;
};

}  // namespace tact
