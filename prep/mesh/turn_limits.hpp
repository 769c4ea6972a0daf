// Limits on the rotation of a triangle, in one contraction and in one round of relaxation.
#pragma once

#include <Eigen/Core>

namespace tact {

template <class T>
inline constexpr T kTurnCosine = T(0.5);  // at most 60 degrees
// A triangle comes no nearer than 30 degrees to lying on its neighbour.
template <class T>
inline constexpr T kFoldCosine = T(-0.866);
// If the surface that a vertex represents mostly faces one side, its triangles stay on that side over all steps.
template <class T>
class Side {
public:
    using Vector = Eigen::Matrix<T, 3, 1>;
    // facing: sum of the double areas as vectors; area: sum of their norms.
    Side(const Vector& facing, T area) {
        const T length = facing.norm();
        if (length > kCoherent * area) along_ = facing * (T(1) / length);
    }
    // True if a triangle leaves the side: its normal and the length of the normal, before and after.
    [[nodiscard]] bool left_by(const Vector& before, T before_length, const Vector& after,
                               T after_length) const {
        const T height = after.dot(along_);
        return height < kCosine * after_length && height * before_length < before.dot(along_) * after_length;
    }

private:
    static constexpr T kCosine = T(0.5), kCoherent = T(0.9);
    Vector along_ = Vector::Zero();  // zero: no common side, left_by() is always false
};

}  // namespace tact
