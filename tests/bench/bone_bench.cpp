// Rendering time and appearance of a frame of bone.
//
// Bone      the temporal bone of tact-prep with `voxels` per side, seen in its initial view; 960 x 540 pixels
// sharp     one ray per pixel of the whole view
// moving    the view rotates slightly in each frame; at most `rays` rays per frame
// drilled   the view rests, and a burr of 3 mm moves through the bone: bricks are uploaded and tiles are retraced
// Picture   the environment variable TACT_BONE_PICTURE sets the path prefix of a PNG of the last frame; case and voxels
//           are appended
// Skipped   without a display
#include <benchmark/benchmark.h>

#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <functional>
#include <set>

#include "gui/drilling/bone_view.hpp"
#include "gui/render/camera.hpp"
#include "gui/window/window.hpp"
#include "ipc/base/units.hpp"
#include "ipc/image/png.hpp"
#include "prep/synthetic/temporal_bone.hpp"

namespace tact {
namespace {

constexpr int kWidth = 960, kHeight = 540;

struct BoneFrame {
    Window window{kWidth, kHeight, true};
    OffscreenTarget target{kWidth, kHeight};
    BoneData bone;
    std::vector<std::uint8_t> drilled;
    BoneVolumeView now;
    std::unique_ptr<BoneContent> content;
    Vec3 centre_model_m = Vec3::Zero();
    std::unique_ptr<BoneView> view;
    Camera camera;

    explicit BoneFrame(std::uint32_t voxels) {
        TemporalBone settings;
        settings.voxels = voxels;
        settings.voxel_m = 50e-3 / voxels;
        bone = make_temporal_bone(settings);
        drilled = bone.density;
        now = bone.view();
        now.density = drilled;
        const auto& size = bone.bricks.size;
        centre_model_m = bone.bricks.to_model(0.5 * Vec3(size[0], size[1], size[2]));
        SceneMeta meta{};
        meta.kind = SceneKind::drilling;
        meta.world_per_model = 1.0;
        SceneWriter out;
        write_meta(out, meta, "made by a bench\n");
        const auto path =
            std::filesystem::temp_directory_path() / ("tact-bone-bench-" + std::to_string(getpid()));
        out.write(path);
        content = std::make_unique<BoneContent>(SceneFile::open(path), bone.view(),
                                                BoneLabelsView{bone.structure, bone.label},
                                                std::vector<DistanceField>{});
        std::filesystem::remove(path);
        target.bind();
        view = std::make_unique<BoneView>(*content, centre_model_m, now);
        camera.frame(static_cast<float>(0.5 * size[0] * bone.bricks.voxel_m / kAngstromM));
    }
    void draw(std::uint32_t rays) {
        Haze haze;
        haze.end_a = 1e12F;
        glViewport(0, 0, kWidth, kHeight);
        glClear(GL_COLOR_BUFFER_BIT | GL_DEPTH_BUFFER_BIT);
        view->draw({camera.view(), camera.projection(static_cast<float>(kWidth) / kHeight), haze, 0, 0,
                    kWidth, kHeight, rays});
        glFinish();
    }
    void save(const char* what) const {
        if (const char* const prefix = std::getenv("TACT_BONE_PICTURE"); prefix != nullptr)
            write_png(std::string(prefix) + what + std::to_string(bone.bricks.size[0]) + ".png", kWidth,
                      kHeight, read_pixels(kWidth, kHeight).rgb);
    }
};

// Times a loop of frames. `prepare` runs before each frame.
void time_frames(benchmark::State& state, const char* what, std::uint32_t rays,
                 const std::function<void(BoneFrame&, int)>& prepare) {
    if (std::getenv("DISPLAY") == nullptr) {
        state.SkipWithError("no display");
        return;
    }
    BoneFrame frame(static_cast<std::uint32_t>(state.range(0)));
    frame.draw(1U << 30U);
    double sent = 0.0;
    int n = 0;
    for (auto _ : state) {
        prepare(frame, n++);
        frame.draw(rays);
        sent += frame.view->rays();
    }
    state.counters["rays"] = sent / static_cast<double>(state.iterations());
    state.SetLabel(frame.window.renderer());
    frame.save(what);
}

void sharp(benchmark::State& state) {
    time_frames(state, "sharp", 1U << 30U,
                [](BoneFrame& p, int n) { p.camera.rotate(n % 2 == 0 ? 1.0F : -1.0F, 0.0F, kHeight); });
}
void moving(benchmark::State& state) {
    time_frames(state, "moving", static_cast<std::uint32_t>(state.range(1)),
                [](BoneFrame& p, int n) { p.camera.rotate(n % 64 < 32 ? 3.0F : -3.0F, 0.5F, kHeight); });
}
// Moves across the side that faces the initial view, 1 mm deep, 0.5 mm per frame.
void drilled(benchmark::State& state) {
    time_frames(state, "drilled", 1U << 30U, [](BoneFrame& p, int n) {
        const BoneBricks& b = p.bone.bricks;
        const double edge = b.size[0], r = 3e-3 / b.voxel_m;
        const double travel = std::fmod(0.5e-3 / b.voxel_m * n, 0.3 * edge);
        // The intersection of the bone with the line of sight through `at`.
        Vec3 at(0.35 * edge + travel, 0.45 * edge, edge - 2.0);
        while (at.z() > 0.0 &&
               p.drilled[b.voxel(static_cast<std::uint32_t>(at.x()), static_cast<std::uint32_t>(at.y()),
                                 static_cast<std::uint32_t>(at.z()))] < 77)
            at.z() -= 1.0;
        at.z() += r - 1e-3 / b.voxel_m;
        std::set<std::uint32_t> bricks;
        const auto from = [&](double v) { return static_cast<std::uint32_t>(std::max(v - r, 0.0)); };
        const auto to = [&](double v) { return static_cast<std::uint32_t>(std::min(v + r, edge - 1.0)); };
        for (std::uint32_t z = from(at.z()); z <= to(at.z()); ++z)
            for (std::uint32_t y = from(at.y()); y <= to(at.y()); ++y)
                for (std::uint32_t x = from(at.x()); x <= to(at.x()); ++x) {
                    if ((Vec3(x, y, z) - at).norm() > r || p.drilled[b.voxel(x, y, z)] == 0) continue;
                    p.drilled[b.voxel(x, y, z)] = 0;
                    bricks.insert(static_cast<std::uint32_t>(b.brick(x, y, z)));
                }
        for (const std::uint32_t brick : bricks) p.view->changed(brick);
    });
}
BENCHMARK(sharp)->Arg(128)->Arg(256)->Unit(benchmark::kMillisecond)->MeasureProcessCPUTime()->UseRealTime();
BENCHMARK(moving)
    ->ArgNames({"voxels", "rays"})
    ->ArgsProduct({{128, 256}, {10000, 30000, 100000}})
    ->Unit(benchmark::kMillisecond)
    ->MeasureProcessCPUTime()
    ->UseRealTime();
BENCHMARK(drilled)->Arg(128)->Arg(256)->Unit(benchmark::kMillisecond)->MeasureProcessCPUTime()->UseRealTime();

}  // namespace
}  // namespace tact
