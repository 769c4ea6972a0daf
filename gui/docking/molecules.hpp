// The bodies of a scene, each in the style and colouring that the user chose.
//
// Shared   the graphics data of a structure is created when a style is first drawn, once for all its copies; a
//          body adds only its pose.
// Surface  is computed in the background (SurfaceWorker); until it is there, a body is drawn by a coarser one or as a tube, and
//          surfaces_awaited() counts it. That of a bent body is the straight one's, moved with the atoms.
// Own      a body that is bent along its modes, or coloured by its fit, has graphics data of its own, made again when its shape has
//          changed by kSameShapeA or its colours have.
// Cost     trace, tube and cartoon are cheap anywhere. Surfaces have at most set_surface_vertices_max() vertices in a frame: the coarsest of
//          its steps that are needed for that are drawn, and surfaces_coarse() counts the bodies. Sticks and spheres are impostors, one per bond or atom: cheap on a
//          graphics card, expensive in software. A frame draws at most shapes_max of them (set_shapes_max);
//          further bodies are drawn as tubes, and left_out() counts them.
// Level    of gui.molecules: tubes and traces follow means of more atoms, with fewer sides; cartoons have fewer steps, and become tubes; sticks lose the ends of side chains first;
//          of the spheres a random part is drawn, enlarged to fill the same volume; surfaces come from coarser grids.
// Thread   frame thread, context current.
#pragma once

#include <array>
#include <cstdint>
#include <limits>
#include <map>
#include <memory>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "gui/docking/impostors.hpp"
#include "gui/docking/painted_surface.hpp"
#include "gui/docking/surface_choice.hpp"
#include "gui/render/looks.hpp"
#include "gui/render/programs.hpp"
#include "gui/render/ribbon.hpp"
#include "gui/render/scene_content.hpp"
#include "gui/render/triangle_buffers.hpp"

namespace tact {

// A body to draw. Copies share a structure.
struct DrawnBody {
    Pose T_model_body;
    std::uint32_t structure = 0;  // index in the scene
    std::uint32_t id = 0;         // identifies the body for the setters below
    bool hidden = false;
    bool ghost = false;                    // a place found: drawn as a thin, grey trace
    std::span<const float> amplitude_m{};  // bent along the modes of its structure; empty: straight
};

class Molecules {
public:
    static constexpr std::size_t kTubeVertices = 20000, kCartoonVertices = 60000,
                                 kSurfaceVertices = 300000;  // total of all structures
    static constexpr std::size_t kNoLimit = std::numeric_limits<std::size_t>::max();

    Molecules(std::shared_ptr<const SceneContent> content, Programs& programs);

    void set_look(const MoleculeLook& look);  // of all bodies, including later ones
    void set_look(std::uint32_t id, const MoleculeLook& look);
    [[nodiscard]] MoleculeLook look(std::uint32_t id) const;
    [[nodiscard]] MoleculeLook look() const { return look_; }  // of bodies without one of their own
    void set_shapes_max(std::size_t shapes) { shapes_max_ = shapes; }
    [[nodiscard]] std::size_t shapes_max() const { return shapes_max_; }
    void set_surface_vertices_max(std::size_t vertices) { surface_vertices_max_ = vertices; }
    [[nodiscard]] std::size_t surface_vertices_max() const { return surface_vertices_max_; }
    // Colours of the atoms of a body while it is coloured by its fit; without them it is grey.
    void set_fit_colours(std::uint32_t id, std::vector<Rgb8> colours);
    // In (0, 1], from the next draw() on.
    void set_level(float level) { level_ = level; }

    // Opaque; depth test and depth writing on.
    void draw(std::span<const DrawnBody> bodies, const Eigen::Matrix4f& eye_from_scene,
              const Eigen::Matrix4f& projection, const Haze& haze);
    // Bodies that the last draw() drew as tubes instead of sticks or spheres.
    [[nodiscard]] std::size_t left_out() const { return left_out_; }
    // Of the last draw(): bodies whose wanted surface is still computed, those drawn coarser for the limit of vertices, and why the surface of
    // one cannot be computed.
    [[nodiscard]] std::size_t surfaces_awaited() const { return surfaces_awaited_; }
    [[nodiscard]] std::size_t surfaces_coarse() const { return surfaces_coarse_; }
    [[nodiscard]] const std::string& surface_error() const { return surfaces_.error(); }
    // Rises when a surface has been computed that is finer than those before it.
    [[nodiscard]] std::uint64_t surfaces_computed() const { return surfaces_.computed(); }
    // Of the last draw(): as drawn, and at level 1.
    [[nodiscard]] std::uint32_t triangles() const { return triangles_; }
    [[nodiscard]] std::uint32_t triangles_max() const { return triangles_max_; }

private:
    static constexpr std::array kTubeLevels{1.0F, 0.7F, 0.5F, 0.35F, 0.25F, 0.17F};
    static constexpr std::size_t kTraceSteps = 4;
    static constexpr double kSameShapeA = 0.03;
    struct OfStructure {
        std::array<TriangleBuffers, kTubeLevels.size()> tube, cartoon;
        std::array<ImpostorShapes, kTraceSteps> trace;  // by the atoms per point
        ImpostorShapes sticks, spheres;
        std::map<std::shared_ptr<const MolecularSurface>, std::shared_ptr<SurfaceShape>> surface_shape;
        // By whether it is coloured by element.
        std::map<std::pair<std::shared_ptr<const MolecularSurface>, bool>, PaintedSurface> surface;
        std::size_t sticks_always = 0;                        // drawn at any level
        std::size_t tube_vertices = 0, cartoon_vertices = 0;  // at level 1

        void clear();
    };
    struct Own {
        std::vector<float> amplitude_m;
        Structure atoms;                                 // if it is bent
        std::shared_ptr<const std::vector<Rgb8>> paint;  // if it is coloured by its fit
        OfStructure made;
        bool drawn = false;  // in this frame
    };
    // What is drawn of a body: its atoms, and what was made of them.
    struct Source {
        OfStructure& made;
        const Structure& atoms;
        std::span<const Bond> bonds;
        AtomPaint paint;
        std::uint32_t structure;  // index in the scene
    };
    Source source_of(const DrawnBody& body, Colouring colouring);
    std::shared_ptr<const std::vector<Rgb8>> fit_paint(const DrawnBody& body) const;
    ImpostorShapes& shapes(const Source& source, MoleculeStyle style);
    ImpostorShapes& trace(const Source& source, std::size_t atoms_per_point);
    TriangleBuffers& tube(const Source& source, MoleculeStyle style, std::size_t step);
    PaintedSurface& surface(const Source& source, const std::shared_ptr<const MolecularSurface>& mesh,
                            bool by_element);
    // Returns the vertices drawn: 0 if no surface of at most so many is at hand.
    std::size_t draw_surface(const Source& source, const ImpostorView& view, std::size_t vertices_most);
    void draw_tube(const Source& source, MoleculeStyle style, const ImpostorView& view);
    void draw_shapes(const Source& source, MoleculeStyle style, ImpostorView view);
    void count(std::size_t drawn, std::size_t most);

    std::shared_ptr<const SceneContent> content_;
    Programs& programs_;
    std::unique_ptr<ImpostorPrograms> impostors_;  // compiled at first use
    std::vector<OfStructure> structures_;
    std::vector<std::vector<std::vector<Fold>>> folds_;  // of each structure, once a cartoon was drawn
    std::map<std::uint32_t, Own> own_;                   // by id of the body
    std::map<std::uint32_t, std::shared_ptr<const std::vector<Rgb8>>> fit_paint_;
    std::vector<std::shared_ptr<const std::vector<Rgb8>>> grey_;  // per structure
    MoleculeLook look_;
    std::map<std::uint32_t, MoleculeLook> look_of_;
    SurfaceChoices surfaces_;
    std::size_t surface_vertices_max_ = kNoLimit, surfaces_awaited_ = 0, surfaces_coarse_ = 0;
    std::size_t shapes_max_ = kNoLimit, left_out_ = 0;
    float level_ = 1.0F;
    std::uint32_t triangles_ = 0, triangles_max_ = 0;
};

}  // namespace tact
