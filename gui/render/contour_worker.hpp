// Extracts contours in the background and has the final ones refined.
//
// A contour in motion is extracted repeatedly, always at the newest request, on a grid as coarse as necessary
// (contour_extract.hpp). After kRest without a request, a plain surface goes to `refine`, which may take seconds; a
// new request stops it.
//
// Thread   its own, at low priority. Callers never wait for it; the destructor alone waits for the current slice.
// Memory   one thinned copy of the map, one plain mesh of at most kPlainVerticesMax vertices at a time.
// Fails by outcome.error; the previous surface stays.
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
    // One of these, or none on failure.
    std::shared_ptr<const PlainMesh> plain;
    std::shared_ptr<const ProgressiveMesh> mesh;  // refined
    std::string error;                            // why there is no (better) mesh
    double extract_s = 0.0;                       // duration of the extraction
    // Vertices at full detail; an estimate for a coarse mesh.
    std::uint32_t vertices_full = 0;
};

// Returns the surface at this level. Throws StartupError with the reason, or Cancelled once stop() is true. Runs on
// the worker's thread.
using RefineContour =
    std::function<std::shared_ptr<const ProgressiveMesh>(double level, const std::function<bool()>& stop)>;

class ContourWorker {
public:
    static constexpr Duration kRest = std::chrono::milliseconds(300);
    static constexpr std::uint32_t kPlainVerticesMax = 300'000;

    // Without `refine`, surfaces stay plain. The content needs a map.
    ContourWorker(std::shared_ptr<const SceneContent> content, RefineContour refine, Duration rest = kRest);
    ~ContourWorker();
    ContourWorker(const ContourWorker&) = delete;
    ContourWorker& operator=(const ContourWorker&) = delete;

    // Ignores a non-finite or unchanged level.
    void request(std::size_t contour, std::optional<double> level);
    // Limits the next plain meshes: the governor's level while a contour is moved.
    void set_vertices_max(std::uint32_t vertices);
    // Returns the newest outcome for this contour, if there is one since the last call.
    [[nodiscard]] std::optional<ContourOutcome> take(std::size_t contour);

private:
    struct Contour {
        std::optional<double> requested;
        std::uint64_t request = 0, shown = 0, refined = 0;  // request numbers: newest, extracted, refined
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
    DensityGrid thin_;  // at thin_stride_; used by the worker's thread only
    std::uint32_t thin_stride_ = 1;
    std::mutex mutex_;
    std::condition_variable changed_;
    std::array<Contour, kContoursMax> contour_;
    std::uint32_t vertices_max_ = kPlainVerticesMax;
    bool stop_ = false;
    std::thread thread_;
};

}  // namespace tact
