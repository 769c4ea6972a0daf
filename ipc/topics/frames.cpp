#include "ipc/topics/frames.hpp"

#include <algorithm>
#include <cmath>

#include "ipc/topics/levels.hpp"

namespace tact {
namespace {

constexpr const char* kPassText[kPasses] = {"ground", "adapt",     "structures", "bone",  "surface",
                                            "marks",  "motion",    "particles",  "edges", "enlarge",
                                            "stereo", "dashboard", "swap"};
constexpr const char* kVisualPathText[kVisualPaths] = {kMeshPath, kVolumePath, kParticlesPath, kMoleculesPath,
                                                       kResolutionPath};

bool time(float s) noexcept { return s >= 0.0F && s < 1e6F; }  // false for NaN
bool rising(float a, float b) noexcept { return time(a) && time(b) && a <= b; }
bool known(const PassMetrics& p) noexcept {
    const bool drawn = p.drawn_p50_s < 0.0F ? p.drawn_p99_s < 0.0F && std::isfinite(p.drawn_p99_s) &&
                                                  std::isfinite(p.drawn_p50_s)
                                            : rising(p.drawn_p50_s, p.drawn_p99_s);
    return drawn && rising(p.work_p50_s, p.work_p99_s);
}

}  // namespace

const char* pass_text(Pass pass) noexcept {
    const auto i = static_cast<std::size_t>(pass);
    return i < kPasses ? kPassText[i] : "unknown";
}

const char* visual_path_text(std::size_t path) noexcept {
    return path < kVisualPaths ? kVisualPathText[path] : "";
}

bool plausible(const FrameMetrics& f) noexcept {
    constexpr std::uint64_t kMostFrames = 1ULL << 48U, kMostBytes = 1ULL << 48U;
    return f.late <= f.frames && f.frames < kMostFrames && f.due_s >= 0.0 && f.due_s < 1e6 &&
           rising(f.p50_s, f.p99_s) && rising(f.p99_s, f.most_s) && rising(f.run_p50_s, f.run_p99_s) &&
           rising(f.run_p99_s, f.run_most_s) && f.window < 1U << 20U && f.gl_objects < 1U << 30U &&
           f.heap_bytes < kMostBytes && f.resident_bytes < kMostBytes &&
           std::all_of(f.pass, f.pass + kPasses, known) && std::all_of(f.path, f.path + kVisualPaths, known);
}

}  // namespace tact
