// Pictures of the demos, part of the program.
//
// Thread   frame thread, context current.
#pragma once

#include <cstdint>
#include <span>
#include <string_view>
#include <vector>

#include "gui/window/start_page.hpp"

namespace tact {

// PNG of a demo; empty: it has none.
[[nodiscard]] std::span<const std::uint8_t> demo_picture(std::string_view name);

// Textures of the pictures; the destructor deletes them.
class DemoPictures {
public:
    explicit DemoPictures(std::vector<DemoCard>& cards);  // sets their `picture`
    ~DemoPictures();
    DemoPictures(const DemoPictures&) = delete;
    DemoPictures& operator=(const DemoPictures&) = delete;

private:
    std::vector<unsigned> textures_;
};

}  // namespace tact
