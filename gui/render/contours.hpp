// Up to four isosurfaces of the map, each with its level, colour, opacity and style.
//
// Level     the scene's own contour is baked and available at once. ContourWorker extracts any other one while it is
//           being moved, and replaces it by a progressive mesh when it rests; the previous surface stays until
//           then.
// Detail    approach_vertices() applies the level of "gui.mesh": the same fraction of the full vertices for each
//           shown surface. A plain surface applies it at its next extraction.
// Drawn     opaque surfaces first, then transparent ones: glass sorted by SortedGlass where the view asks for it; else from the inside (highest
//           level) to the outside, with the triangles of a surface as they come.
// Thread    frame thread, context current.
#pragma once

#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "gui/render/content_key.hpp"
#include "gui/render/contour_worker.hpp"
#include "gui/render/density_slice.hpp"
#include "gui/render/looks.hpp"
#include "gui/render/programs.hpp"
#include "gui/render/surface.hpp"

namespace tact {

struct Contour {
    double level = 0.0;  // in the map's unit
    Eigen::Vector3f colour{0.66F, 0.80F, 0.95F};
    float opacity = 1.0F;               // of glass: multiplies its own
    std::optional<SurfaceStyle> style;  // none: as in ViewOptions
    bool shown = true;
};
// Default colour of the i-th contour.
[[nodiscard]] Eigen::Vector3f contour_colour(std::size_t contour);

struct ContourState {
    double level = 0.0;        // of the surface now drawn
    bool final = false;        // the requested surface at full detail
    std::uint32_t stride = 1;  // of a plain surface, in voxels
    std::string error;         // why there is no better surface
    double extract_s = 0.0;    // of the newest extraction, in the background
};

class Contours {
public:
    Contours(std::shared_ptr<const SceneContent> content, Programs& programs, RefineContour refine);

    // At most kContoursMax; more are ignored. Cheap if nothing changed: may be called every frame.
    void set(std::span<const Contour> contours);
    [[nodiscard]] std::span<const Contour> contours() const { return wanted_; }
    [[nodiscard]] ContourState state(std::size_t contour) const;

    // Goes to `wanted` at once if that takes less than 33 ms; else as far as `budget_s` of this frame allows, divided
    // among the surfaces (see Surface). Call it every frame.
    void approach_vertices(std::uint32_t wanted, double budget_s) noexcept;
    // While on, surfaces are drawn in full detail from buffers of their own, so that the level is kept meanwhile and is back at once.
    // Counts below are those of the level.
    void set_refined(bool refined);
    // Adds what is shown, apart from the level.
    void add_to(ContentKey& key) const;
    // Takes the worker's results and uploads changes. Returns bytes.
    std::size_t upload();
    void draw_opaque(const Eigen::Matrix4f& eye_from_model, const Eigen::Matrix4f& projection,
                     const Haze& haze, SurfaceStyle otherwise);
    void draw_clear(const Eigen::Matrix4f& eye_from_model, const Eigen::Matrix4f& projection,
                    const Haze& haze, SurfaceStyle otherwise);
    // True if what is clear is glass alone, which may be drawn in any order if SortedGlass sorts it.
    [[nodiscard]] bool glass_alone(SurfaceStyle otherwise) const;
    void draw_glass_to_sort(const Eigen::Matrix4f& eye_from_model, const Eigen::Matrix4f& projection,
                            const Haze& haze, SurfaceStyle otherwise);

    // The face where haze.cut_a cuts the map: of each shown contour that faces lower densities, in its colour; of glass, glassy.
    void draw_cut(const Eigen::Matrix4f& eye_from_model, const Eigen::Matrix4f& projection, const Haze& haze,
                  SurfaceStyle otherwise);

    // Totals of all shown surfaces.
    [[nodiscard]] std::uint32_t vertices() const;
    [[nodiscard]] std::uint32_t triangles() const;
    [[nodiscard]] std::uint32_t vertices_min() const;
    [[nodiscard]] std::uint32_t vertices_max() const;
    [[nodiscard]] double error_m() const;  // the greatest

private:
    struct Slot {
        std::optional<double> asked;                  // of the worker
        std::shared_ptr<const ProgressiveMesh> mesh;  // of `surface`, which is destroyed first
        std::unique_ptr<Surface> surface;
        std::unique_ptr<Surface> full;  // refined, where `surface` is not at full detail
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
              const Haze& haze, SurfaceStyle otherwise, bool sorted = false);

    std::shared_ptr<const SceneContent> content_;
    Programs& programs_;
    std::vector<Contour> wanted_;
    std::array<Slot, kContoursMax> slot_;
    double share_ = 1.0;
    bool refined_ = false;
    std::unique_ptr<ContourWorker> worker_;  // only if the scene has a map
    std::unique_ptr<DensitySlice> slice_;    // created by the first cut
};

}  // namespace tact
