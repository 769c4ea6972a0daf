// Orders the triangles of a patch so that drawing transforms most vertices only once.
//
// Frame    none: connectivity alone, any triangles, manifold or not.
// Thread   a CacheOrder belongs to one thread; it keeps its scratch memory between calls.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace tact {

class CacheOrder {
public:
    // corner: 3 per triangle, below `vertices`; at most 65,535 of each. The order contains every triangle once.
    [[nodiscard]] std::span<const std::uint16_t> run(std::span<const std::uint16_t> corner,
                                                     std::size_t vertices);

private:
    [[nodiscard]] std::uint32_t next_fan(std::size_t vertices);

    std::vector<std::uint32_t> first_;            // start of a vertex in triangle_
    std::vector<std::uint16_t> triangle_;         // triangles at each vertex
    std::vector<std::uint16_t> live_;             // remaining triangles of a vertex
    std::vector<std::uint32_t> stamp_;            // time at which a vertex last entered the cache
    std::vector<std::uint8_t> taken_;             // per triangle
    std::vector<std::uint16_t> ring_, dead_end_;  // fan candidates; visited vertices, newest last
    std::vector<std::uint16_t> order_;
    std::uint32_t time_ = 0, cursor_ = 0;
};

}  // namespace tact
