#include "ipc/scene/mesh/touch_tool.hpp"

#include <array>
#include <cmath>
#include <string>

#include "ipc/scene/file/bytes.hpp"

namespace tact {
namespace {

constexpr double kToolLargestM = 1e6;

struct ToolHeader {
    std::uint32_t points, vertices, triangles, reserved;  // the last zero
    double ball_m;
};
static_assert(sizeof(ToolHeader) == 24);

}  // namespace

void write_touch_tool(SceneWriter& out, const TouchTool& tool) {
    BytesOut bytes;
    bytes.put(ToolHeader{.points = static_cast<std::uint32_t>(tool.points()),
                         .vertices = static_cast<std::uint32_t>(tool.drawn_m.size() / 3),
                         .triangles = static_cast<std::uint32_t>(tool.drawn.size() / 3),
                         .reserved = 0,
                         .ball_m = tool.ball_m});
    bytes.put_all(tool.point_m);
    bytes.put_all(tool.normal);
    bytes.put_all(tool.parent);
    bytes.put_all(tool.cover_m);
    bytes.put_all(tool.drawn_m);
    bytes.put_all(tool.drawn);
    out.add(TouchTool::kTag, TouchTool::kVersion, 0, bytes.take());
}

TouchTool read_touch_tool(const SceneFile& file) {
    BytesIn in(file.section(TouchTool::kTag, TouchTool::kVersion), file.name() + ", section TOOL");
    const auto header = in.get<ToolHeader>("header");
    if (header.points == 0 || header.points > TouchTool::kPointsMax)
        in.fail("it has " + std::to_string(header.points) + " points; allowed are 1 to " +
                std::to_string(TouchTool::kPointsMax));
    if (header.vertices > TouchTool::kDrawnMax || header.triangles > TouchTool::kDrawnMax)
        in.fail("its displayed mesh is larger than " + std::to_string(TouchTool::kDrawnMax) + " triangles");
    if (header.reserved != 0) in.fail("reserved bytes of its header are not zero");
    if (!(header.ball_m > 0.0 && header.ball_m <= kToolLargestM))
        in.fail("the radius of its spheres is out of range");
    TouchTool tool;
    tool.ball_m = header.ball_m;
    tool.point_m = in.get_all<float>(std::uint64_t{3} * header.points, "points");
    tool.normal = in.get_all<OctNormal>(header.points, "normals");
    tool.parent = in.get_all<std::uint32_t>(header.points, "parents");
    tool.cover_m = in.get_all<float>(header.points, "covers");
    tool.drawn_m = in.get_all<float>(std::uint64_t{3} * header.vertices, "drawn positions");
    tool.drawn = in.get_all<std::uint32_t>(std::uint64_t{3} * header.triangles, "drawn corners");
    in.finish();
    in.check_finite(tool.point_m, kToolLargestM, "coordinate");
    in.check_finite(tool.drawn_m, kToolLargestM, "drawn coordinate");
    in.check_finite(tool.cover_m, 4.0 * kToolLargestM, "cover");
    for (std::uint32_t i = 0; i < header.points; ++i) {
        if (i == 0 ? tool.parent[0] != 0 : tool.parent[i] >= i)
            in.fail("point " + std::to_string(i) + " has a parent that comes after it");
        if (tool.cover_m[i] < 0.0F || (i > 0 && tool.cover_m[i] > tool.cover_m[i - 1]))
            in.fail("cover " + std::to_string(i) + " is negative or larger than the one before it");
    }
    for (const std::uint32_t v : tool.drawn) {
        if (v >= header.vertices)
            in.fail("a drawn corner refers to vertex " + std::to_string(v) + " of " +
                    std::to_string(header.vertices));
    }
    return tool;
}

}  // namespace tact
