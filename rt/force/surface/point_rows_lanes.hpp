// The arithmetic of point_rows.hpp for TACT_LANES points at once. Each point_rows_*.cpp includes it inside its anonymous
// namespace, after F and I (that many floats and int32), root(F), bits(I) and TACT_LANE, which declares a function.
//
// No #pragma once: each file includes it with different types.

TACT_LANE F load(const float* from) {
    F v;
    __builtin_memcpy(&v, from, sizeof v);
    return v;
}
TACT_LANE void store(const F& v, float* to) { __builtin_memcpy(to, &v, sizeof v); }

TACT_LANE void find_rooms(const PointRooms& job) {
    for (std::size_t i = 0; i < job.count; i += TACT_LANES) {
        const F x = load(job.local[0] + i), y = load(job.local[1] + i), z = load(job.local[2] + i);
        F square{};
        for (int axis = 0; axis < 3; ++axis) {
            const F lever = job.turn[axis][0] * x + job.turn[axis][1] * y + job.turn[axis][2] * z;
            store(lever, job.lever[axis] + i);
            const F gone = lever + job.hand[axis] - load(job.asked[axis] + i);
            square += gone * gone;
        }
        const F bound = load(job.bound + i), left = bound - root(square) - job.taken, none{};
        const F room = left > none ? left : none;
        store(bound < none ? none + 1e30F : room, job.room + i);
    }
}

TACT_LANE std::uint64_t find_beyond(const PointsBeyond& job, std::size_t first) {
    std::uint64_t found = 0;
    for (std::size_t i = 0; i < kPointBlock; i += TACT_LANES) {
        const F x = load(job.lever[0] + first + i), y = load(job.lever[1] + first + i),
                z = load(job.lever[2] + first + i), room = load(job.room + first + i);
        const F dx = job.v[0] + job.w[1] * z - job.w[2] * y, dy = job.v[1] + job.w[2] * x - job.w[0] * z,
                dz = job.v[2] + job.w[0] * y - job.w[1] * x;
        found |= static_cast<std::uint64_t>(bits(dx * dx + dy * dy + dz * dz > job.part * (room * room)))
                 << i;
    }
    return found;
}
