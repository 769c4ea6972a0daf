// The user's choice of visible scene content and its style.
#pragma once

namespace tact {

struct SceneToggles {
    bool surface = true, backbone = true, codebook = true, graph = true, force = true, box = false;
    int style = 0;  // glass, solid, wire
    bool depth_cue = true;
    bool smooth_edges = true;  // initially as the renderer allows; not saved
    bool shading = true;       // by depth; in software rendering once the view rests
    bool white_ground = false;
    bool cut = false;          // what is nearer than a plane is not drawn
    float cut_at = 0.0F;       // of the plane: before the camera's target, radii of the scene
    int labels = 0;            // of bodies: none, chains, residues
    bool frame_times = false;  // the table of passes
    bool sound = true;         // of the drill
    bool microscope = false;   // a drilling scene through an operating microscope
    bool detail = false;       // edge lengths as colour, if the scene has a forest
    int molecule = 4;          // trace, tube, sticks, spheres, cartoon, surface
    int colouring = 0;         // by chain, element, body
};

}  // namespace tact
