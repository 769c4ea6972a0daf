// Mesh figures of the docking paper: 3 (an open border with and without protection), 4 (a chaperonin at three sizes)
// and 6 (the surface before and after adaptation).
//
// Method  tact-prep, as a child process, simplifies the meshes; they are measured and drawn here
// Thread  one; takes some seconds.  Fails by  StartupError
#pragma once

#include <filesystem>
#include <vector>

#include "ipc/scene/mesh/progressive_mesh.hpp"
#include "tests/reproduce/summary.hpp"

namespace tact::launch {

// Writes fig3_border.png, fig4_chaperonin.png and meshes.csv into `out`; `scratch` is for intermediate files.
std::vector<SummaryRow> mesh_figures(const std::filesystem::path& out, const std::filesystem::path& scratch);

// Writes fig6_triangles.png: the mesh with all vertices and with `vertices` vertices.
std::vector<SummaryRow> adapted_figure(const ProgressiveMesh& mesh, std::uint32_t vertices,
                                       const std::filesystem::path& out);

}  // namespace tact::launch
