// The user's choice of visible scene content and its style.
#pragma once

namespace tact {

struct SceneToggles {
    bool surface = true, backbone = true, codebook = true, graph = true, force = true, box = false;
    int style = 0;  // glass, solid, wire
    bool depth_cue = true;
    bool smooth_edges = true;  // initially as the renderer allows; not saved
    bool frame_times = false;  // the table of passes
    bool sound = true;         // of the drill
    bool microscope = false;   // a drilling scene through an operating microscope
    bool detail = false;       // edge lengths as colour, if the scene has a forest
    int molecule = 4;          // trace, tube, sticks, spheres, cartoon
    int colouring = 0;         // by chain, element, body
};

}  // namespace tact
