// Time of each pass of a frame: on the frame thread and, where measurable, in the renderer.
//
// Stamped    the GPU records the start and end of each pass. Results are read kFramesInFlight frames later, and only
//            if available: reading never waits. Unavailable ones are counted as lost.
// Finished   on a software renderer one frame in kFinishEvery is finished pass by pass (ipc/topics/frames.hpp).
// Unknown    the driver has no timestamps, or its counter has no bits.
// Thread     frame thread, context current.
#pragma once

#include <array>
#include <cstdint>
#include <utility>
#include <vector>

#include "gui/render/gl.hpp"
#include "ipc/base/clock.hpp"
#include "ipc/base/recent_times.hpp"
#include "ipc/topics/frames.hpp"

namespace tact {

class PassClock {
public:
    enum class Drawn : std::uint8_t { unknown, stamped, finished };
    static constexpr std::size_t kFramesInFlight = 4, kScopesMost = 48;
    static constexpr std::size_t kFrames = 600;   // window of the percentiles
    static constexpr std::size_t kFinished = 64;  // the same for finished frames

    explicit PassClock(Drawn drawn);
    ~PassClock();
    PassClock(const PassClock&) = delete;
    PassClock& operator=(const PassClock&) = delete;
    // The method that this driver supports.
    [[nodiscard]] static Drawn possible(bool software);

    void begin_frame();
    // at_levels: drawn at the governor's levels. Other frames (a copied view, a measurement) are not counted.
    void end_frame(bool at_levels = true);
    void fill(FrameMetrics& metrics) const;
    [[nodiscard]] Drawn drawn() const { return how_; }
    // Newest measurement of a visual path's cost; 0: none yet. Work time where the renderer's is unknown.
    [[nodiscard]] double path_s(VisualPathIndex path) const {
        return newest_path_s_[static_cast<std::size_t>(path)];
    }
    // Finishes one of the next frames pass by pass, because the levels changed; only on a software renderer.
    void measure_soon();
    // The same for the frame after the next one: a scene has appeared, and nothing is known.
    void measure_next();
    [[nodiscard]] std::uint64_t lost() const { return lost_; }

    // Times a pass from construction to destruction. Scopes do not nest. A null clock does nothing.
    class Scope {
    public:
        Scope(PassClock* clock, Pass pass) : clock_(clock), pass_(pass) {
            if (clock_ != nullptr) clock_->begin(pass_);
        }
        ~Scope() {
            if (clock_ != nullptr) clock_->end(pass_);
        }
        Scope(const Scope&) = delete;
        Scope& operator=(const Scope&) = delete;

    private:
        PassClock* clock_;
        Pass pass_;
    };

private:
    struct Stamps {
        std::array<GLuint, 2 * kScopesMost> query{};
        std::array<Pass, kScopesMost> pass{};
        std::size_t count = 0;
        bool at_levels = true;
    };
    using Times = std::array<double, kPasses>;
    void begin(Pass pass);
    void end(Pass pass);
    [[nodiscard]] static bool stamps(Pass pass) { return pass != Pass::swap && pass != Pass::motion; }
    void collect(Stamps& stamps);
    void add_drawn(const Times& drawn_s);

    const Drawn how_;
    std::uint64_t frame_ = 0, lost_ = 0;
    bool finishing_ = false;
    Instant began_{};
    Times work_s_{}, drawn_s_{};
    std::array<double, kVisualPaths> newest_path_s_{};
    std::uint64_t finished_at_ = 0, finish_at_ = 0;    // frames; 0: none
    std::vector<RecentTimes> work_, drawn_;            // per pass
    std::vector<RecentTimes> path_work_, path_drawn_;  // per visual path
    std::array<Stamps, kFramesInFlight> in_flight_{};
};

}  // namespace tact
