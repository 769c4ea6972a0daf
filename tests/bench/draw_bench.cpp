// Time of a frame with the atoms of a large complex, by rendering style; time of a contour extraction.
//
// Size      960 x 540 pixels; 27,000 atoms in a ball with the density of a protein, which fills the height of the frame
// Measured  see gui/README.md
// Skipped   without a display
#include <benchmark/benchmark.h>

#include <cstdlib>
#include <random>

#include "gui/docking/docking_layer.hpp"
#include "gui/render/camera.hpp"
#include "gui/render/scene_view.hpp"
#include "gui/render/sorted_glass.hpp"
#include "gui/window/window.hpp"

namespace tact {
namespace {

constexpr int kWidth = 960, kHeight = 540;

Structure ball_of_atoms(std::size_t atoms) {
    std::mt19937 random(1);
    std::uniform_real_distribution<double> unit(-1.0, 1.0);
    // 20 cubic angstrom per atom, without hydrogens.
    const double radius_m = 1e-10 * std::cbrt(20.0 * static_cast<double>(atoms) * 0.75 / 3.14159265);
    Structure s;
    while (s.size() < atoms) {
        const Vec3 p(unit(random), unit(random), unit(random));
        if (p.norm() > 1.0) continue;
        s.x_m.push_back(static_cast<float>(radius_m * p.x()));
        s.y_m.push_back(static_cast<float>(radius_m * p.y()));
        s.z_m.push_back(static_cast<float>(radius_m * p.z()));
    }
    s.element.assign(atoms, 6);
    s.residue.assign(atoms, 1);
    s.chain.assign(atoms, 0);
    s.trace.resize(atoms);
    for (std::size_t i = 0; i < atoms; i += 8) s.trace[i] = 1;
    return s;
}

void draw(benchmark::State& state) {
    if (std::getenv("DISPLAY") == nullptr) {
        state.SkipWithError("no display");
        return;
    }
    Window window(kWidth, kHeight, true);
    OffscreenTarget target(kWidth, kHeight);
    target.bind();
    auto content = std::make_shared<SceneContent>();
    auto docking = std::make_unique<DockingContent>();
    docking->bodies.push_back(ball_of_atoms(27000));
    docking->bonds.push_back(find_bonds(docking->bodies[0]));
    docking->codebooks.emplace_back();
    content->system = std::move(docking);
    content->radius_m = 52e-10;
    Programs programs;
    SceneView view(content, programs);
    DockingLayer layer(content, programs);
    view.set_layer(&layer);
    Camera camera;
    camera.frame(view.radius_a());
    layer.molecules().set_look({static_cast<MoleculeStyle>(state.range(0)), Colouring::chain});
    const std::array bodies{DrawnBody{Pose{Vec3::Zero(), Quat::Identity()}, 0, 1, false}};
    ViewFrame frame{};
    frame.width_px = kWidth;
    frame.height_px = kHeight;
    layer.frame.bodies = bodies;
    glViewport(0, 0, kWidth, kHeight);
    do {  // surfaces are computed in the background
        view.draw(camera.eye(static_cast<float>(frame.width_px) / static_cast<float>(frame.height_px)), {},
                  frame);
    } while (layer.molecules().surfaces_awaited() > 0);
    for (auto _ : state) {
        glClear(GL_COLOR_BUFFER_BIT | GL_DEPTH_BUFFER_BIT);
        camera.rotate(3.0F, 0.0F, kHeight);
        view.draw(camera.eye(static_cast<float>(frame.width_px) / static_cast<float>(frame.height_px)), {},
                  frame);
        glFinish();
    }
    state.SetLabel(window.renderer());
}
BENCHMARK(draw)
    ->ArgName("style: trace, tube, sticks, spheres, cartoon, surface")
    ->DenseRange(0, 5)
    ->Unit(benchmark::kMillisecond)
    ->MeasureProcessCPUTime()
    ->UseRealTime();

void compute_surface(benchmark::State& state) {
    const Structure atoms = ball_of_atoms(27000);
    std::size_t vertices = 0;
    for (auto _ : state)
        vertices = build_surface(atoms, 0.1 * static_cast<double>(state.range(0))).vertex.size();
    state.counters["vertices"] = static_cast<double>(vertices);
}
BENCHMARK(compute_surface)
    ->ArgName("spacing in tenths of an angstrom")
    ->Arg(25)
    ->Arg(10)
    ->Arg(6)
    ->Unit(benchmark::kMillisecond);

DensityGrid blobs(std::uint32_t n) {
    DensityGrid grid;
    grid.size = {n, n, n};
    grid.spacing_m = Vec3::Constant(1e-10);
    std::mt19937 random(2);
    std::uniform_real_distribution<double> unit(0.25, 0.75);
    std::vector<Vec3> centre;
    for (int i = 0; i < 40; ++i) centre.emplace_back(n * unit(random), n * unit(random), n * unit(random));
    const double width = 0.07 * n;
    for (std::uint32_t z = 0; z < n; ++z)
        for (std::uint32_t y = 0; y < n; ++y)
            for (std::uint32_t x = 0; x < n; ++x) {
                double sum = 0.0;
                for (const Vec3& c : centre)
                    sum += std::exp(-(Vec3(x, y, z) - c).squaredNorm() / (width * width));
                grid.values.push_back(static_cast<float>(sum));
            }
    return grid;
}

// A map's contour as glass, 1920 x 1080 pixels, which it fills as a scene does at the start.
void draw_map(benchmark::State& state) {
    if (std::getenv("DISPLAY") == nullptr) {
        state.SkipWithError("no display");
        return;
    }
    constexpr int kMapWidth = 1920, kMapHeight = 1080;
    Window window(kMapWidth, kMapHeight, true);
    OffscreenTarget target(kMapWidth, kMapHeight);
    target.bind();
    Programs programs;
    programs.light_by_pixel(state.range(0) != 0);
    SortedGlass sorted(programs);
    const DensityGrid grid = blobs(205);
    const PlainMesh mesh = extract_contour(grid, 0.5);
    PlainSurface surface;
    surface.fill(mesh);
    Camera camera;
    camera.frame(75.0F);
    Eigen::Matrix4f model = Eigen::Matrix4f::Identity();
    model.topLeftCorner<3, 3>() *= 1e10F;
    model.topRightCorner<3, 1>() = Eigen::Vector3f::Constant(-102.0F);
    glViewport(0, 0, kMapWidth, kMapHeight);
    glEnable(GL_DEPTH_TEST);
    glEnable(GL_CULL_FACE);
    glEnable(GL_BLEND);
    glBlendFunc(GL_SRC_ALPHA, GL_ONE_MINUS_SRC_ALPHA);
    for (auto _ : state) {
        glClear(GL_COLOR_BUFFER_BIT | GL_DEPTH_BUFFER_BIT);
        camera.rotate(3.0F, 0.0F, kMapHeight);
        const EyeView eye = camera.eye(static_cast<float>(kMapWidth) / static_cast<float>(kMapHeight));
        const auto draw_glass = [&] {
            programs.use_lit(eye.eye_from_scene * model, eye.projection, {}, {.glass = true});
            surface.draw({0.66F, 0.80F, 0.95F});
        };
        if (state.range(0) > 1) {
            sorted.draw(0, 0, kMapWidth, kMapHeight, glass_layers(true), draw_glass);
        } else {
            glDepthMask(GL_FALSE);
            draw_glass();
            glDepthMask(GL_TRUE);
        }
        glFinish();
    }
    state.counters["vertices"] = static_cast<double>(mesh.vertex.size());
    state.SetLabel(window.renderer());
}
BENCHMARK(draw_map)
    ->ArgName("light by vertex, by pixel, and glass sorted")
    ->DenseRange(0, 2)
    ->Unit(benchmark::kMillisecond)
    ->MeasureProcessCPUTime()
    ->UseRealTime();

void extract(benchmark::State& state) {
    const DensityGrid grid = blobs(100);
    const DensityGrid thin = thinned(grid, static_cast<std::uint32_t>(state.range(0)));
    double level = 0.5;
    std::size_t vertices = 0;
    for (auto _ : state) {
        vertices = extract_contour(thin, level).vertex.size();
        level = level > 1.5 ? 0.5 : level + 0.01;
    }
    state.counters["vertices"] = static_cast<double>(vertices);
}
BENCHMARK(extract)->ArgName("stride, of 100^3")->Arg(1)->Arg(2)->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace tact
