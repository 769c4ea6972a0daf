// Particles by their speed, and how many of each group are moved in a step of given work.
//
// Groups   G_j: 2^-(j+1) < |v| / v_max <= 2^-j, ten of them; whatever is slower is in the last.
// Law      the mean time between two moves of a particle doubles from group to group: a_j / n_j =
//          a_(j-1) / 2 n_(j-1) (SPEC section 3, equations 15 and 16), where no group has more to move than it holds.
// Turns    a group is a ring without order, and its particles are moved in turn instead of at random: the same mean,
//          and hardly one waits longer than n_j / a_j steps.
// Thread   one; memory for as many as announced is taken by the constructor
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace tact {

inline constexpr std::size_t kSpeedGroups = 10;
using GroupCounts = std::array<std::size_t, kSpeedGroups>;

// Of a speed as a share of the fastest, in [0, 1].
[[nodiscard]] std::size_t speed_group(float share) noexcept;

// How many of each group are moved, `moves` in all or as many as there are.
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
    // The particle `from` is called `to` from now on; `to` is in no group.
    void rename(std::uint32_t from, std::uint32_t to) noexcept;
    // Whose turn it is in a group that is not empty; `ahead` of it, to fetch its memory.
    [[nodiscard]] std::uint32_t next(std::size_t group, std::size_t ahead = 0) const noexcept;
    void advance(std::size_t group) noexcept;

private:
    struct Place {
        std::uint32_t slot;
        std::uint8_t group;
    };
    std::array<std::vector<std::uint32_t>, kSpeedGroups> member_;
    std::array<std::size_t, kSpeedGroups> turn_{};
    std::vector<Place> at_;  // of each particle
};

}  // namespace tact
