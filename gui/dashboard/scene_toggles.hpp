// What of a scene is shown, and how: a person's choice.
#pragma once

namespace tact {

struct SceneToggles {
    bool surface = true, backbone = true, codebook = true, graph = true, force = true, box = false;
    int style = 0;  // glass, solid, wire
    bool depth_cue = true;
    bool smooth_edges = true;  // begins as the renderer allows; not kept
    bool frame_times = false;  // the table of passes
    bool detail = false;       // the length of edges as colour, where the scene has a forest
    int molecule = 1;          // trace, tube, sticks, spheres
    int colouring = 0;         // by chain, element, body
};

}  // namespace tact
