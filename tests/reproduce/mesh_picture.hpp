// Draws triangle meshes: flat shaded with edges, side by side at one scale.
//
// Drawn   orthographic, into a depth buffer of three by three samples per pixel; both sides of a surface, the back in
//         another tone, so that a border differs from a fold
// Thread  any.  Fails by  StartupError if the file cannot be written
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
    std::string remark{};  // a smaller line below the title
    bool edges = true;
};

struct MeshPicture {
    std::string title{}, remark{};
    std::vector<MeshPanel> panels{};
    Vec3 eye = Vec3(1.0, -1.6, 1.0);  // viewpoint in the mesh's frame; z is up
    int panel_px = 460;
    int panel_height_px = 0;  // 0: as the width
};

struct MeshImage {
    std::uint32_t width_px = 0, height_px = 0;
    std::vector<std::uint8_t> rgb;  // rows from the top
};

// Draws in the bounding box of `framed`; `width_px` by `height_px`, on white.
[[nodiscard]] MeshImage draw_mesh(const TriangleMesh& mesh, const TriangleMesh& framed, const Vec3& eye,
                                  bool edges, int width_px, int height_px);
// Writes FOLDER/NAME_a.png and so on, one per panel, in the box of the first panel's mesh; and FOLDER/NAME.panels.json with
// their titles, from which draw.py makes NAME.png.
void save(const MeshPicture& picture, const std::filesystem::path& folder, const std::string& name);

}  // namespace tact::launch
