// History of level changes with their reasons, from events, in bounded memory; consecutive changes for one reason are
// one entry.
//
// Memory   kKept entries, allocated once; dropped entries are counted.  Thread  one.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "ipc/base/knob.hpp"
#include "ipc/topics/levels.hpp"

namespace tact {

struct KnobChange {
    double begin_s = 0.0, end_s = 0.0;  // on the plots' clock; below 0: before this window started
    float from = 0.0F, to = 0.0F;       // from: NaN if unknown
    std::uint32_t steps = 0;
    std::uint8_t path = 0;  // index in LevelsTopic::path
    LevelReason reason = LevelReason::start;
};

class KnobChanges {
public:
    static constexpr std::size_t kKept = 4096;
    static constexpr double kOne_s = 1.0;  // closer changes in one direction for one reason are one entry

    KnobChanges();
    // Ignores an invalid path or level, and a time before the newest change of the path.
    void add(double t_s, std::size_t path, double to, LevelReason reason);
    void clear();

    [[nodiscard]] std::size_t size() const { return kept_; }
    [[nodiscard]] std::uint64_t forgotten() const { return forgotten_; }
    // back = 0 is the newest.
    [[nodiscard]] const KnobChange& at(std::size_t back) const;
    // The newest change of a path; null: none.
    [[nodiscard]] const KnobChange* newest(std::size_t path) const;
    // The change that set the level in force at t_s; null: not kept.
    [[nodiscard]] const KnobChange* in_force(std::size_t path, double t_s) const;
    [[nodiscard]] std::size_t memory_bytes() const { return ring_.capacity() * sizeof(KnobChange); }

private:
    std::vector<KnobChange> ring_;
    std::size_t next_ = 0, kept_ = 0;
    std::uint64_t forgotten_ = 0;
    std::array<float, kPathsMax> level_{};  // after the newest change
    std::array<double, kPathsMax> at_s_{};
    std::array<bool, kPathsMax> known_{};
};

// "0.62 to 0.31 in 5 steps: force rate below goal"
[[nodiscard]] std::string knob_change_text(const KnobChange& change);

}  // namespace tact
