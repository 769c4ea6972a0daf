// Rendering time and appearance of a frame of dust, water, blood and paste in a hole in bone.
//
// Size      960 x 540 pixels; the hole fills most of the frame
// Metrics   ms per frame for the particles alone; the bone behind them is a mesh, whose drawing is not timed
// Picture   the environment variable TACT_CLOUD_PICTURE sets the path prefix of a PNG per case; the number of particles
//           is appended
// Skipped   without a display
#include <benchmark/benchmark.h>

#include <cmath>
#include <cstdlib>

#include "gui/drilling/particle_cloud.hpp"
#include "gui/render/camera.hpp"
#include "gui/render/scene_view.hpp"
#include "gui/window/window.hpp"
#include "ipc/base/units.hpp"
#include "ipc/image/png.hpp"
#include "ipc/scene/density/isosurface.hpp"
#include "prep/mesh/progressive.hpp"
#include "tests/support/bone_block.hpp"

namespace tact {
namespace {

constexpr int kWidth = 960, kHeight = 540;
constexpr std::uint32_t kEdge = 128;

// Density of a plate at z = 60 with a bowl that is open towards +z.
double solid(const Vec3& p) {
    const double bowl = (p - Vec3(64.0, 64.0, 62.0)).norm();
    const double plate =
        std::clamp(60.5 + 2.0 * std::sin(0.1 * p.x()) * std::cos(0.13 * p.y()) - p.z(), 0.0, 1.0);
    return std::min(plate, std::clamp(bowl - 45.0, 0.0, 1.0));
}

std::shared_ptr<SceneContent> content_of(const BoneBlock& bone) {
    DensityGrid grid;
    grid.size = bone.bricks.size;
    grid.spacing_m = Vec3::Constant(bone.bricks.voxel_m);
    grid.origin_m = bone.bricks.origin_m;
    grid.values.resize(grid.count());
    std::size_t k = 0;
    for (std::uint32_t z = 0; z < kEdge; ++z)
        for (std::uint32_t y = 0; y < kEdge; ++y)
            for (std::uint32_t x = 0; x < kEdge; ++x)
                grid.values[k++] = static_cast<float>(bone.density[bone.bricks.voxel(x, y, z)]);
    auto content = std::make_shared<SceneContent>();
    content->meta.kind = SceneKind::surface;
    content->mesh = std::make_unique<ProgressiveMesh>(make_progressive(isosurface(grid, 110.0)));
    content->centre_model_m = bone.bricks.to_model(Vec3(64.0, 64.0, 40.0));
    content->radius_m = 60.0 * bone.bricks.voxel_m;
    return content;
}

// Adds the particles of some seconds of drilling: dust from the burr, water, and blood from the wall.
void fill(Particles& particles, const BoneBricks& bricks, std::uint32_t most) {
    SeededRandom random(1);
    const double down = 0.01;
    while (particles.all().size() < most) {
        const std::size_t before = particles.all().size();
        for (int i = 0; i < 400; ++i) {
            const double a = 6.28 * random.uniform(), r = 43.0 * std::sqrt(random.uniform());
            const Vec3 wall(64.0 + r * std::cos(a), 64.0 + r * std::sin(a),
                            62.0 - std::sqrt(44.0 * 44.0 - r * r));
            if (i % 2 == 0)
                particles.drilled(static_cast<std::uint32_t>(72.0 + 12.0 * random.uniform()), 68,
                                  static_cast<std::uint32_t>(26.0 + 4.0 * random.uniform()), 200,
                                  Vec3(0.15, 0.2, 0.35));
            else if (i % 5 != 1)
                particles.emit(Matter::water,
                               bricks.to_model(Vec3(50.0, 84.0, 60.0) + 3.0 * random.direction()),
                               Vec3(0.02, -0.05, -0.3));
            else
                particles.emit(Matter::blood, bricks.to_model(r < 15.0 ? wall : Vec3(48.0, 46.0, 40.0)),
                               Vec3::Zero());
        }
        static_cast<void>(particles.step(down, 10.0, Vec3::Zero(), {}));
        if (particles.all().size() < before + 20) break;  // full
    }
}

void cloud(benchmark::State& state) {
    if (std::getenv("DISPLAY") == nullptr) {
        state.SkipWithError("no display");
        return;
    }
    const auto most = static_cast<std::uint32_t>(state.range(0));
    Window window(kWidth, kHeight, true);
    OffscreenTarget target(kWidth, kHeight);
    target.bind();
    const BoneBlock bone(kEdge, 3e-4, solid);
    Particles particles(bone.bricks, bone.density, {.most = most, .gravity_m_s2 = Vec3(0.0, 0.0, -9.81)});
    fill(particles, bone.bricks, most);
    Programs programs;
    SceneView view(content_of(bone), programs);
    view.approach_vertices(view.vertices_max(), 1e9);
    view.upload();
    Camera camera;
    camera.frame(view.radius_a());
    camera.zoom(4.0F);
    camera.rotate(20.0F, -10.0F, kHeight);
    ViewFrame frame{};
    frame.width_px = kWidth;
    frame.height_px = kHeight;
    ViewOptions options;
    options.style = SurfaceStyle::solid;
    options.force = false;
    glViewport(0, 0, kWidth, kHeight);
    glClearColor(0.05F, 0.06F, 0.09F, 1.0F);
    ParticleCloud particle_cloud;
    ParticleCloud::View v;
    v.projection = camera.projection(static_cast<float>(kWidth) / kHeight);
    const double cell_a = particles.cells().cell_m() / kAngstromM;
    Eigen::Matrix4f scene_from_cells = Eigen::Matrix4f::Identity();
    scene_from_cells.topLeftCorner<3, 3>() *= static_cast<float>(cell_a);
    scene_from_cells.topRightCorner<3, 1>() =
        ((particles.cells().to_model(Vec3::Zero()) - view.content().centre_model_m) / kAngstromM)
            .cast<float>();
    v.eye_from_cells = camera.view() * scene_from_cells;
    v.cell_a = static_cast<float>(cell_a);
    v.width_px = kWidth;
    v.height_px = kHeight;
    double filling_s = 0.0;
    for (auto _ : state) {
        state.PauseTiming();
        glClear(GL_COLOR_BUFFER_BIT | GL_DEPTH_BUFFER_BIT);
        view.draw(camera.eye(static_cast<float>(frame.width_px) / static_cast<float>(frame.height_px)),
                  options, frame);
        glFinish();
        state.ResumeTiming();
        const Instant begin = Monotonic::now();
        particle_cloud.fill(particles.all());
        filling_s += to_s(Monotonic::now() - begin);
        particle_cloud.draw(v);
        glFinish();
    }
    state.counters["alive"] = static_cast<double>(particles.all().size());
    state.counters["fluids"] = static_cast<double>(particle_cloud.sent().fluids);
    state.counters["fill_ms"] = 1e3 * filling_s / static_cast<double>(state.iterations());
    state.SetLabel(window.renderer());
    if (const char* const prefix = std::getenv("TACT_CLOUD_PICTURE"); prefix != nullptr)
        write_png(std::string(prefix) + std::to_string(most) + ".png", kWidth, kHeight,
                  read_pixels(kWidth, kHeight).rgb);
}
BENCHMARK(cloud)
    ->ArgName("particles")
    ->Arg(1000)
    ->Arg(10000)
    ->Arg(30000)
    ->Arg(100000)
    ->Unit(benchmark::kMillisecond)
    ->MeasureProcessCPUTime()
    ->UseRealTime();

}  // namespace
}  // namespace tact
