// A 3D view that rests: drawn once in full detail, whatever the governor's levels are, and copied until something in it changes.
//
// Rests     nothing drawn has changed for kAfter, and nobody is about to change it (busy) since then
// Thread    frame thread, context current
#pragma once

#include <cstdint>
#include <optional>

#include "gui/render/saved_area.hpp"
#include "ipc/base/clock.hpp"

namespace tact {

class StillView {
public:
    static constexpr Duration kAfter = std::chrono::milliseconds(300);

    enum class Step : std::uint8_t {
        at_levels,  // it moves
        refine,     // draw it in full detail, then call keep()
        copy,       // call show()
    };
    // key: of everything drawn; none: it cannot be told, so the view counts as moving. busy: the person is at work and may go on at any
    // moment, so full detail waits.
    [[nodiscard]] Step next(const std::optional<std::uint64_t>& key, Instant now, bool busy = false);
    void keep(int x_px, int y_px, int width_px, int height_px);
    void show(int x_px, int y_px) { saved_.restore(x_px, y_px); }

private:
    SavedArea saved_;
    std::optional<std::uint64_t> key_;
    Instant since_{};
    bool kept_ = false;
};

}  // namespace tact
