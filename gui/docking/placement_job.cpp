#include "gui/docking/placement_job.hpp"

#include <unistd.h>

#include <algorithm>
#include <array>
#include <cstdio>
#include <fstream>
#include <utility>

#include "gui/docking/docking_content.hpp"
#include "gui/docking/poses_json.hpp"
#include "ipc/base/error.hpp"

namespace tact {
namespace {

constexpr std::size_t kJsonBytesMax = 1 << 20;
// As the programs name them. A search for the mean density is not offered: it is high wherever there is much density.
constexpr std::array<const char*, 3> kRefineObjectives{"laplacian", "correlation-mean", "density"};
constexpr std::array<const char*, 3> kSearchObjectives{"laplacian", "density", "laplacian"};

std::string text_of(const std::filesystem::path& path) {
    std::ifstream in(path, std::ios::binary);
    std::string text(kJsonBytesMax + 1, '\0');
    in.read(text.data(), static_cast<std::streamsize>(text.size()));
    text.resize(static_cast<std::size_t>(in.gcount()));
    if (text.size() > kJsonBytesMax)
        throw StartupError("reading " + path.string(), "the file is larger than a megabyte",
                           "the bodies stay where they are; report this message");
    return text;
}

}  // namespace

void PlacementJob::start(const PlacementRequest& request) {
    const FitBody& body = request.body;
    outcome_ = {};
    outcome_.start = body;
    outcome_.nearby = request.nearby;
    outcome_.objective = request.objective;
    outcome_.symmetry = request.symmetry;
    folder_ = std::make_unique<ScratchFolder>();
    const std::string poses = (folder_->path() / "poses.json").string();
    std::vector<PosedBody> bodies{{body, false}};
    for (const FitBody& b : request.subtracted)
        if (b.id != body.id) bodies.push_back({b, true});
    std::ofstream out(poses);
    out << poses_json(bodies, *content_) << std::flush;
    if (!out) throw StartupError("writing " + poses, "the write failed", "check the free space of the disk");
    const std::string found = (folder_->path() / "found.json").string();
    std::vector<std::string> words{content_->path.string(),
                                   "--poses",
                                   poses,
                                   "--body",
                                   std::to_string(body.id),
                                   "--json",
                                   found,
                                   "--background",
                                   "--ends-with",
                                   std::to_string(getpid())};
    const auto objective = static_cast<std::size_t>(request.objective);
    words.emplace_back("--objective");
    words.emplace_back(request.nearby ? kRefineObjectives[objective] : kSearchObjectives[objective]);
    if (!request.nearby) {
        words.emplace_back("--hits");
        words.push_back(std::to_string(kFoundMax));
        if (!request.symmetry.empty()) words.insert(words.end(), {"--symmetry=" + request.symmetry});
    }
    job_.start(request.nearby ? programs_.refine : programs_.search, words);
}

double PlacementJob::progress() const {
    const std::string text = job_.output();
    const std::size_t at = text.rfind('[');
    int percent = 0;
    if (at == std::string::npos || std::sscanf(text.c_str() + at, "[%d %%]", &percent) != 1) return 0.0;
    return std::clamp(0.01 * percent, 0.0, 1.0);
}

void PlacementJob::cancel() {
    if (!running()) return;
    outcome_.cancelled = true;
    job_.cancel();
}

std::optional<PlacementOutcome> PlacementJob::poll() {
    const std::optional<ChildOutcome> ended = job_.poll();
    if (!ended) return std::nullopt;
    if (!outcome_.cancelled) finish(*ended);
    folder_.reset();
    return std::exchange(outcome_, {});
}

void PlacementJob::finish(const ChildOutcome& ended) {
    const std::string& program = outcome_.nearby ? programs_.refine : programs_.search;
    try {
        if (!ended.good()) {
            const std::size_t message = ended.output.rfind(program + ": ");  // after the lines of progress
            outcome_.error = message != std::string::npos
                                 ? ended.output.substr(message)
                                 : program + " ended with code " + std::to_string(ended.exit_code);
            return;
        }
        const Structure& s = docking_of(*content_).bodies.at(outcome_.start.structure);
        const std::string json = text_of(folder_->path() / "found.json");
        outcome_.found = read_found(json, s.home_com_model_m, outcome_.nearby);
        if (!outcome_.symmetry.empty()) outcome_.symmetry = found_symmetry(json);
    } catch (const std::exception& e) {
        outcome_.error = e.what();
    }
}

}  // namespace tact
