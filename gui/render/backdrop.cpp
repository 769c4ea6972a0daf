#include "gui/render/backdrop.hpp"

namespace tact {

void Backdrop::show(Programs& programs, const std::optional<Eigen::Vector3f>& plain, int x_px, int y_px,
                    int width_px, int height_px) {
    if (saved_.fits(width_px, height_px) && plain == plain_) return saved_.restore(x_px, y_px);
    if (plain) {
        glEnable(GL_SCISSOR_TEST);
        glScissor(x_px, y_px, width_px, height_px);
        glClearColor(plain->x(), plain->y(), plain->z(), 1.0F);
        glClear(GL_COLOR_BUFFER_BIT);
        glDisable(GL_SCISSOR_TEST);
    } else {
        glDisable(GL_BLEND);
        glViewport(x_px, y_px, width_px, height_px);
        programs.draw_background();
    }
    ++drawn_;
    plain_ = plain;
    saved_.save(x_px, y_px, width_px, height_px);
}

}  // namespace tact
