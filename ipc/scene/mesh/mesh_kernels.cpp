// Measured 2026-11-21 for the change of a million vertices to 28 %, shared core: listing 1.3 -> 0.55 ms,
// lookup 2.1 -> 1.6 ms with 16 lanes. Non-temporal stores run at 15 GB/s, others at 8, as those read first.
// Code for newer processors uses no inline function of a header, which the linker could otherwise use on
// older ones.
#include "ipc/scene/mesh/mesh_kernels.hpp"

#if defined(__x86_64__)
#include <immintrin.h>
#endif

namespace tact {
namespace {

bool always() { return true; }

inline std::uint32_t shown(const std::uint32_t* level, std::uint32_t wanted) {
    // The next version is too coarse, or is the original of the next vertex, whose UINT32_MAX wraps to 0.
    return static_cast<std::uint32_t>(level[0] >= wanted) &
           static_cast<std::uint32_t>(level[1] + 1 <= wanted);
}

// Branch-free, since a branch would be mispredicted.
std::uint32_t list_versions(const std::uint32_t* level, std::uint32_t end, std::uint32_t wanted,
                            std::uint32_t* list) {
    std::uint32_t count = 0;
    for (std::uint32_t i = 0; i < end; ++i) {
        list[count] = i;
        count += shown(level + i, wanted);
    }
    return count;
}

void follow(const std::uint32_t* parent, std::uint32_t level, std::uint32_t count, std::uint32_t* map) {
    for (std::uint32_t i = 0; i < count; ++i)
        map[i] = parent[i] < level ? parent[i] : map[parent[i] - level];  // parents come first
}

void look_up(const std::uint16_t* corner, std::uint32_t triangles, const std::uint32_t* vertex,
             std::uint32_t* to, bool) {
    for (std::uint32_t t = 0; t < triangles; ++t, corner += 3, to += 3) {
        const std::uint32_t a = vertex[corner[0]], b = vertex[corner[1]], c = vertex[corner[2]];
        const std::uint32_t alive = 0U - static_cast<std::uint32_t>((a != b) & (b != c) & (c != a));
        to[0] = a & alive;
        to[1] = b & alive;
        to[2] = c & alive;
    }
}

#if defined(__x86_64__)
bool has_avx512() { return __builtin_cpu_supports("avx512f") != 0 && __builtin_cpu_supports("avx2") != 0; }

__attribute__((target("avx512f"))) std::uint32_t list_versions_avx512(const std::uint32_t* level,
                                                                      std::uint32_t end, std::uint32_t wanted,
                                                                      std::uint32_t* list) {
    const __m512i least = _mm512_set1_epi32(static_cast<int>(wanted)), one = _mm512_set1_epi32(1);
    __m512i number = _mm512_set_epi32(15, 14, 13, 12, 11, 10, 9, 8, 7, 6, 5, 4, 3, 2, 1, 0);
    std::uint32_t count = 0, i = 0;
    for (; i + 16 <= end; i += 16) {
        const __m512i here = _mm512_loadu_si512(level + i);
        const __m512i next = _mm512_add_epi32(_mm512_loadu_si512(level + i + 1), one);
        const unsigned hit = static_cast<unsigned>(_mm512_cmpge_epu32_mask(here, least)) &
                             static_cast<unsigned>(_mm512_cmple_epu32_mask(next, least));
        _mm512_storeu_si512(list + count, _mm512_maskz_compress_epi32(static_cast<__mmask16>(hit), number));
        count += static_cast<std::uint32_t>(__builtin_popcount(hit));
        number = _mm512_add_epi32(number, _mm512_set1_epi32(16));
    }
    for (; i < end; ++i) {
        list[count] = i;
        count += shown(level + i, wanted);
    }
    return count;
}

__attribute__((target("avx512f"))) void follow_avx512(const std::uint32_t* parent, std::uint32_t level,
                                                      std::uint32_t count, std::uint32_t* map) {
    const __m512i least = _mm512_set1_epi32(static_cast<int>(level));
    std::uint32_t i = 0;
    for (; i + 16 <= count; i += 16) {
        const __m512i up = _mm512_loadu_si512(parent + i);
        const __mmask16 gone = _mm512_cmpge_epu32_mask(up, least);
        const __m512i here = _mm512_set1_epi32(static_cast<int>(level + i));
        if (_mm512_cmpge_epu32_mask(up, here) != 0) {  // parents are among these sixteen
            for (std::uint32_t j = i; j < i + 16; ++j)
                map[j] = parent[j] < level ? parent[j] : map[parent[j] - level];
            continue;
        }
        const __m512i at = _mm512_maskz_sub_epi32(gone, up, least);
        _mm512_storeu_si512(map + i, _mm512_mask_i32gather_epi32(up, gone, at, map, 4));
    }
    for (; i < count; ++i) map[i] = parent[i] < level ? parent[i] : map[parent[i] - level];
}

// Sixteen triangles at a time: 48 corners, whole cache lines.
__attribute__((target("avx2,avx512f"))) void look_up_avx512(const std::uint16_t* corner,
                                                            std::uint32_t triangles,
                                                            const std::uint32_t* vertex, std::uint32_t* to,
                                                            bool past) {
    constexpr __mmask16 kAll = 0xFFFF;
    past = past && reinterpret_cast<std::uintptr_t>(to) % 64 == 0;
    std::uint32_t t = 0;
    for (; t + 16 <= triangles; t += 16, corner += 48, to += 48) {
        // Masked forms, as g++ 12 warns about undefined registers inside the plain ones.
        __m512i v[4];
        for (int i = 0; i < 3; ++i) {
            const __m512i which = _mm512_maskz_cvtepu16_epi32(
                kAll, _mm256_loadu_si256(reinterpret_cast<const __m256i*>(corner + 16 * i)));
            v[i] = _mm512_mask_i32gather_epi32(_mm512_setzero_si512(), kAll, which, vertex, 4);
        }
        v[3] = _mm512_setzero_si512();
        std::uint64_t equal = 0, skip = 0;  // bit c: corner c equals the next; the one after that
        for (int i = 0; i < 3; ++i) {
            const __mmask16 next =
                _mm512_cmpeq_epi32_mask(v[i], _mm512_maskz_alignr_epi32(kAll, v[i + 1], v[i], 1));
            const __mmask16 after =
                _mm512_cmpeq_epi32_mask(v[i], _mm512_maskz_alignr_epi32(kAll, v[i + 1], v[i], 2));
            equal |= static_cast<std::uint64_t>(next) << (16 * i);
            skip |= static_cast<std::uint64_t>(after) << (16 * i);
        }
        const std::uint64_t dead = ((equal | equal >> 1 | skip) & 0x249249249249U) * 7;
        for (int i = 0; i < 3; ++i) {
            const __m512i alive = _mm512_maskz_mov_epi32(static_cast<__mmask16>(~dead >> (16 * i)), v[i]);
            if (past)
                _mm512_stream_si512(reinterpret_cast<__m512i*>(to + 16 * i), alive);
            else
                _mm512_storeu_si512(to + 16 * i, alive);
        }
    }
    look_up(corner, triangles - t, vertex, to, false);
    if (past) _mm_sfence();
}
#endif

}  // namespace

const MeshKernels kMeshKernels[] = {
#if defined(__x86_64__)
    {"avx512", &has_avx512, &list_versions_avx512, &follow_avx512, &look_up_avx512},
#endif
    {"generic", &always, &list_versions, &follow, &look_up},
};
const std::size_t kMeshKernelCount = sizeof(kMeshKernels) / sizeof(kMeshKernels[0]);

const MeshKernels& fastest_mesh_kernels() {
    const MeshKernels* kernels = kMeshKernels;
    while (!kernels->runs_here()) ++kernels;
    return *kernels;
}

}  // namespace tact
