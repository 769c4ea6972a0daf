// A rough sphere of 18 000 triangles with a block of 300 points as the tool, baked.
#pragma once

#include <cstddef>
#include <memory>
#include <utility>
#include <vector>

#include "prep/surface/bake_surface.hpp"
#include "prep/synthetic/made_tool.hpp"
#include "prep/synthetic/rough_sphere.hpp"

namespace tact {

struct RoughSphereScene {
    std::vector<std::byte> bytes;
    std::unique_ptr<SceneFile> file;
    SceneMeta meta{};
    explicit RoughSphereScene(bool forest) {
        SceneWriter out;
        SurfaceInput input;
        input.mesh = rough_sphere(30);
        input.tool = made_tool("block");
        input.tool_sampling.points = 300;
        input.picture = false;
        input.forest = forest;
        meta = bake_surface(std::move(input), out).meta;
        bytes = out.to_bytes();
        file = std::make_unique<SceneFile>(SceneFile::from_bytes(bytes, "sphere.tact"));
    }
};

}  // namespace tact
