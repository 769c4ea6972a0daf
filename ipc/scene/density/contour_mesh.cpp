#include "ipc/scene/density/contour_mesh.hpp"

#include "ipc/scene/file/bytes.hpp"

namespace tact {
namespace {

constexpr SectionTag kContourTag{'C', 'O', 'N', 'T'};
constexpr std::uint32_t kContourVersion = 1;
static_assert(sizeof(ContourOrigin) == 16);

}  // namespace

void write_contour(SceneWriter& out, const ContourOrigin& origin, const ProgressiveMeshData& mesh) {
    BytesOut bytes;
    bytes.put(origin);
    out.add(kContourTag, kContourVersion, 0, bytes.take());
    write_mesh(out, 0, mesh);
}

std::unique_ptr<ProgressiveMesh> read_contour(const SceneFile& file, const ContourOrigin& expected) {
    BytesIn in(file.section(kContourTag, kContourVersion), file.name() + ", section CONT 0");
    const auto origin = in.get<ContourOrigin>("origin");
    in.finish();
    if (!(origin == expected)) in.fail("it belongs to another scene or level than requested");
    return std::make_unique<ProgressiveMesh>(read_mesh(file, 0));
}

}  // namespace tact
