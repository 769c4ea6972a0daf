// Static and dynamic friction: which coefficient holds at the proxy, from what the last step found.
//
// Sticks    the static coefficient holds until the pull along the surface reaches it
// Slides    from the next step on the dynamic coefficient holds, until the proxy has rested for kRest_s or touches nothing. So
//           neither an edge of the mesh nor the steps of an encoder stop a slide
// Thread    servo; constant time
#pragma once

#include "ipc/base/rt.hpp"

namespace tact {

class StickSlip {
public:
    static constexpr double kRest_s = 0.02;
    static constexpr double kRim = 1e-3;  // relative: a pull this close to the coefficient has reached it

    StickSlip(double static_friction, double dynamic_friction)
        : static_(static_friction), dynamic_(dynamic_friction) {}

    [[nodiscard]] double coefficient() const noexcept TACT_RT { return slides_ ? dynamic_ : static_; }
    [[nodiscard]] bool slides() const noexcept TACT_RT { return slides_; }
    void reset() noexcept TACT_RT {
        slides_ = false;
        rested_s_ = 0.0;
    }
    // After a step in contact. push, pull: onto and along the surface, in one unit; moved: the proxy.
    void add(double push, double pull, bool moved, double dt_s) noexcept TACT_RT {
        if (!slides_) {
            slides_ = pull >= (1.0 - kRim) * static_ * push;
            rested_s_ = 0.0;
            return;
        }
        rested_s_ = moved ? 0.0 : rested_s_ + dt_s;
        if (rested_s_ >= kRest_s) reset();
    }

private:
    double static_, dynamic_;
    bool slides_ = false;
    double rested_s_ = 0.0;
};

}  // namespace tact
