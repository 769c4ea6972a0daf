// Symmetry of equal copies: the poses of all follow from that of one and a frame.
//
// Names    C7: seven about an axis. D3: three about an axis, and their images by two-fold axes across it.
//          helix:RISE,TWIST,COPIES: each by RISE angstrom along an axis and TWIST degrees about it from the one before
// Frame    of symmetry: the axis is z; of D, one of the two-fold axes is x; metres
// Errors   StartupError for a name that is none of these
// Thread   any; allocates
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "ipc/base/pose.hpp"

namespace tact {

struct Symmetry {
    enum class Kind : std::uint8_t { cyclic, dihedral, helical };
    Kind kind = Kind::cyclic;
    unsigned order = 1;                    // n of Cn and Dn; copies of a helix
    double rise_m = 0.0, twist_rad = 0.0;  // of a helix

    [[nodiscard]] std::size_t copies() const {
        return kind == Kind::dihedral ? 2 * std::size_t{order} : order;
    }
    // The motion from the first copy to copy k, in the frame of symmetry.
    [[nodiscard]] Pose element(std::size_t k) const;
    [[nodiscard]] std::string name() const;
};

[[nodiscard]] Symmetry symmetry_of(const std::string& name);

// The same as a list; all of C2 to C12 and D2 to D7 for "find".
[[nodiscard]] std::vector<Symmetry> symmetries_of(const std::string& name);

// Where the copies are.
struct SymmetricPlace {
    Pose T_model_frame;  // of symmetry
    Pose T_model_first;  // the first copy's body
};

[[nodiscard]] Pose pose_of_copy(const Symmetry& symmetry, const SymmetricPlace& place, std::size_t k);

// The symmetric place nearest to free poses of the copies, in the order of the elements: least squares of the displacement of atoms,
// which turns count for by the radius of gyration. Damped Gauss-Newton from a place nearby.
[[nodiscard]] SymmetricPlace nearest_symmetric(const Symmetry& symmetry, std::span<const Pose> copies,
                                               const SymmetricPlace& start, double gyration_m);

// Frames in which an element of the symmetry moves one pose to another, or none. A pair determines neither the turn of the
// frame about the axis nor, of D, the two-fold axes: see across().
[[nodiscard]] std::vector<Pose> frames_from_pair(const Symmetry& symmetry, const Pose& from, const Pose& to,
                                                 double tolerance_m, double tolerance_rad);

// The same frame, turned and moved along its axis so that x is the two-fold axis that moves `from` to `to`. Returns false if no
// two-fold axis across this axis does.
[[nodiscard]] bool across(Pose& T_model_frame, const Pose& from, const Pose& to, double tolerance_m,
                          double tolerance_rad);

}  // namespace tact
