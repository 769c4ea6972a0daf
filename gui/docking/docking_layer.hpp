// Draws a docking scene besides its contours: the bodies, their codebooks and graphs.
//
// Thread   frame thread, context current.
#pragma once

#include <memory>
#include <span>
#include <vector>

#include "gui/docking/docking_content.hpp"
#include "gui/docking/molecules.hpp"
#include "gui/render/scene_layer.hpp"

namespace tact {

class DockingLayer : public SceneLayer {
public:
    // Content of the next frame.
    struct Frame {
        bool backbone = true, codebook = true, graph = true;
        std::span<const DrawnBody> bodies;
        std::uint32_t points_summed = 0;  // selects the level of the codebook
    };

    DockingLayer(std::shared_ptr<const SceneContent> content, Programs& programs);

    Frame frame;
    // The user's choice for the bodies.
    [[nodiscard]] Molecules& molecules() { return molecules_; }

    void draw_structures(const LayerPass& pass) override;
    [[nodiscard]] bool has_marks() const override { return frame.codebook || frame.graph; }
    void draw_marks(const LayerPass& pass) override;

private:
    struct Points {
        GlVertexArray array;
        GlBuffer vertices, edges;
        GLsizei points = 0, edge_indices = 0;
    };
    static Points make_points(const Codebook::Level& level);

    std::shared_ptr<const SceneContent> content_;
    Molecules molecules_;
    std::vector<std::vector<Points>> codebooks_;  // levels per structure
};

// Level of a codebook to draw if this many points are summed: the largest not above it that is still legible (400
// vectors), at least the first.
[[nodiscard]] std::size_t codebook_level(const Codebook& codebook, std::uint32_t points_summed);

}  // namespace tact
