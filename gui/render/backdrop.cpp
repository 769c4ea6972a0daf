#include "gui/render/backdrop.hpp"

namespace tact {

void paint_view_ground(Programs& programs, const std::optional<Eigen::Vector3f>& plain) {
    if (plain) {
        glClearColor(plain->x(), plain->y(), plain->z(), 1.0F);
        glClear(GL_COLOR_BUFFER_BIT);
    } else {
        glDisable(GL_BLEND);
        programs.draw_background();
    }
}

void Backdrop::show(Programs& programs, const std::optional<Eigen::Vector3f>& plain, int x_px, int y_px,
                    int width_px, int height_px) {
    if (saved_.fits(width_px, height_px) && plain == plain_) return saved_.restore(x_px, y_px);
    glEnable(GL_SCISSOR_TEST);
    glScissor(x_px, y_px, width_px, height_px);
    glViewport(x_px, y_px, width_px, height_px);
    paint_view_ground(programs, plain);
    glDisable(GL_SCISSOR_TEST);
    ++drawn_;
    plain_ = plain;
    saved_.save(x_px, y_px, width_px, height_px);
}

}  // namespace tact
