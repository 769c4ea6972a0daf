// Frame metrics for reports, in milliseconds; null: unknown.
#pragma once

#include <nlohmann/json.hpp>

#include "ipc/topics/frames.hpp"

namespace tact {

[[nodiscard]] inline nlohmann::json frames_json(const FrameMetrics& f) {
    using nlohmann::json;
    const auto ms = [](double s) { return s >= 0.0 ? json(1e3 * s) : json(nullptr); };
    const auto pass = [&ms](const PassMetrics& p) {
        return json{{"work_ms", {{"p50", ms(p.work_p50_s)}, {"p99", ms(p.work_p99_s)}}},
                    {"drawn_ms", {{"p50", ms(p.drawn_p50_s)}, {"p99", ms(p.drawn_p99_s)}}}};
    };
    json passes = json::object(), paths = json::object();
    for (std::size_t i = 0; i < kPasses; ++i) passes[pass_text(static_cast<Pass>(i))] = pass(f.pass[i]);
    for (std::size_t i = 0; i < kVisualPaths; ++i) paths[visual_path_text(i)] = pass(f.path[i]);
    return {{"count", f.frames},
            {"late", f.late},
            {"due_ms", f.due_s > 0.0 ? ms(f.due_s) : json(nullptr)},
            {"frame_ms", {{"p50", ms(f.run_p50_s)}, {"p99", ms(f.run_p99_s)}, {"max", ms(f.run_most_s)}}},
            {"recent_ms",
             {{"p50", ms(f.p50_s)}, {"p99", ms(f.p99_s)}, {"max", ms(f.most_s)}, {"frames", f.window}}},
            {"passes", passes},
            {"paths", paths},
            {"gl_objects", f.gl_objects},
            {"heap_bytes", f.heap_bytes},
            {"resident_bytes", f.resident_bytes}};
}

}  // namespace tact
