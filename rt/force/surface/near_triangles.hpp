// The triangles around the probe, from the thread that refines to the servo, which never waits.
//
// Three buffers: one is written, one is read, the newest lies between. One writer, one reader.
#pragma once

#include <array>
#include <atomic>
#include <cstdint>
#include <vector>

#include "ipc/base/rt.hpp"

namespace tact {

struct NearTriangle {
    std::array<std::array<float, 3>, 3> corner_m;  // model
    std::uint32_t number;                          // of the full mesh's triangle that it stands for
};

struct NearTriangles {
    std::array<float, 3> low_m{}, high_m{};  // the surface within this box is there, with what hangs on it
    bool complete = false;                   // false: there were more than fit
    bool full_detail = false;                // all in the filter's radius is as in the full mesh
    float deviation_m = 0.0F;                // of these triangles from the full surface, at the most
    std::uint64_t step = 0;                  // of the refinement, from 1; 0: none yet
    std::uint32_t count = 0;
    std::vector<NearTriangle> triangle;  // `count` of them mean something; never resized
};

class NearExchange {
public:
    explicit NearExchange(std::uint32_t capacity) {
        for (NearTriangles& b : buffer_) b.triangle.resize(capacity);
    }
    // Writer.
    [[nodiscard]] NearTriangles& back() noexcept { return buffer_[back_]; }
    void publish() noexcept { back_ = between_.exchange(back_ | kFresh, std::memory_order_acq_rel) & kIndex; }
    // Reader: the newest; stays as it is until the next call.
    [[nodiscard]] const NearTriangles& newest() noexcept TACT_RT {
        if ((between_.load(std::memory_order_relaxed) & kFresh) != 0)
            front_ = between_.exchange(front_, std::memory_order_acq_rel) & kIndex;
        return buffer_[front_];
    }

private:
    static constexpr std::uint32_t kFresh = 4, kIndex = 3;
    std::array<NearTriangles, 3> buffer_;
    std::uint32_t back_ = 0;
    alignas(64) std::atomic<std::uint32_t> between_{1};
    alignas(64) std::uint32_t front_ = 2;
};

}  // namespace tact
