// An oblique phantom with marks: where they are in the baked bone is where they are in the patient.
#include "ipc/scene/bone/patient_frame.hpp"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <limits>

#include "ipc/base/error.hpp"
#include "prep/drilling/bake_bone.hpp"
#include "prep/drilling/import_bone.hpp"
#include "tests/unit/prep_scan_samples.hpp"

namespace tact::prep_patient_frame_test {
namespace {

constexpr std::array<int, 3> kSize{30, 26, 22};
const Vec3 kStepMm(0.5, 0.6, 0.7), kOriginMm(-31.0, 12.5, 140.25);
// Not symmetric under any reflection or rotation. The heavier a mark, the more voxels it has.
const std::array<Vec3, 3> kMark{Vec3(6, 7, 5), Vec3(23, 9, 6), Vec3(8, 19, 16)};

Eigen::Matrix3d oblique(double angle_rad) {
    return Eigen::AngleAxisd(angle_rad, Vec3(1, 2, -3).normalized()).toRotationMatrix();
}

// space: the NRRD's; "left-posterior-superior" or "right-anterior-superior".
std::string nrrd(const Eigen::Matrix3d& axes, bool ras) {
    std::string numbers;
    for (int k = 0; k < kSize[2]; ++k)
        for (int j = 0; j < kSize[1]; ++j)
            for (int i = 0; i < kSize[0]; ++i) {
                int value = -1000;
                for (std::size_t m = 0; m < kMark.size(); ++m)
                    if ((Vec3(i, j, k) - kMark[m]).cwiseAbs().maxCoeff() <= 1.0 + static_cast<double>(m))
                        value = 1500;
                sample::put(numbers, static_cast<std::int16_t>(value));
            }
    const Vec3 to_file(ras ? -1 : 1, ras ? -1 : 1, 1);
    char text[1024];
    const auto direction = [&](int a) { return Vec3(kStepMm[a] * to_file.cwiseProduct(axes.col(a))); };
    const Vec3 x = direction(0), y = direction(1), z = direction(2), o = to_file.cwiseProduct(kOriginMm);
    std::snprintf(text, sizeof text,
                  "NRRD0004\ntype: short\ndimension: 3\nendian: little\nspace: %s\nsizes: %d %d %d\nspace "
                  "directions: (%.12g,%.12g,%.12g) (%.12g,%.12g,%.12g) (%.12g,%.12g,%.12g)\nspace origin: "
                  "(%.12g,%.12g,%.12g)\nencoding: raw\n\n",
                  ras ? "right-anterior-superior" : "left-posterior-superior", kSize[0], kSize[1], kSize[2],
                  x.x(), x.y(), x.z(), y.x(), y.y(), y.z(), z.x(), z.y(), z.z(), o.x(), o.y(), o.z());
    return text + numbers;
}

// Where a mark is in the baked bone: the centre of mass of the densities around the place that the frame says.
Vec3 found_m(const BoneData& bone, const Vec3& about_m, double reach_m) {
    Vec3 sum = Vec3::Zero();
    double mass = 0.0;
    const auto& n = bone.bricks.size;
    for (std::uint32_t z = 0; z < n[2]; ++z)
        for (std::uint32_t y = 0; y < n[1]; ++y)
            for (std::uint32_t x = 0; x < n[0]; ++x) {
                const Vec3 p = bone.bricks.origin_m + bone.bricks.voxel_m * Vec3(x, y, z);
                const double density = bone.density[bone.bricks.voxel(x, y, z)];
                if ((p - about_m).cwiseAbs().maxCoeff() > reach_m || density == 0.0) continue;
                sum += density * p;
                mass += density;
            }
    return mass > 0.0 ? Vec3(sum / mass) : Vec3::Constant(std::numeric_limits<double>::quiet_NaN());
}

TEST(PatientFrame, marks_of_an_oblique_phantom_are_where_the_frame_says) {
    const sample::ScanFolder folder;
    for (const double angle_rad : {0.0, 0.2, 0.9, 2.5})
        for (const bool ras : {false, true})
            for (const BoneFace face : {BoneFace::front, BoneFace::back, BoneFace::left, BoneFace::right,
                                        BoneFace::top, BoneFace::bottom})
                for (const double voxel_mm : {0.0, 0.8}) {
                    const Eigen::Matrix3d axes = oblique(angle_rad);
                    BoneImport o;
                    o.scan = folder.write("a.nrrd", nrrd(axes, ras));
                    o.threshold = -1000.0;  // linear in the values, so that no mark is cut
                    o.solid = 1500.0;
                    o.face = face;
                    o.voxel_mm = voxel_mm;
                    const BoneData bone = import_bone(o).bone;
                    ASSERT_TRUE(bone.patient);
                    EXPECT_NEAR(bone.patient->axes.determinant(), 1.0, 1e-9);
                    for (std::size_t m = 0; m < kMark.size(); ++m) {
                        const Vec3 right_mm = kOriginMm + axes * kMark[m].cwiseProduct(kStepMm),
                                   there_m = bone.patient->model_m(right_mm);
                        const Vec3 there = found_m(bone, there_m, 3.2e-3);
                        EXPECT_LT((bone.patient->patient_mm(there) - right_mm).norm(),
                                  0.1e3 * bone.bricks.voxel_m)
                            << "mark " << m << ", " << angle_rad << " rad, face " << static_cast<int>(face);
                    }
                }
}

TEST(PatientFrame, is_kept_in_the_scene_and_a_scan_without_orientation_has_none) {
    const sample::ScanFolder folder;
    BoneImport o;
    o.scan = folder.write("a.nrrd", nrrd(oblique(0.3), false));
    o.threshold = 0.0;
    o.solid = 1500.0;
    BoneInput input = import_bone(o);
    const PatientFrame right = *input.bone.patient;
    SceneWriter out;
    (void)bake_bone(std::move(input), out);
    const std::vector<std::byte> bytes = out.to_bytes();
    const std::optional<PatientFrame> read = read_patient_frame(SceneFile::from_bytes(bytes, "a"));
    ASSERT_TRUE(read);
    EXPECT_EQ(read->axes, right.axes);
    EXPECT_EQ(read->origin_mm, right.origin_mm);

    std::string plain = nrrd(Eigen::Matrix3d::Identity(), false);
    const std::size_t at = plain.find("space:"), end = plain.find("encoding:");
    o.scan = folder.write("b.nrrd", plain.replace(at, end - at, "sizes: 30 26 22\nspacings: 0.5 0.6 0.7\n"));
    EXPECT_FALSE(import_bone(o).bone.patient);
}

TEST(PatientFrame, a_reflection_and_other_impossible_axes_are_refused) {
    for (const int wrong : {0, 1, 2, 3}) {
        PatientFrame f;
        if (wrong == 0) f.axes(0, 0) = -1.0;
        if (wrong == 1) f.axes(1, 0) = 0.1;
        if (wrong == 2) f.origin_mm.z() = 2e5;
        if (wrong == 3) f.origin_mm.x() = std::nan("");
        SceneWriter out;
        EXPECT_THROW(write_patient_frame(out, f), StartupError) << wrong;
    }
    SceneWriter out;
    std::vector<std::byte> zeros(12 * sizeof(double));
    out.add({'P', 'A', 'T', 'I'}, 1, 0, std::move(zeros));
    const std::vector<std::byte> bytes = out.to_bytes();
    EXPECT_THROW((void)read_patient_frame(SceneFile::from_bytes(bytes, "a")), StartupError);
}

TEST(PatientFrame, letters_name_where_a_direction_points) {
    EXPECT_EQ(patient_letters({1, 0, 0}), "L");
    EXPECT_EQ(patient_letters({0, -1, 0}), "A");
    EXPECT_EQ(patient_letters({0.02, 0.01, -0.99}), "F");
    EXPECT_EQ(patient_letters({-0.5, 0.1, 0.8}), "HRP");
}

}  // namespace
}  // namespace tact::prep_patient_frame_test
