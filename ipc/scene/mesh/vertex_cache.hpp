// The order of triangles within a patch, so that what draws them transforms a vertex seldom more than once.
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
    // corner: 3 per triangle, below `vertices`; at most 65,535 of each. The order holds every triangle once.
    [[nodiscard]] std::span<const std::uint16_t> run(std::span<const std::uint16_t> corner,
                                                     std::size_t vertices);

private:
    [[nodiscard]] std::uint32_t next_fan(std::size_t vertices);

    std::vector<std::uint32_t> first_;            // of a vertex in triangle_
    std::vector<std::uint16_t> triangle_;         // at each vertex
    std::vector<std::uint16_t> live_;             // triangles of a vertex not yet taken
    std::vector<std::uint32_t> stamp_;            // when a vertex last entered the cache
    std::vector<std::uint8_t> taken_;             // per triangle
    std::vector<std::uint16_t> ring_, dead_end_;  // candidates for the next fan; vertices seen, newest last
    std::vector<std::uint16_t> order_;
    std::uint32_t time_ = 0, cursor_ = 0;
};

}  // namespace tact
