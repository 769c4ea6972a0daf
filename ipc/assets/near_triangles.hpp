// The triangles around the probe, as refinement leaves them.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "ipc/assets/triple_buffer.hpp"

namespace tact {

struct NearTriangle {
    std::array<std::array<float, 3>, 3> corner_m;  // model
    std::uint32_t number;                          // of the full mesh's triangle that it stands for
};

struct NearTriangles {
    std::array<float, 3> low_m{},
        high_m{};              // every active triangle whose own box reaches into this one is there
    bool complete = false;     // false: there were more than fit
    bool full_detail = false;  // all in the filter's radius is as in the full mesh
    float deviation_m = 0.0F;  // of these triangles from the full surface, at the most
    std::uint64_t step = 0;    // of the refinement, from 1; 0: none yet
    std::uint32_t count = 0;
    std::vector<NearTriangle> triangle;  // `count` of them mean something; never resized
};

class NearExchange : public TripleBuffer<NearTriangles> {
public:
    explicit NearExchange(std::uint32_t capacity)
        : TripleBuffer([&] {
              NearTriangles each;
              each.triangle.resize(capacity);
              return each;
          }()) {}
};

}  // namespace tact
