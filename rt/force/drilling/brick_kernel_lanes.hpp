// The arithmetic of brick_kernels.hpp for TACT_LANES voxels at once. Included by brick_kernel_*.cpp, inside their
// anonymous namespaces, behind F, I and U (that many floats, int32 and uint32), root(F), any(I), levels_at(const
// std::uint8_t*), set_levels(I, std::uint8_t*) and TACT_LANE, which declares a function.
//
// GCC's vector extension: clang has it too.
// No #pragma once: each includes it for other types.

inline constexpr int kSlice = 64, kParts = kSlice / TACT_LANES;  // voxels of one z, and vectors of them

TACT_LANE F all(float value) { return F{} + value; }
TACT_LANE F least(const F& a, const F& b) { return a < b ? a : b; }
TACT_LANE F most(const F& a, const F& b) { return a > b ? a : b; }
TACT_LANE F to_float(const I& v) { return __builtin_convertvector(v, F); }
TACT_LANE I to_int(const F& v) { return __builtin_convertvector(v, I); }

TACT_LANE F lanes_at(const float* from) {
    F v;
    __builtin_memcpy(&v, from, sizeof v);
    return v;
}
TACT_LANE void put_lanes(const F& v, float* to) { __builtin_memcpy(to, &v, sizeof v); }
inline constexpr std::uint32_t kSpread = 0x9E3779B1U;  // between the random numbers of neighbours
struct Places {
    std::uint32_t number[kSlice], spread[kSlice];
    float x[kSlice], y[kSlice];
    constexpr Places() : number{}, spread{}, x{}, y{} {
        for (int i = 0; i < kSlice; ++i) {
            number[i] = static_cast<std::uint32_t>(i);
            spread[i] = number[i] * kSpread;
            x[i] = static_cast<float>(i % 8);
            y[i] = static_cast<float>(i / 8);
        }
    }
};
alignas(64) constexpr Places kPlaces;

TACT_LANE U numbers_at(const std::uint32_t* from) {
    U v;
    __builtin_memcpy(&v, from, sizeof v);
    return v;
}

using Quad [[gnu::vector_size(16)]] = std::uint32_t;
TACT_LANE std::uint32_t total_of(const U& v) {
    Quad sum{}, part;
    for (std::size_t i = 0; i < TACT_LANES / 4; ++i) {
        __builtin_memcpy(&part, reinterpret_cast<const char*>(&v) + i * sizeof part, sizeof part);
        sum += part;
    }
    return (sum[0] + sum[1]) + (sum[2] + sum[3]);
}

TACT_LANE void sum_brick(const SumJob& job, const std::uint8_t* voxels, BrickSums& out) {
    F square[kParts];
    U sum[kParts], running[kParts];
    for (int p = 0; p < kParts; ++p) {
        const F x = job.first[0] + lanes_at(kPlaces.x + p * TACT_LANES),
                y = job.first[1] + lanes_at(kPlaces.y + p * TACT_LANES);
        square[p] = job.limit - x * x - y * y;
        sum[p] = running[p] = U{};
    }
    for (int z = 0; z < 8; ++z) {
        const std::uint8_t* slice = voxels + z * kSlice;
        const float up = job.first[2] + static_cast<float>(z), up2 = up * up;
        if ((job.limit - up2) * job.per_width > -1.0F) {
            for (int p = 0; p < kParts; ++p) {
                const F t = least(most((square[p] - up2) * job.per_width, all(-1.0F)), all(1.0F));
                const F share = 0.5F + t * (0.75F - 0.25F * (t * t));
                const I weight = to_int(share * static_cast<float>(kSumOne) + 0.5F);
                sum[p] +=
                    reinterpret_cast<U>(weight) * reinterpret_cast<U>(levels_at(slice + p * TACT_LANES));
            }
        }
        for (int p = 0; p < kParts; ++p) running[p] += sum[p];
    }
    // With s_z what slice z added: running = sum of (8 - z) s_z, so the moment is that of 9 - 2 (8 - z) = 2 z - 7.
    U m0{}, mx{}, my{}, mz{};
    for (int p = 0; p < kParts; ++p) {
        const U v = numbers_at(kPlaces.number + p * TACT_LANES);
        m0 += sum[p];
        mx += sum[p] * (2U * (v & 7U) - 7U);
        my += sum[p] * (2U * (v >> 3U) - 7U);
        mz += 9U * sum[p] - 2U * running[p];
    }
    out.m0 = static_cast<std::int32_t>(total_of(m0));
    out.m1[0] = static_cast<std::int32_t>(total_of(mx));
    out.m1[1] = static_cast<std::int32_t>(total_of(my));
    out.m1[2] = static_cast<std::int32_t>(total_of(mz));
}

// In [0, 1), of 24 bits (the mixing of C. Wellons' lowbias32).
TACT_LANE F random_of(const U& number) {
    U h = number;
    h ^= h >> 16U;
    h *= 0x7FEB352DU;
    h ^= h >> 15U;
    h *= 0x846CA68BU;
    h ^= h >> 16U;
    return to_float(reinterpret_cast<I>(h >> 8U)) * 0x1p-24F;
}

// 1 - exp(-e), right to some 1e-6 of it; e >= 0.
TACT_LANE F lost_share(const F& e) {
    F share = e * (1.0F - e * (1.0F / 2) * (1.0F - e * (1.0F / 3) * (1.0F - e * (1.0F / 4))));
    const I large = e > 0.1F;
    if (any(large)) {
        const F halvings = least(e * 1.44269504F, all(100.0F));
        const I whole = to_int(halvings);
        const F g = (halvings - to_float(whole)) * 0.693147181F;
        F left = 1.0F - g * (1.0F / 8);
        for (int n = 7; n >= 1; --n) left = 1.0F - g * (1.0F / static_cast<float>(n)) * left;
        const I scale = (127 - whole) << 23;
        share = large ? 1.0F - left * reinterpret_cast<F>(scale) : share;
    }
    return share;
}

// The integral of max(0, 1 - (distance / radius)^2) over the way, in parts of it, closed: along the way it is
// start + slope s - bend s^2. Where `met` is not set nobody asks.
TACT_LANE F exposure(const F& start, const F& end, const F& slope, float bend, const I& met) {
    const I inside = (start >= 0.0F) & (end >= 0.0F);
    F share = 0.5F * (start + end) + bend * (1.0F / 6);
    if (any(met & ~inside)) {  // it comes in, goes out, or passes by
        const F square = slope * slope + (4.0F * bend) * start;
        const F half = root(most(square, all(0.0F)));
        const float per = bend > 0.0F ? 0.5F / bend : 0.0F;
        const F from = most((slope - half) * per, all(0.0F)), to = least((slope + half) * per, all(1.0F));
        const F part = (to - from) * (start + 0.5F * slope * (from + to) -
                                      (bend * (1.0F / 3)) * (from * from + from * to + to * to));
        const I passes = (square > 0.0F) & (to > from);
        share = inside ? share : (passes ? most(part, all(0.0F)) : all(0.0F));
    }
    return share;
}

TACT_LANE std::uint32_t erode_brick(const ErodeJob& job, std::uint8_t* voxels) {
    F level_start[kParts], level_slope[kParts];
    const float bend =
        job.inverse * (job.way[0] * job.way[0] + job.way[1] * job.way[1] + job.way[2] * job.way[2]);
    for (int p = 0; p < kParts; ++p) {
        const F x = job.first[0] + lanes_at(kPlaces.x + p * TACT_LANES),
                y = job.first[1] + lanes_at(kPlaces.y + p * TACT_LANES);
        level_start[p] = 1.0F - (x * x + y * y) * job.inverse;
        level_slope[p] = (x * job.way[0] + y * job.way[1]) * (2.0F * job.inverse);
    }
    U taken{};
    for (int z = 0; z < 8; ++z) {
        std::uint8_t* slice = voxels + z * kSlice;
        const float up = job.first[2] + static_cast<float>(z);
        const std::uint32_t key = job.key + static_cast<std::uint32_t>(z * kSlice) * kSpread;
        const float start_less = up * up * job.inverse, slope_more = up * job.way[2] * (2.0F * job.inverse);

        for (int p = 0; p < kParts; ++p) {
            std::uint8_t* at = slice + p * TACT_LANES;
            const I level = levels_at(at);
            const F start = level_start[p] - start_less, slope = level_slope[p] + slope_more,
                    end = start + slope - bend;
            // Between its ends a parabola rises above both by at most a quarter of its bend.
            const I met = (most(start, end) + 0.25F * bend > 0.0F) & (level > 0);
            if (!any(met)) continue;
            const F solid = to_float(level);
            const F factor = job.rate_of_solid + (255.0F - solid) * job.rate_per_level;
            const F seen = exposure(start, end, slope, bend, met);
            const F lost = met ? solid * lost_share(seen * job.rate * factor) : all(0.0F);
            const U number = numbers_at(kPlaces.spread + p * TACT_LANES) + key;
            const I gone = to_int(lost + random_of(number));
            const I less = gone < level ? gone : level;
            set_levels(level - less, at);
            taken += reinterpret_cast<U>(less);
        }
    }
    return total_of(taken);
}

struct CutSums {
    F third, fourth, fifth;  // of the powers, with their signs
};
TACT_LANE void add_corner(CutSums& s, const F& height, float sign) {
    const F u = most(height, all(0.0F)), u2 = u * u, u3 = u2 * u;
    s.third += sign * u3;
    s.fourth += sign * (u2 * u2);
    s.fifth += sign * (u2 * u3);
}

// A cube seen along the normal is the convolution of three boxes as wide as the normal's parts; its cut below a
// plane and the moments of that are sums of powers over the eight corners. Density goes linearly through a block,
// as m0 and m1 say; below none it does not go.
TACT_LANE void cut_blocks(CutBlocks& blocks) {
    for (std::size_t first = 0; first < kCuts; first += TACT_LANES) {
        const F bx = lanes_at(blocks.centre[0] + first), by = lanes_at(blocks.centre[1] + first),
                bz = lanes_at(blocks.centre[2] + first);
        const F edge = lanes_at(blocks.edge + first), m0 = lanes_at(blocks.m0 + first);
        const F mx = lanes_at(blocks.m1[0] + first), my = lanes_at(blocks.m1[1] + first),
                mz = lanes_at(blocks.m1[2] + first);
        const F far = root(most(bx * bx + by * by + bz * bz, all(1e-12F)));
        const F nx = bx / far, ny = by / far, nz = bz / far;
        const F t = least(most((lanes_at(blocks.limit + first) - far) / edge, all(-0.9F)), all(0.9F));
        // Parts below a twelfth change nothing that is felt, and would be divided by.
        const F a = most(most(nx, -nx), all(0.08F)), b = most(most(ny, -ny), all(0.08F)),
                c = most(most(nz, -nz), all(0.08F));
        CutSums s{F{}, F{}, F{}};
        add_corner(s, t + 0.5F * (a + b + c), 1.0F);
        add_corner(s, t + 0.5F * (a + b - c), -1.0F);
        add_corner(s, t + 0.5F * (a - b + c), -1.0F);
        add_corner(s, t + 0.5F * (b + c - a), -1.0F);
        add_corner(s, t + 0.5F * (a - b - c), 1.0F);
        add_corner(s, t + 0.5F * (b - a - c), 1.0F);
        add_corner(s, t + 0.5F * (c - a - b), 1.0F);
        add_corner(s, t - 0.5F * (a + b + c), -1.0F);
        const F per = 1.0F / (a * b * c);
        const F share = least(most(s.third * per * (1.0F / 6), all(0.0F)), all(1.0F));
        const F once = s.fourth * per * (1.0F / 24), twice = s.fifth * per * (1.0F / 120);
        const F first_moment = t * share - once;  // of the covered part along the normal
        const F second_moment = t * (t * share - 2.0F * once) + 2.0F * twice;
        const F along = mx * nx + my * ny + mz * nz;
        const F part = least(most(m0 * share + 12.0F * along * first_moment / edge, all(0.0F)), m0);
        put_lanes(part, blocks.cut_m0 + first);
        const F lean = m0 * edge * first_moment + along * (12.0F * second_moment - share);
        put_lanes(bx * part + lean * nx + mx * share, blocks.cut_m1[0] + first);
        put_lanes(by * part + lean * ny + my * share, blocks.cut_m1[1] + first);
        put_lanes(bz * part + lean * nz + mz * share, blocks.cut_m1[2] + first);
    }
}
