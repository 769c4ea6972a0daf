// The table is derived, not copied. On each face of the cell, the crossed edges are joined pairwise so that
// each inside corner is cut off separately. This depends on the signs of the face alone, so both cells at a
// face agree and the surface has no crack. The segments of the six faces close to loops.
//
// Diagonals cut a loop into triangles. A diagonal between two edges of one face would lie in that face, and
// the adjacent cell may have the same one: an edge with four triangles. The published tables have this
// fault. This code takes the first triangulation without such a diagonal; where none exists, it adds a
// vertex in the middle of the loop.
#include "ipc/scene/density/cell_cases.hpp"

#include <algorithm>
#include <cstddef>

namespace tact {
namespace {

// Corners of the faces, counter-clockwise as viewed from outside the cell: -x, +x, -y, +y, -z, +z.
constexpr std::array<std::array<std::uint8_t, 4>, 6> kFace{
    {{0, 4, 6, 2}, {1, 3, 7, 5}, {0, 1, 5, 4}, {2, 6, 7, 3}, {0, 2, 3, 1}, {4, 5, 7, 6}}};

std::uint8_t edge_between(std::uint8_t a, std::uint8_t b) {
    const std::uint8_t low = std::min(a, b);
    const int axis = (a ^ b) == 1 ? 0 : (a ^ b) == 2 ? 1 : 2;
    for (std::uint8_t e = 0; e < 12; ++e) {
        if (kCellEdge[e][0] == low && kCellEdge[e][1] == axis) return e;
    }
    return 0;  // not reached: kFace lists adjacent corners only
}

bool share_face(std::uint8_t e, std::uint8_t f) {
    return std::any_of(kFace.begin(), kFace.end(), [&](const auto& face) {
        int hits = 0;
        for (std::size_t i = 0; i < 4; ++i) {
            const std::uint8_t edge = edge_between(face[i], face[(i + 1) % 4]);
            hits += (edge == e || edge == f) ? 1 : 0;
        }
        return hits == 2;
    });
}

using Loop = std::vector<std::uint8_t>;
using Triangles = std::vector<std::array<std::uint8_t, 3>>;

// Triangulates loop[first..last]; its base (first, last) is already a side.
bool cut(const Loop& loop, std::size_t first, std::size_t last, Triangles& out) {
    if (last - first < 2) return true;
    for (std::size_t tip = first + 1; tip < last; ++tip) {
        if (tip - first > 1 && share_face(loop[first], loop[tip])) continue;
        if (last - tip > 1 && share_face(loop[tip], loop[last])) continue;
        const std::size_t size = out.size();
        out.push_back({loop[first], loop[tip], loop[last]});
        if (cut(loop, first, tip, out) && cut(loop, tip, last, out)) return true;
        out.resize(size);
    }
    return false;
}

CellCase make_case(unsigned inside) {
    const auto in = [&](std::uint8_t corner) { return (inside >> corner & 1U) != 0; };
    std::array<std::uint8_t, 12> next{};
    next.fill(12);
    for (const auto& face : kFace) {
        // Connects the edge at which a walk about the face enters the inside with the edge at which it next
        // leaves. The inside is on its left, viewed from outside the cell, so the loops are
        // counter-clockwise viewed from outside the surface.
        for (std::size_t i = 0; i < 4; ++i) {
            if (in(face[i]) || !in(face[(i + 1) % 4])) continue;
            std::size_t j = (i + 1) % 4;
            while (in(face[(j + 1) % 4])) j = (j + 1) % 4;
            next[edge_between(face[i], face[(i + 1) % 4])] = edge_between(face[j], face[(j + 1) % 4]);
        }
    }
    CellCase result;
    std::array<bool, 12> used{};
    for (std::uint8_t start = 0; start < 12; ++start) {
        if (next[start] == 12 || used[start]) continue;
        Loop loop;
        for (std::uint8_t e = start; !used[e]; e = next[e]) {
            used[e] = true;
            loop.push_back(e);
        }
        Triangles triangles;
        if (cut(loop, 0, loop.size() - 1, triangles)) {
            result.triangle.insert(result.triangle.end(), triangles.begin(), triangles.end());
            continue;
        }
        const auto centre = static_cast<std::uint8_t>(kCellCentre + result.centre.size());
        for (std::size_t i = 0; i < loop.size(); ++i)
            result.triangle.push_back({loop[i], loop[(i + 1) % loop.size()], centre});
        result.centre.push_back(loop);
    }
    return result;
}

}  // namespace

const std::array<CellCase, 256>& cell_cases() {
    static const std::array<CellCase, 256> cases = [] {
        std::array<CellCase, 256> made;
        for (unsigned inside = 0; inside < 256; ++inside) made[inside] = make_case(inside);
        return made;
    }();
    return cases;
}

}  // namespace tact
