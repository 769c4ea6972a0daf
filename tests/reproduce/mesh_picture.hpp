// Draws triangle meshes side by side at one scale, flat shaded with edges.
//
// Drawn   orthographic, with a depth buffer of three by three samples per pixel; both sides of a surface, the back in a
//         different colour, so that a border is distinguishable from a fold
// Thread  any.  Fails by  StartupError if a file cannot be written
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "ipc/base/pose.hpp"
#include "ipc/scene/mesh/progressive_mesh.hpp"

namespace tact::launch {

struct MeshPanel {
    const TriangleMesh* mesh = nullptr;
    std::string title{};   // "(b) 100 vertices, no protection"
    std::string remark{};  // second line, in smaller type
    bool edges = true;
};

struct MeshPicture {
    std::string title{}, remark{};
    std::vector<MeshPanel> panels{};
    Vec3 eye = Vec3(1.0, -1.6, 1.0);  // viewpoint in the frame of the mesh; z is up
    int panel_px = 460;
    int panel_height_px = 0;  // 0: the same as the width
};

struct MeshImage {
    std::uint32_t width_px = 0, height_px = 0;
    std::vector<std::uint8_t> rgb;  // rows from the top
};

// Scales the image to the bounding box of `framed`. Size `width_px` by `height_px`, white background.
[[nodiscard]] MeshImage draw_mesh(const TriangleMesh& mesh, const TriangleMesh& framed, const Vec3& eye,
                                  bool edges, int width_px, int height_px);
// Writes one image per panel (FOLDER/NAME_a.png and so on), scaled to the bounding box of the first mesh, and their
// titles (FOLDER/NAME.panels.json). draw.py combines them into NAME.png.
void save(const MeshPicture& picture, const std::filesystem::path& folder, const std::string& name);

}  // namespace tact::launch
