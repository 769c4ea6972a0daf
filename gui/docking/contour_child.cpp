#include "gui/docking/contour_child.hpp"

#include <unistd.h>

#include <cstdio>

#include "gui/base/child_job.hpp"
#include "gui/base/scratch_folder.hpp"
#include "ipc/base/error.hpp"
#include "ipc/scene/density/contour_mesh.hpp"

namespace tact {
namespace {

constexpr Duration kPatience = std::chrono::minutes(2);
constexpr Duration kLook = std::chrono::milliseconds(10);

}  // namespace

RefineContour refine_by_child(std::shared_ptr<const SceneContent> content, const std::string& program) {
    return [content = std::move(content), program](
               double level, const std::function<bool()>& stop) -> std::shared_ptr<const ProgressiveMesh> {
        const ScratchFolder folder;
        const std::string out = (folder.path() / "contour.tact").string();
        char text[48];
        std::snprintf(text, sizeof text, "--level=%.17g", level);
        ChildJob job;  // destroyed before its folder
        job.start(program, {"contour", content->path.string(), text, "-o", out, "--vertices-max",
                            std::to_string(kContourVerticesMax), "--ends-with", std::to_string(getpid())});
        const Instant until = Monotonic::now() + kPatience;
        std::optional<ChildOutcome> outcome;
        while (!(outcome = job.poll())) {
            if (stop()) throw Cancelled{};
            if (Monotonic::now() > until)
                throw StartupError("refining the contour", program + " did not finish within two minutes",
                                   "choose a higher level, or bin the map");
            std::this_thread::sleep_for(kLook);
        }
        if (!outcome->good())
            throw StartupError(
                "refining the contour",
                program + " ended with code " + std::to_string(outcome->exit_code) + ": " + outcome->output,
                "the surface stays unchanged; the reason is in this message");
        return read_contour(SceneFile::open(out), {content->checksum, level});
    };
}

}  // namespace tact
