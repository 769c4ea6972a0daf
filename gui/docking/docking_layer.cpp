#include "gui/docking/docking_layer.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "gui/render/scene_frame.hpp"

namespace tact {
namespace {

// The balls of a fine codebook must not hide the backbone: the more balls, the smaller.
float ball_radius_a(GLsizei points) {
    return std::clamp(1.3F * std::cbrt(50.0F / static_cast<float>(std::max(points, 1))), 0.5F, 1.4F);
}

// More vectors are a cloud that hides the backbone, and too slow for software rendering.
constexpr std::uint32_t kCodebookShownMax = 400;
constexpr float kBallRgba[4] = {0.93F, 0.94F, 0.97F, 1.0F};
constexpr float kGraphRgba[4] = {0.80F, 0.84F, 0.90F, 0.38F};

}  // namespace

std::size_t codebook_level(const Codebook& codebook, std::uint32_t points_summed) {
    std::size_t best = 0;
    for (std::size_t l = 0; l < codebook.levels.size(); ++l)
        if (codebook.levels[l].size() <= std::min(points_summed, kCodebookShownMax)) best = l;
    return best;
}

DockingLayer::DockingLayer(std::shared_ptr<const SceneContent> content, Programs& programs)
    : content_(std::move(content)), molecules_(content_, programs) {
    for (const Codebook& codebook : docking_of(*content_).codebooks) {
        codebooks_.emplace_back();
        for (const Codebook::Level& level : codebook.levels) codebooks_.back().push_back(make_points(level));
    }
}

DockingLayer::Points DockingLayer::make_points(const Codebook::Level& level) {
    Points points;
    std::vector<float> xyz;
    xyz.reserve(3 * level.size());
    for (std::size_t i = 0; i < level.size(); ++i)
        xyz.insert(xyz.end(),
                   {level.x_m[i] * kSceneAPerM, level.y_m[i] * kSceneAPerM, level.z_m[i] * kSceneAPerM});
    glBindVertexArray(points.array.get());
    glBindBuffer(GL_ARRAY_BUFFER, points.vertices.get());
    glBufferData(GL_ARRAY_BUFFER, static_cast<GLsizeiptr>(xyz.size() * sizeof(float)), xyz.data(),
                 GL_STATIC_DRAW);
    attribute(0, 3, GL_FLOAT, GL_FALSE, 12, 0);
    glBindBuffer(GL_ELEMENT_ARRAY_BUFFER, points.edges.get());
    glBufferData(GL_ELEMENT_ARRAY_BUFFER,
                 static_cast<GLsizeiptr>(level.edges.size() * sizeof(level.edges[0])), level.edges.data(),
                 GL_STATIC_DRAW);
    points.points = static_cast<GLsizei>(level.size());
    points.edge_indices = static_cast<GLsizei>(2 * level.edges.size());
    glBindVertexArray(0);
    return points;
}

void DockingLayer::draw_structures(const LayerPass& pass) {
    const std::span<const DrawnBody> bodies = frame.backbone ? frame.bodies : std::span<const DrawnBody>{};
    molecules_.draw(bodies, pass.eye_from_scene, pass.projection, pass.haze);
}

void DockingLayer::draw_marks(const LayerPass& pass) {
    const std::vector<Codebook>& books = docking_of(*content_).codebooks;
    for (const DrawnBody& body : frame.bodies) {
        const std::size_t s = body.structure;
        // Codebooks are of the straight structure.
        if (body.hidden || body.ghost || !body.amplitude_m.empty() || s >= codebooks_.size() ||
            codebooks_[s].empty())
            continue;
        Points& points = codebooks_[s][codebook_level(books[s], frame.points_summed)];
        const Eigen::Matrix4f eye =
            pass.eye_from_scene * scene_from_body(body.T_model_body, content_->centre_model_m);
        glBindVertexArray(points.array.get());
        if (frame.graph) {
            pass.programs.use_flat(eye, pass.projection, pass.haze, kGraphRgba);
            glDrawElements(GL_LINES, points.edge_indices, GL_UNSIGNED_INT, nullptr);
        }
        if (frame.codebook) {
            glEnable(GL_PROGRAM_POINT_SIZE);
            pass.programs.use_balls(eye, pass.projection, pass.haze, kBallRgba, ball_radius_a(points.points),
                                    static_cast<float>(pass.height_px));
            glDrawArrays(GL_POINTS, 0, points.points);
            glDisable(GL_PROGRAM_POINT_SIZE);
        }
    }
}

}  // namespace tact
