#include "tests/bench/bench_mesh.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <numbers>
#include <utility>
#include <vector>

#include "ipc/base/clock.hpp"
#include "ipc/base/random.hpp"
#include "ipc/scene/mesh/mesh_cut.hpp"

namespace tact {
namespace {

constexpr std::uint32_t kTorusSide = 1024, kBaseSide = 8;

// Vertices (grid indices) in contraction order, and the target vertex of each.
struct Contractions {
    std::vector<std::uint32_t> removed;
    std::vector<std::uint32_t> into = std::vector<std::uint32_t>(std::size_t{kTorusSide} * kTorusSide);
};

Contractions contractions() {
    Contractions c;
    SeededRandom random(1);
    std::vector<std::uint32_t> round;
    const auto finish = [&] {
        for (std::size_t i = round.size(); i > 1; --i) std::swap(round[i - 1], round[random.below(i)]);
        c.removed.insert(c.removed.end(), round.begin(), round.end());
        round.clear();
    };
    for (std::uint32_t s = 1; s < kTorusSide / kBaseSide; s *= 2) {
        for (std::uint32_t i = s; i < kTorusSide; i += 2 * s) {
            for (std::uint32_t j = 0; j < kTorusSide; j += s) {
                round.push_back(i * kTorusSide + j);
                c.into[i * kTorusSide + j] = (i - s) * kTorusSide + j;
            }
        }
        finish();
        for (std::uint32_t i = 0; i < kTorusSide; i += 2 * s) {
            for (std::uint32_t j = s; j < kTorusSide; j += 2 * s) {
                round.push_back(i * kTorusSide + j);
                c.into[i * kTorusSide + j] = i * kTorusSide + j - s;
            }
        }
        finish();
    }
    return c;
}

MeshVertex torus_vertex(std::uint32_t at) {
    const std::uint32_t row = at / kTorusSide;
    const double u = 2.0 * std::numbers::pi * row / kTorusSide;
    const double v = 2.0 * std::numbers::pi * (at % kTorusSide) / kTorusSide;
    const double ring = 1.0 + 0.3 * std::cos(v);
    const auto pack = [](double x) { return static_cast<std::int16_t>(std::lround(32767.0 * x)); };
    return {{static_cast<float>(ring * std::cos(u)), static_cast<float>(ring * std::sin(u)),
             static_cast<float>(0.3 * std::sin(v))},
            {pack(std::cos(v) * std::cos(u)), pack(std::cos(v) * std::sin(u)), pack(std::sin(v)), 0}};
}

ProgressiveMeshData torus() {
    constexpr std::uint32_t kVertices = kTorusSide * kTorusSide;
    const Contractions c = contractions();
    const auto steps = static_cast<std::uint32_t>(c.removed.size());
    ProgressiveMeshData data;
    data.base_vertices = kVertices - steps;
    std::vector<std::uint32_t> number(kVertices, UINT32_MAX);
    for (std::uint32_t s = 0; s < steps; ++s) number[c.removed[s]] = kVertices - 1 - s;
    std::uint32_t next = 0;
    for (std::uint32_t& n : number) n = n == UINT32_MAX ? next++ : n;
    data.vertex.resize(kVertices);
    for (std::uint32_t at = 0; at < kVertices; ++at) data.vertex[number[at]] = torus_vertex(at);
    data.parent.resize(steps);
    data.merged.resize(steps);
    data.error_m.resize(steps + 1);
    for (std::uint32_t s = 0; s < steps; ++s) {
        const std::uint32_t k = steps - 1 - s;
        data.parent[k] = number[c.into[c.removed[s]]];
        data.merged[k] = data.vertex[data.parent[k]];
        // A changed position, so that each contraction copies a vertex.
        data.merged[k].position_m[2] += 1e-7F * static_cast<float>(s);
        data.error_m[k] = 1e-7F * static_cast<float>(s + 1);
    }
    // Triangles by counting sort on the level at which two of their corners merge.
    std::vector<std::array<std::uint32_t, 3>> triangle;
    std::vector<std::uint32_t> level;
    data.triangle_count.assign(steps + 1, 0);
    for (std::uint32_t i = 0; i < kTorusSide; ++i) {
        for (std::uint32_t j = 0; j < kTorusSide; ++j) {
            const auto at = [&](std::uint32_t di, std::uint32_t dj) {
                return number[(i + di) % kTorusSide * kTorusSide + (j + dj) % kTorusSide];
            };
            for (const auto& t :
                 {std::array{at(0, 0), at(1, 0), at(1, 1)}, std::array{at(0, 0), at(1, 1), at(0, 1)}}) {
                auto v = t;
                std::uint32_t k = 0;  // lowest level that contains the triangle, counted from the base
                while (k == 0) {
                    std::uint32_t& last = *std::max_element(v.begin(), v.end());
                    if (last < data.base_vertices) break;
                    const std::uint32_t removed = last - data.base_vertices;
                    last = data.parent[removed];
                    if (v[0] == v[1] || v[1] == v[2] || v[2] == v[0]) k = removed + 1;
                }
                triangle.push_back(t);
                level.push_back(k);
                ++data.triangle_count[k];
            }
        }
    }
    std::vector<std::uint32_t> place(steps + 1, 0);
    for (std::uint32_t k = 1; k <= steps; ++k) {
        place[k] = data.triangle_count[k - 1];
        data.triangle_count[k] += data.triangle_count[k - 1];
    }
    data.triangle.resize(3 * triangle.size());
    for (std::size_t t = 0; t < triangle.size(); ++t)
        std::copy(triangle[t].begin(), triangle[t].end(),
                  data.triangle.begin() + std::ptrdiff_t{3} * place[level[t]]++);
    return data;
}

// Percentiles of the times of `runs` runs. Unit: 1 ms / parts_per_ms.
template <class Prepare, class Timed>
Percentiles times(int runs, double parts_per_ms, Prepare&& prepare, Timed&& timed) {
    std::vector<double> all;
    for (int i = 0; i < runs; ++i) {
        prepare();
        const Instant begin = Monotonic::now();
        timed();
        all.push_back(parts_per_ms * 1e-3 * to_us(Monotonic::now() - begin));
    }
    return percentiles(all);
}

}  // namespace

MeshBench bench_mesh() {
    const ProgressiveMesh mesh(torus());
    MeshCut cut(mesh);
    const std::uint32_t all = mesh.vertices(), few = all / 100 * 28, half = all / 2;
    const auto prepare = [&](std::uint32_t vertices) {
        cut.set_vertices(vertices);
        (void)cut.changes();
    };
    MeshBench bench;
    bench.bytes_per_vertex = static_cast<double>(mesh.memory_bytes()) / all;
    bench.jump_ms = times(
        15, 1.0, [&] { prepare(all); }, [&] { prepare(few); });
    bench.jump_back_ms = times(
        15, 1.0, [&] { prepare(few); }, [&] { prepare(all); });
    bench.jump_back_walked_ms = times(
        5, 1.0,
        [&] {
            prepare(all);
            while (cut.vertices() != few) cut.approach(few, 0.0);
            (void)cut.changes();
        },
        [&] { prepare(all); });
    const auto copy_ms = [&](std::uint32_t vertices) {
        prepare(vertices);
        const std::size_t vertex_bytes = sizeof(PackedVertex) * vertices,
                          index_bytes = std::size_t{12} * cut.triangles();
        std::vector<std::byte> copy(vertex_bytes + index_bytes);
        return times(
            15, 1.0, [] {},
            [&] {
                std::memcpy(copy.data(), cut.vertex().data(), vertex_bytes);
                std::memcpy(copy.data() + vertex_bytes, cut.index().data(), index_bytes);
            });
    };
    bench.copy_ms = copy_ms(few);
    bench.copy_back_ms = copy_ms(all);
    // A walk of 1000 steps that takes t ms takes 1000 t ns per step.
    bench.ns_per_contraction = times(
        101, 1e3, [&] { prepare(half); }, [&] { cut.set_vertices(half - 1000); });
    bench.ns_per_vertex_split = times(
        101, 1e3, [&] { prepare(half - 1000); }, [&] { cut.set_vertices(half); });
    bench.changes_ms = times(
        101, 1.0,
        [&] {
            prepare(half);
            cut.set_vertices(half - 1000);
        },
        [&] { (void)cut.changes(); });
    return bench;
}

}  // namespace tact
