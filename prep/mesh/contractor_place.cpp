// The optimum of the quadric lies outside rounded surfaces and borders. Volume and border area are preserved by a
// condition that is linear in the new position (Lindstrom, Turk 1998), reached along the cheapest direction.
#include "prep/mesh/contractor.hpp"

namespace tact {

// Preserves the volume on either side of the surface.
void Contractor::keep_volume(const Quadric& sum, std::uint32_t u, const Eigen::Vector3f& across,
                             Place& place) const {
    Eigen::Vector3f g = Eigen::Vector3f::Zero();  // g . d = h preserves the volume
    float h = 0.0F;
    for (const Wing& wing : star_u_) g += wing.p_next.cross(wing.p_last);
    for (const Wing& wing : star_v_) {
        if (wing.next == u || wing.last == u) continue;
        const Eigen::Vector3f n = (wing.p_next - across).cross(wing.p_last - across);
        g += n;
        h += n.dot(across);
    }
    move_to_plane(sum, across, g, h, place);
}

// Preserves the area beside a border that runs through the pair or past one of its ends. Where borders meet or branch
// the position is unchanged.
void Contractor::keep_border(const Quadric& sum, std::uint32_t u, std::uint32_t v, Place& place) {
    const Eigen::Vector3f origin = vertex_[u].at();
    struct End {
        std::uint32_t count = 0;
        std::array<std::uint32_t, 2>
            along{};  // neighbours along border edges, except the other end of the pair
    };
    bool between = false;  // the pair itself is a border edge
    const auto end = [&](std::uint32_t self, std::uint32_t other) {
        End found;
        if ((vertex_[self].stamp & kBorder) == 0) return found;
        gather(self);
        for (const std::uint32_t w : ring_) {
            if (hits_[w] == 2) continue;
            if (w == other) {
                between = true;
            } else {
                if (found.count < 2) found.along[found.count] = w;
                ++found.count;
            }
        }
        return found;
    };
    const End at_u = end(u, v), at_v = end(v, u);
    const Eigen::Vector3f across = vertex_[v].at() - origin;
    const auto relative = [&](std::uint32_t w) -> Eigen::Vector3f { return vertex_[w].at() - origin; };
    if (between) {
        if (at_u.count == 1 && at_v.count == 1) {
            const Eigen::Vector3f a = relative(at_u.along[0]), b = relative(at_v.along[0]);
            move_to_line(sum, across, a, b, across.cross(b), place);
        } else if (at_u.count != 1 && at_v.count == 1) {
            place = {Eigen::Vector3f::Zero(), sum(Eigen::Vector3f::Zero())};
        } else if (at_v.count != 1 && at_u.count == 1) {
            place = {across, sum(across)};
        }
        return;
    }
    const auto hold = [&](const End& at, const Eigen::Vector3f& self) {
        if (at.count == 2) {
            const Eigen::Vector3f a = relative(at.along[0]), b = relative(at.along[1]);
            move_to_line(sum, across, a, b, a.cross(self) + self.cross(b), place);
        } else {
            place = {self, sum(self)};
        }
    };
    if (at_u.count > 0 && at_v.count == 0) hold(at_u, Eigen::Vector3f::Zero());
    if (at_v.count > 0 && at_u.count == 0) hold(at_v, across);
}

}  // namespace tact
