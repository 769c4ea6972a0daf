// Screenshots of the window: one at the end, one on request, and a numbered series of the 3D view.
//
// Thread   frame thread.  Fails by  a log line, and failed().
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "gui/render/target.hpp"
#include "ipc/base/clock.hpp"

namespace tact {

class Screenshots {
public:
    // path: of the screenshot at the end; empty: neither that nor a series. every_s: interval of the series; 0: none.
    // stage: of the stereo display at the end; empty: none.
    Screenshots(std::string path, double every_s, std::string stage)
        : path_(std::move(path)), stage_(std::move(stage)), every_s_(every_s) {}

    [[nodiscard]] bool wanted_at_end() const { return !path_.empty() || !stage_.empty(); }
    // The first is due as soon as there is something to show.
    [[nodiscard]] bool series_due(Instant now, bool something_to_see);
    struct View {
        int x_px = 0, y_px = 0, width_px = 1, height_px = 1;  // y from below
    };
    // Without the overlay on the view.
    void save_of_series(const Image& window, const View& view);
    void save_at_end(const Image& window) {
        if (!path_.empty()) write(path_, window);
    }
    // One for both, or left and right; none without a stereo display, which is an error if it was to be saved.
    void save_stage(const std::vector<Image>& eyes);
    void save_now(const Image& window);  // in the output folder
    [[nodiscard]] bool failed() const { return failed_; }

private:
    void write(const std::filesystem::path& path, const Image& image);

    const std::string path_, stage_;
    const double every_s_;
    std::uint32_t series_ = 0;  // so far
    Instant series_from_{};
    bool failed_ = false;
};

}  // namespace tact
