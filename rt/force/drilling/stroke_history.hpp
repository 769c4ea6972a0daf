// What bricks held before each stroke of the burr, so that strokes can be undone and redone.
//
// Stroke   bone taken without a pause of kPauseS; after kLongestS the next one begins
// Undo     exchanges what the bricks of the last stroke hold with what they held before it; redo exchanges it back. A new
//          stroke forgets what was undone.
// Room     for a fixed number of bricks and of strokes: the oldest strokes are forgotten. A stroke with more bricks than
//          there is room for cannot be undone, nor what was before it.
// Thread   constructed anywhere; then that of the bone. No allocation.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "ipc/base/huge_pages.hpp"
#include "ipc/base/rt.hpp"
#include "ipc/scene/bone/bone_bricks.hpp"

namespace tact {

class StrokeHistory {
public:
    static constexpr double kPauseS = 0.3, kLongestS = 10.0;
    static constexpr std::uint32_t kStrokesMost = 1024;
    static constexpr std::size_t kRoomMost = 65536;  // bricks; 34 MB

    // Of a bone of so many bricks. room: bricks of all strokes together.
    explicit StrokeHistory(std::size_t bricks, std::size_t room = kRoomMost);

    // Before a brick may change: looks at it; after it changed: keeps what it was.
    void look(std::uint32_t brick, const std::uint8_t* voxels) noexcept TACT_RT;
    void keep(std::uint32_t brick) noexcept TACT_RT;
    // Once a step of the burr. took: bone.
    void step(double step_s, bool took) noexcept TACT_RT;
    void end_stroke() noexcept TACT_RT { open_ = false; }
    // Forgets all strokes; so many are in effect.
    void restart(std::uint32_t strokes) noexcept;

    // False: there is none, or one is being undone or redone.
    [[nodiscard]] bool undo() noexcept TACT_RT;
    [[nodiscard]] bool redo() noexcept TACT_RT;
    // True: bricks are to be exchanged, or are being exchanged. The burr must take nothing meanwhile.
    [[nodiscard]] bool exchanging() const noexcept TACT_RT { return turn_ != Turn::none; }
    // Exchanges up to kBricksAStep bricks and calls changed(brick) after each. True: that was the last one.
    static constexpr std::uint32_t kBricksAStep = 8;
    template <class Changed>
    bool exchange(std::span<std::uint8_t> density, const Changed& changed) noexcept TACT_RT {
        for (std::uint32_t n = 0; n < kBricksAStep && next_ < end_; ++n, ++next_) {
            const std::size_t slot = next_ % brick_.size();
            exchange_brick(slot, density);
            changed(brick_[slot]);
        }
        if (next_ < end_) return false;
        finish_exchange();
        return true;
    }

    // Strokes in effect since the start, also those that are forgotten, with the one that is under way.
    [[nodiscard]] std::uint32_t strokes() const noexcept TACT_RT { return strokes_; }
    [[nodiscard]] bool under_way() const noexcept TACT_RT { return open_; }
    [[nodiscard]] std::uint32_t undoable() const noexcept TACT_RT { return too_large_ ? 0 : done_; }
    [[nodiscard]] std::uint32_t redoable() const noexcept TACT_RT { return all_ - done_; }

private:
    enum class Turn : std::uint8_t { none, undo, redo };
    struct Stroke {
        std::uint64_t begin = 0, end = 0;  // numbers of its bricks; modulo the room: their slots
    };
    [[nodiscard]] Stroke& stroke(std::uint32_t i) noexcept { return stroke_[(first_ + i) % kStrokesMost]; }
    void begin_stroke() noexcept TACT_RT;
    void forget_first() noexcept TACT_RT;
    [[nodiscard]] bool begin_exchange(Turn turn, std::uint32_t which) noexcept TACT_RT;
    void exchange_brick(std::size_t slot, std::span<std::uint8_t> density) noexcept TACT_RT;
    void finish_exchange() noexcept TACT_RT;

    std::vector<std::uint32_t> mark_;   // by brick: the last stroke that kept it
    std::vector<std::uint32_t> brick_;  // by slot
    HugeVector<std::uint8_t> kept_;     // by slot, BoneBricks::kVoxels each
    std::array<std::uint8_t, BoneBricks::kVoxels> looked_{};
    std::array<Stroke, kStrokesMost> stroke_{};
    std::uint32_t first_ = 0, done_ = 0, all_ = 0;  // of stroke_; undone ones follow those that are done
    std::uint32_t number_ = 0;                      // of the last stroke that began
    std::uint32_t strokes_ = 0;
    bool open_ = false, too_large_ = false;
    double pause_s_ = 0.0, length_s_ = 0.0;
    Turn turn_ = Turn::none;
    std::uint64_t next_ = 0, end_ = 0;  // of an exchange
};

}  // namespace tact
