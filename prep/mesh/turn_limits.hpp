// How far simplification lets a triangle turn, in one contraction and in one round of relaxation.
#pragma once

#include <Eigen/Core>

namespace tact {

template <class T>
inline constexpr T kTurnCosine = T(0.5);  // by 60 degrees
// And it comes no nearer than 26 degrees to lying on its neighbour.
template <class T>
inline constexpr T kFoldCosine = T(-0.9);
// Where a vertex stands for a piece of surface that looks to one side in the main, its triangles keep to that side,
// however many steps they turn in.
template <class T>
class Side {
public:
    using Vector = Eigen::Matrix<T, 3, 1>;
    // The sum of double areas as vectors, and of their sizes.
    Side(const Vector& facing, T area) {
        const T length = facing.norm();
        if (length > kCoherent * area) along_ = facing * (T(1) / length);
    }
    // Whether a triangle leaves it: a normal and its length, before and after.
    [[nodiscard]] bool left_by(const Vector& before, T before_length, const Vector& after,
                               T after_length) const {
        const T height = after.dot(along_);
        return height < kCosine * after_length && height * before_length < before.dot(along_) * after_length;
    }

private:
    static constexpr T kCosine = T(0.5), kCoherent = T(0.9);
    Vector along_ = Vector::Zero();  // zero: there is no such side, and nothing leaves it
};

}  // namespace tact
