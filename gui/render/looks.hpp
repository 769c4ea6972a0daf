// Styles and colourings that the user can choose.
#pragma once

namespace tact {

enum class MoleculeStyle : int {
    trace,    // straight sticks between the trace atoms (C-alpha, P)
    tube,     // a smooth tube along them
    sticks,   // bonds
    spheres,  // atoms at their van der Waals radii
    cartoon,  // helices as ribbons, strands as arrows, the rest as tubes
    surface,  // a smooth closed surface over the atoms
};

enum class Colouring : int {
    chain,
    element,  // carbon by chain
    body,
    fit,  // of each residue to the map
};

struct MoleculeLook {
    MoleculeStyle style = MoleculeStyle::cartoon;
    Colouring colouring = Colouring::chain;
};

enum class SurfaceStyle : int { glass, solid, wire };

}  // namespace tact
