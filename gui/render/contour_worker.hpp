// Extracts contours beside the frame loop, and has the final ones refined.
//
// A contour that is being moved is extracted again and again, the newest request always, on a grid as coarse as
// it must be (contour_extract.hpp). When nothing has been requested for kRest and a surface is still a plain
// one, it is given to `refine`, which may take seconds; a request in between stops it.
//
// Thread   one of its own, at low priority. The callers never wait for it, except that the destructor waits
//          for the slice under way.
// Memory   one thinned copy of the map, one plain mesh of at most kPlainVerticesMax vertices at a time.
// Fails by outcome.error; the surface before stays.
#pragma once

#include <array>
#include <condition_variable>
#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <thread>

#include "gui/render/contour_extract.hpp"
#include "gui/render/scene_content.hpp"
#include "ipc/base/clock.hpp"

namespace tact {

inline constexpr std::size_t kContoursMax = 4;

struct ContourOutcome {
    double level = 0.0;
    std::uint32_t stride = 1;  // of a plain mesh
    // One of these, or none where it failed.
    std::shared_ptr<const PlainMesh> plain;
    std::shared_ptr<const ProgressiveMesh> mesh;  // refined
    std::string error;                            // why there is no (better) one
    double extract_s = 0.0;                       // how long it took
    // What the surface has at full detail; of a coarse one an estimate.
    std::uint32_t vertices_full = 0;
};

// Returns the surface at this level, or throws StartupError with the reason; Cancelled once stop() is true.
// Called on the worker's thread.
using RefineContour =
    std::function<std::shared_ptr<const ProgressiveMesh>(double level, const std::function<bool()>& stop)>;

class ContourWorker {
public:
    static constexpr Duration kRest = std::chrono::milliseconds(300);
    static constexpr std::uint32_t kPlainVerticesMax = 300'000;

    // Without `refine` surfaces stay plain. The content needs a map.
    ContourWorker(std::shared_ptr<const SceneContent> content, RefineContour refine, Duration rest = kRest);
    ~ContourWorker();
    ContourWorker(const ContourWorker&) = delete;
    ContourWorker& operator=(const ContourWorker&) = delete;

    // A level that is not finite is no request. Of an unchanged level nothing is done.
    void request(std::size_t contour, std::optional<double> level);
    // Most vertices of the next plain meshes: the level of the governor while a contour is moved.
    void set_vertices_max(std::uint32_t vertices);
    // What has come since the last call for this contour.
    [[nodiscard]] std::optional<ContourOutcome> take(std::size_t contour);

private:
    struct Contour {
        std::optional<double> requested;
        std::uint64_t request = 0, shown = 0, refined = 0;  // numbers of requests: asked, extracted, refined
        std::optional<ContourOutcome> news;
        std::uint32_t stride = 0;
        Instant requested_at{};
    };
    void work();
    void extract(std::size_t contour, std::unique_lock<std::mutex>& lock);
    void refine(std::size_t contour, std::unique_lock<std::mutex>& lock);
    [[nodiscard]] const DensityGrid& grid(std::uint32_t stride);

    const std::shared_ptr<const SceneContent> content_;
    const RefineContour refine_;
    const Duration rest_;
    DensityGrid thin_;  // of thin_stride_; of the worker's thread
    std::uint32_t thin_stride_ = 1;
    std::mutex mutex_;
    std::condition_variable changed_;
    std::array<Contour, kContoursMax> contour_;
    std::uint32_t vertices_max_ = kPlainVerticesMax;
    bool stop_ = false;
    std::thread thread_;
};

}  // namespace tact
