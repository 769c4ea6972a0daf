// Particles grouped by speed, and how many of each group move in a step of given work.
//
// Groups   G_j: 2^-(j+1) < |v| / v_max <= 2^-j, ten of them; slower particles are in the last.
// Law      the mean time between two moves of a particle doubles from group to group: a_j / n_j =
//          a_(j-1) / 2 n_(j-1) (drilling paper, equations 15 and 16), and no group moves more than it holds.
// Turns    a group is an unordered ring, and its particles move in turn instead of at random: the same mean, and
//          hardly any waits longer than n_j / a_j steps.
// Thread   one; the constructor allocates memory for the announced maximum
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace tact {

inline constexpr std::size_t kSpeedGroups = 10;
using GroupCounts = std::array<std::size_t, kSpeedGroups>;

// Group of a speed, given as a fraction of the fastest, in [0, 1].
[[nodiscard]] std::size_t speed_group(float share) noexcept;

// Moves of each group: `moves` in total, or as many as there are particles.
[[nodiscard]] GroupCounts moves_by_group(const GroupCounts& held, double moves) noexcept;

class SpeedGroups {
public:
    explicit SpeedGroups(std::size_t most);

    [[nodiscard]] GroupCounts counts() const noexcept;
    [[nodiscard]] std::size_t held(std::size_t group) const noexcept { return member_[group].size(); }
    [[nodiscard]] std::size_t group(std::uint32_t particle) const noexcept { return at_[particle].group; }
    void add(std::uint32_t particle, std::size_t group) noexcept;
    void remove(std::uint32_t particle) noexcept;
    void move_to(std::uint32_t particle, std::size_t group) noexcept {
        if (at_[particle].group == group) return;
        remove(particle);
        add(particle, group);
    }
    // Renames particle `from` to `to`, which must be in no group.
    void rename(std::uint32_t from, std::uint32_t to) noexcept;
    // Particle whose turn it is in a non-empty group; `ahead`: a later one, to fetch its memory.
    [[nodiscard]] std::uint32_t next(std::size_t group, std::size_t ahead = 0) const noexcept;
    void advance(std::size_t group) noexcept;

private:
    struct Place {
        std::uint32_t slot;
        std::uint8_t group;
    };
    std::array<std::vector<std::uint32_t>, kSpeedGroups> member_;
    std::array<std::size_t, kSpeedGroups> turn_{};
    std::vector<Place> at_;  // per particle
};

}  // namespace tact
