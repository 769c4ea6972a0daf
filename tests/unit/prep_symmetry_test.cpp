// Symmetries of copies: their motions against group theory, the fit of a symmetric place against noise that is known.
#include "prep/search/symmetry.hpp"

#include <gtest/gtest.h>

#include <numbers>

#include "ipc/base/error.hpp"
#include "ipc/base/random.hpp"
#include "ipc/base/units.hpp"

namespace tact::prep_symmetry_test {
namespace {

constexpr double kGyrationM = 2e-9;

double apart_m(const Pose& a, const Pose& b) {
    return (a.p_m - b.p_m).norm() + kGyrationM * rotation_vector_rad(a.q * b.q.conjugate()).norm();
}
bool among(const std::vector<Pose>& list, const Pose& pose) {
    return std::any_of(list.begin(), list.end(), [&](const Pose& p) { return apart_m(p, pose) < 1e-15; });
}
SymmetricPlace any_place(SeededRandom& random) {
    return {{2e-8 * random.direction(), random.rotation()}, {2e-8 * random.direction(), random.rotation()}};
}

TEST(Symmetry, names_are_read_as_they_are_written_and_others_are_refused) {
    for (const char* name : {"C2", "C7", "D3", "D60", "helix:27.5,-166.6,7"})
        EXPECT_EQ(symmetry_of(name).name(), name);
    EXPECT_EQ(symmetry_of("D7").copies(), 14U);
    EXPECT_EQ(symmetries_of("D7").size(), 1U);
    EXPECT_EQ(symmetries_of("find").size(), 17U);
    EXPECT_EQ(symmetry_of("helix:27.5,-166.6,7").copies(), 7U);
    for (const char* name : {"", "7", "C", "C1", "C61", "C2.5", "D-3", "T", "Cseven", "C7 ",
                             "helix:", "helix:1,2", "helix:1,2,3,4", "helix:0,10,3", "helix:1,nan,3",
                             "helix:1,10,1", "helix:1,10,2.5", "helix:1,10,100000000000"})
        EXPECT_THROW((void)symmetry_of(name), StartupError) << name;
}

// Closure, and as many different motions as copies: that is a group.
TEST(Symmetry, the_motions_of_c_and_d_are_groups_and_those_of_a_helix_repeat_one_motion) {
    for (const char* name : {"C2", "C7", "D2", "D3", "D5"}) {
        const Symmetry symmetry = symmetry_of(name);
        std::vector<Pose> all;
        for (std::size_t k = 0; k < symmetry.copies(); ++k) {
            EXPECT_FALSE(among(all, symmetry.element(k))) << name << k;
            all.push_back(symmetry.element(k));
        }
        EXPECT_TRUE(among(all, Pose{}));
        for (const Pose& a : all)
            for (const Pose& b : all) EXPECT_TRUE(among(all, a * b)) << name;
    }
    const Symmetry helix = symmetry_of("helix:27.5,-166.6,5");
    EXPECT_NEAR(helix.element(1).p_m.z(), 27.5 * kAngstromM, 1e-20);
    EXPECT_NEAR(rotation_vector_rad(helix.element(1).q).z(), -166.6 * kDegreeRad, 1e-12);
    for (std::size_t k = 0; k + 1 < 5; ++k)
        EXPECT_LT(apart_m(helix.element(1) * helix.element(k), helix.element(k + 1)), 1e-15);
}

TEST(Symmetry, a_frame_found_from_two_copies_gives_all_copies) {
    SeededRandom random(3);
    for (const char* name : {"C2", "C3", "C7", "D2", "D3", "D5", "helix:27.5,-166.6,5", "helix:-20,50,4"}) {
        const Symmetry symmetry = symmetry_of(name);
        for (int trial = 0; trial < 20; ++trial) {
            const SymmetricPlace place = any_place(random);
            std::vector<Pose> copies;
            for (std::size_t k = 0; k < symmetry.copies(); ++k)
                copies.push_back(pose_of_copy(symmetry, place, k));
            std::vector<Pose> frames = frames_from_pair(symmetry, copies[0], copies[1], 1e-12, 1e-4);
            ASSERT_FALSE(frames.empty()) << name;
            bool found = false;
            for (Pose& frame : frames) {
                if (symmetry.kind == Symmetry::Kind::dihedral) {
                    // The first copy that has turned over.
                    if (!across(frame, copies[0], copies[symmetry.order], 1e-12, 1e-4)) continue;
                }
                const SymmetricPlace again{frame, copies[0]};
                bool all = true;
                for (std::size_t k = 0; k < copies.size(); ++k) {
                    bool seen = false;
                    for (const Pose& c : copies)
                        seen = seen || apart_m(pose_of_copy(symmetry, again, k), c) < 1e-14;
                    all = all && seen;
                }
                found = found || all;
            }
            EXPECT_TRUE(found) << name << " " << trial;
            // Two poses that have nothing to do with each other are related by none.
            Pose other = copies[1];
            other.p_m += 1e-9 * (place.T_model_frame.q * Vec3::UnitZ());
            EXPECT_TRUE(frames_from_pair(symmetry, copies[0], other, 1e-10, 0.02).empty()) << name;
        }
    }
}

// Each copy is moved by up to 1 angstrom: the mean of seven errors is below that of one. The motion that is left over must be at
// right angles to every symmetric motion, which is what least squares means: no small change of the place comes nearer.
TEST(Symmetry, the_nearest_symmetric_place_is_the_least_squares_of_the_free_copies) {
    SeededRandom random(9);
    for (const char* name : {"C7", "D3", "helix:27.5,-166.6,6"}) {
        const Symmetry symmetry = symmetry_of(name);
        const SymmetricPlace right = any_place(random);
        std::vector<Pose> free;
        for (std::size_t k = 0; k < symmetry.copies(); ++k) {
            Pose p = pose_of_copy(symmetry, right, k);
            p.p_m += kAngstromM * random.uniform() * random.direction();
            p.q = quat_from_rotation_vector(0.03 * random.uniform() * random.direction()) * p.q;
            free.push_back(p);
        }
        SymmetricPlace start = right;
        start.T_model_frame.p_m += 3e-10 * random.direction();
        start.T_model_frame.q = quat_from_rotation_vector(0.1 * random.direction()) * start.T_model_frame.q;
        start.T_model_first.p_m += 3e-10 * random.direction();
        const SymmetricPlace fitted = nearest_symmetric(symmetry, free, start, kGyrationM);
        const auto misfit = [&](const SymmetricPlace& place) {
            double sum = 0.0;
            for (std::size_t k = 0; k < free.size(); ++k) {
                const Pose at = pose_of_copy(symmetry, place, k);
                sum += (at.p_m - free[k].p_m).squaredNorm() +
                       std::pow(kGyrationM * rotation_vector_rad(at.q * free[k].q.conjugate()).norm(), 2);
            }
            return sum;
        };
        const double least = misfit(fitted);
        EXPECT_LT(least, misfit(right)) << name;
        for (int trial = 0; trial < 200; ++trial) {
            SymmetricPlace near = fitted;
            near.T_model_frame.p_m += 1e-12 * random.direction();
            near.T_model_first.p_m += 1e-12 * random.direction();
            near.T_model_frame.q =
                quat_from_rotation_vector(1e-3 * random.direction()) * near.T_model_frame.q;
            near.T_model_first.q =
                quat_from_rotation_vector(1e-3 * random.direction()) * near.T_model_first.q;
            EXPECT_GT(misfit(near), least * (1.0 - 1e-6)) << name;
        }
    }
}

}  // namespace
}  // namespace tact::prep_symmetry_test
