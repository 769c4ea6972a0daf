#include "prep/mesh_file/write_stl.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <string>

#include "ipc/base/part_file.hpp"
#include "prep/mesh_file/little_endian.hpp"

namespace tact {

void write_stl(const std::filesystem::path& path, const TriangleMesh& mesh, const std::string& header) {
    PartFile file(path, "mesh");
    constexpr std::size_t kHeader = 80, kPiece = std::size_t{1} << 20;
    std::string out = header.substr(0, kHeader - 1);
    out.resize(kHeader, ' ');
    put_word(out, static_cast<std::uint32_t>(mesh.triangles()));
    for (std::size_t t = 0; t < mesh.triangles(); ++t) {
        const auto at = [&](std::size_t corner) {
            return Eigen::Vector3f(Eigen::Map<const Eigen::Vector3f>(
                &mesh.position_m[std::size_t{3} * mesh.triangle[3 * t + corner]]));
        };
        const Eigen::Vector3f a = at(0), b = at(1), c = at(2);
        const Eigen::Vector3f normal = (b - a).cross(c - a).stableNormalized();
        for (const Eigen::Vector3f& v : {normal, a, b, c})
            for (int i = 0; i < 3; ++i) put_float(out, v[i]);
        out.append(2, '\0');
        if (out.size() >= kPiece) {
            file.write(out);
            out.clear();
        }
    }
    file.write(out);
    file.finish();
}

}  // namespace tact
