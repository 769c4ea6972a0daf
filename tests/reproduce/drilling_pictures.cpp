#include "tests/reproduce/drilling_pictures.hpp"

#include <unistd.h>

#include <string>

#include "deploy/tact/drilling/drilling.hpp"
#include "deploy/tact/run.hpp"
#include "deploy/tact/scene_cache.hpp"

namespace tact::launch {

int drilling_pictures(const std::filesystem::path& out, bool quick) {
    constexpr int kPictures = 6;
    const double every_s = quick ? 2.0 : 5.0;
    const auto scene = baked_scene(
        {.inputs = {}, .words = {"demo", "drill", "--voxels", quick ? "96" : "256"}, .options = {}});
    if (scene.empty()) return 130;
    RunOptions run;
    run.seconds = every_s * (kPictures - 0.4);  // the first screenshot is taken after the first frame
    run.headless = true;
    run.quiet = true;
    run.session = "figure1-" + std::to_string(::getpid());
    run.screenshot = out / "fig1_drilling.png";
    run.json = out / "fig1_run.json";
    let_the_hands_drill(run);
    // Only the content of the frames matters here, not the frame rate.
    run.controller.insert(run.controller.end(),
                          {"--hand-at-mm", kMastoidMm, "--law", "fixed", "--level", "gui.particles=0.5"});
    run.visual = {"--picture-every", std::to_string(every_s), "--zoom", "1.5"};
    return run_scene(scene, run);
}

}  // namespace tact::launch
