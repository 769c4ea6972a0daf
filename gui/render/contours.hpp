// The isosurfaces of the map, up to four, each with its level, colour, opacity and style.
//
// Level     the scene's own contour is there at once, baked. Another is extracted by ContourWorker while
//           it is being moved, and replaced by a progressive mesh when it rests; what was shown stays
//           until then.
// Knob      approach_vertices() is that of "gui.mesh": a share of what all shown surfaces have at full
//           detail, the same for each. While a surface is a plain one its next extraction keeps to the
//           share instead.
// Drawn     opaque ones first. Then what is seen through, from the inside (highest level) to the outside;
//           within one surface glass is not sorted: it has one colour, so the order hardly shows.
// Thread    frame thread, context current.
#pragma once

#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "gui/render/contour_worker.hpp"
#include "gui/render/looks.hpp"
#include "gui/render/programs.hpp"
#include "gui/render/surface.hpp"

namespace tact {

struct Contour {
    double level = 0.0;  // in the map's unit
    Eigen::Vector3f colour{0.66F, 0.80F, 0.95F};
    float opacity = 1.0F;               // of glass: times its own
    std::optional<SurfaceStyle> style;  // none: as ViewOptions says
    bool shown = true;
};
// What the i-th contour is given where nobody chose.
[[nodiscard]] Eigen::Vector3f contour_colour(std::size_t contour);

struct ContourState {
    double level = 0.0;        // of what is drawn now
    bool final = false;        // it is the surface that was asked for, in all its detail
    std::uint32_t stride = 1;  // of a plain one: every so many voxels
    std::string error;         // why there is no better one
    double extract_s = 0.0;    // what the newest took, beside the frame
};

class Contours {
public:
    Contours(std::shared_ptr<const SceneContent> content, Programs& programs, RefineContour refine);

    // At most kContoursMax; more are left out. Cheap where nothing changed: may be called every frame.
    void set(std::span<const Contour> contours);
    [[nodiscard]] std::span<const Contour> contours() const { return wanted_; }
    [[nodiscard]] ContourState state(std::size_t contour) const;

    // All the way where that takes less than a picture of 30 a second; else as far as `budget_s` of this frame allows, shared by the
    // surfaces; see Surface. Call it every frame.
    void approach_vertices(std::uint32_t wanted, double budget_s) noexcept;
    // Takes what the worker has, and sends what changed. Bytes.
    std::size_t upload();
    void draw_opaque(const Eigen::Matrix4f& eye_from_model, const Eigen::Matrix4f& projection,
                     const Haze& haze, SurfaceStyle otherwise);
    void draw_clear(const Eigen::Matrix4f& eye_from_model, const Eigen::Matrix4f& projection,
                    const Haze& haze, SurfaceStyle otherwise);

    // Of all surfaces shown.
    [[nodiscard]] std::uint32_t vertices() const;
    [[nodiscard]] std::uint32_t triangles() const;
    [[nodiscard]] std::uint32_t vertices_min() const;
    [[nodiscard]] std::uint32_t vertices_max() const;
    [[nodiscard]] double error_m() const;  // the greatest

private:
    struct Slot {
        std::optional<double> asked;                  // of the worker
        std::shared_ptr<const ProgressiveMesh> mesh;  // of `surface`, which goes first
        std::unique_ptr<Surface> surface;
        PlainSurface plain;
        std::uint32_t plain_full = 0;
        ContourState state;
    };
    void show_mesh(Slot& slot, std::shared_ptr<const ProgressiveMesh> mesh, double level);
    void take_news(std::size_t contour, std::size_t& bytes);
    void apply_share(double budget_s) noexcept;
    [[nodiscard]] bool shown(std::size_t contour) const;
    [[nodiscard]] bool opaque(const Contour& contour, SurfaceStyle otherwise) const;
    [[nodiscard]] std::uint32_t full(const Slot& slot) const;
    void draw(std::size_t contour, const Eigen::Matrix4f& eye_from_model, const Eigen::Matrix4f& projection,
              const Haze& haze, SurfaceStyle otherwise);

    std::shared_ptr<const SceneContent> content_;
    Programs& programs_;
    std::vector<Contour> wanted_;
    std::array<Slot, kContoursMax> slot_;
    double share_ = 1.0;
    std::unique_ptr<ContourWorker> worker_;  // where the scene has a map
};

}  // namespace tact
