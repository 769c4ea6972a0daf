// A cleared canvas with depth and a camera, for tests that look at drawn pixels.
#pragma once

#include "gui/render/camera.hpp"
#include "tests/unit/gui_canvas.hpp"

namespace tact {

class DrawCanvas : public Canvas<160, 120> {
protected:
    static constexpr int kWidth = 160, kHeight = 120;

    void SetUp() override {
        Canvas::SetUp();
        if (IsSkipped()) return;
        glViewport(0, 0, kWidth, kHeight);
        glClearColor(0.0F, 0.0F, 0.0F, 1.0F);
        glClear(GL_COLOR_BUFFER_BIT | GL_DEPTH_BUFFER_BIT);
        glEnable(GL_DEPTH_TEST);
        glDisable(GL_BLEND);
        glDisable(GL_CULL_FACE);
        camera_.frame(20.0F);
    }
    void TearDown() override { EXPECT_EQ(glGetError(), GLenum{GL_NO_ERROR}); }

    Camera camera_;
};

}  // namespace tact
