// Background of a 3D view: a gradient or one colour, drawn once and copied while its size and colours stay.
//
// Thread   frame thread, context current. Draws into the bound framebuffer; colour only.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <optional>

#include "gui/render/programs.hpp"
#include "gui/render/saved_area.hpp"

namespace tact {

// Over the whole viewport. plain: one colour; none: the gradient.
void paint_view_ground(Programs& programs, const std::optional<Eigen::Vector3f>& plain);

class Backdrop {
public:
    // plain: one colour; none: the gradient. y from below.
    void show(Programs& programs, const std::optional<Eigen::Vector3f>& plain, int x_px, int y_px,
              int width_px, int height_px);
    [[nodiscard]] std::uint64_t drawn() const { return drawn_; }  // how often it was drawn and not copied

private:
    SavedArea saved_;
    std::optional<Eigen::Vector3f> plain_;
    std::uint64_t drawn_ = 0;
};

}  // namespace tact
