#include "gui/window/screenshots.hpp"

#include <spdlog/spdlog.h>

#include "gui/base/output_folder.hpp"
#include "ipc/base/error.hpp"
#include "ipc/image/png.hpp"

namespace tact {
namespace {

constexpr std::uint32_t kSeriesMost = 9999;

}  // namespace

bool Screenshots::series_due(Instant now, bool something_to_see) {
    if (!(every_s_ > 0.0) || path_.empty() || !something_to_see || series_ >= kSeriesMost) return false;
    if (series_ == 0) series_from_ = now;
    return to_s(now - series_from_) >= every_s_ * series_;
}

void Screenshots::save_of_series(const Image& window, const View& view) {
    Image part{static_cast<std::uint32_t>(view.width_px), static_cast<std::uint32_t>(view.height_px), {}};
    const auto top = window.height_px - static_cast<std::uint32_t>(view.y_px) - part.height_px;
    for (std::uint32_t y = 0; y < part.height_px; ++y) {
        const auto* const row =
            window.rgb.data() + std::size_t{3} * ((std::size_t{top} + y) * window.width_px +
                                                  static_cast<std::uint32_t>(view.x_px));
        part.rgb.insert(part.rgb.end(), row, row + std::size_t{3} * part.width_px);
    }
    std::filesystem::path path = path_;
    const std::string number = std::to_string(++series_);
    path.replace_filename(path.stem().string() + (number.size() < 2 ? "-0" : "-") + number + ".png");
    write(path, part);
}

void Screenshots::save_stage(const std::vector<Image>& eyes) {
    if (stage_.empty()) return;
    if (eyes.empty()) {
        spdlog::error("writing {}: no stereo display is open", stage_);
        failed_ = true;
        return;
    }
    if (eyes.size() == 1) return write(stage_, eyes[0]);
    for (std::size_t eye = 0; eye < eyes.size(); ++eye) {
        std::filesystem::path path = stage_;
        path.replace_filename(path.stem().string() + (eye == 0 ? "-left" : "-right") +
                              path.extension().string());
        write(path, eyes[eye]);
    }
}

void Screenshots::save_now(const Image& window) {
    try {
        write(new_output("picture", ".png"), window);
    } catch (const StartupError& e) {
        spdlog::error("{}", e.what());
        failed_ = true;
    }
}

void Screenshots::write(const std::filesystem::path& path, const Image& image) {
    try {
        write_png(path, image.width_px, image.height_px, image.rgb);
        spdlog::info("wrote {}", path.string());
    } catch (const StartupError& e) {
        spdlog::error("{}", e.what());
        failed_ = true;
    }
}

}  // namespace tact
