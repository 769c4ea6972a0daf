// Fields from files and from code: geometry, errors by line, and a gain that matches the analytic field.
#include <gtest/gtest.h>
#include <unistd.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <sstream>

#include "ipc/base/error.hpp"
#include "prep/field/bake_field.hpp"
#include "prep/field/charges.hpp"
#include "prep/field/import_field.hpp"

namespace tact::prep_field_test {
namespace {

std::string error_of(const std::string& csv) {
    try {
        static_cast<void>(import_field_csv(csv, "a.csv", 1e-3));
    } catch (const StartupError& e) {
        return e.what();
    }
    return {};
}

std::string csv_of(std::uint32_t nx, std::uint32_t ny, std::uint32_t nz, const char* head = "") {
    std::ostringstream out;
    out << head;
    for (std::uint32_t x = 0; x < nx; ++x)  // z fastest; any order is valid
        for (std::uint32_t y = 0; y < ny; ++y)
            for (std::uint32_t z = 0; z < nz; ++z)
                out << 10.0 + 2.0 * x << ',' << -5.0 + y << ',' << 0.5 * z << ',' << 100.0 * x + 10.0 * y + z
                    << '\n';
    return out.str();
}

TEST(FieldImport, a_csv_in_any_order_becomes_a_grid_with_its_geometry) {
    const ImportedField field = import_field_csv(csv_of(5, 6, 7, "x,y,z,phi\n# a remark\n\n"), "a.csv", 1e-3);
    const DensityGrid& g = field.grid;
    EXPECT_EQ(g.size, (std::array<std::uint32_t, 3>{5, 6, 7}));
    EXPECT_TRUE(g.origin_m.isApprox(Vec3(10e-3, -5e-3, 0.0)));
    EXPECT_TRUE(g.spacing_m.isApprox(Vec3(2e-3, 1e-3, 0.5e-3)));
    EXPECT_EQ(g.at(4, 2, 3), 423.0F);
}

TEST(FieldImport, three_columns_give_a_potential_constant_along_z) {
    std::string csv;
    for (int y = 0; y < 5; ++y)
        for (int x = 0; x < 6; ++x)
            csv += std::to_string(x) + " " + std::to_string(y) + " " + std::to_string(x * y) + "\n";
    const DensityGrid g = import_field_csv(csv, "a.csv", 1.0).grid;
    EXPECT_GE(g.size[2], kFieldPointsMin);
    for (std::uint32_t z = 0; z < g.size[2]; ++z) EXPECT_EQ(g.at(5, 4, z), 20.0F);
}

TEST(FieldImport, invalid_files_are_refused_with_line_and_fix) {
    const auto refused = [](const std::string& csv, const char* part) {
        const std::string error = error_of(csv);
        EXPECT_NE(error.find(part), std::string::npos) << error;
    };
    refused("", "the file has no points");
    refused("x,y,z,phi\n", "the file has no points");
    refused("0 0 0 1\n0 0 a 2\n", "line 2");
    refused("0 0 0 1\n0 0 2\n", "the line has 3 numbers");
    refused("0 0 0 nan\n", "not finite");
    refused("0 0 0 1e999\n", "not finite");
    refused(csv_of(5, 5, 5) + "10,-5,0,7\n", "do not fill a grid");
    std::string twice = csv_of(5, 5, 5);
    twice.replace(
        0, twice.find('\n'),
        twice.substr(twice.find('\n') + 1, twice.find('\n', twice.find('\n') + 1) - twice.find('\n') - 1));
    refused(twice, "given twice");
    refused(csv_of(3, 5, 5), "axis x has 3 points");
    std::string uneven = csv_of(5, 5, 5);
    for (std::size_t at = 0; (at = uneven.find("12,", at)) != std::string::npos; at += 3)
        uneven.replace(at, 3, "12.5,");
    refused(uneven, "unequal steps");
}

TEST(FieldImport, an_nrrd_keeps_its_geometry_and_refuses_non_finite_values) {
    const auto path =
        std::filesystem::temp_directory_path() / ("tact_field_" + std::to_string(getpid()) + ".nrrd");
    const auto write = [&](float third) {
        std::ofstream out(path, std::ios::binary);
        out << "NRRD0004\ntype: float\ndimension: 3\nsizes: 4 5 6\nspacings: 1 2 3\nencoding: raw\nendian: "
               "little\n\n";
        for (int i = 0; i < 120; ++i) {
            const float v = i == 2 ? third : static_cast<float>(i);
            out.write(reinterpret_cast<const char*>(&v), sizeof v);
        }
    };
    write(2.0F);
    const DensityGrid g = import_field(path, 1e-3).grid;
    EXPECT_EQ(g.size, (std::array<std::uint32_t, 3>{4, 5, 6}));
    EXPECT_TRUE(g.spacing_m.isApprox(Vec3(1e-3, 2e-3, 3e-3)));
    EXPECT_EQ(g.at(3, 4, 5), 119.0F);
    write(std::nanf(""));
    EXPECT_THROW(static_cast<void>(import_field(path, 1e-3)), StartupError);
    std::filesystem::remove(path);
}

TEST(FieldBake, the_gain_gives_the_maximum_force_at_the_largest_gradient) {
    const TwoCharges charges;
    FieldInput input;
    input.grid = two_charges_grid(charges, 65);
    input.stiffness_n_m_max = 1e9;
    SceneWriter out;
    const BakedField baked = bake_field(input, out);
    double most = 0.0;
    constexpr double kStep = 1e-4;
    for (int i = 0; i < 2000; ++i) {  // along the axis through both charges, where the field is largest
        const Vec3 at(-0.5 + 5e-4 * i, 0.0, 0.0), d(kStep, 0.0, 0.0);
        most =
            std::max(most, std::abs(potential(charges, at + d) - potential(charges, at - d)) / (2.0 * kStep));
    }
    EXPECT_NEAR(baked.field.force_n_m_per_unit * most, input.force_n_max, 0.02 * input.force_n_max);
    EXPECT_NEAR(baked.field.force_n_max, input.force_n_max, 1e-9);
}

TEST(FieldBake, a_field_too_stiff_gets_a_smaller_gain) {
    FieldInput input;
    input.grid = two_charges_grid({}, 65);
    input.stiffness_n_m_max = 50.0;
    SceneWriter out;
    const BakedField baked = bake_field(input, out);
    EXPECT_EQ(baked.field.stiffness_n_m, 50.0);
    EXPECT_LT(baked.field.force_n_max, input.force_n_max);
    EXPECT_NE(baked.note.find("limited by the stiffness"), std::string::npos);
}

TEST(FieldBake, the_scene_reads_back_unchanged) {
    FieldInput input;
    input.grid = two_charges_grid({}, 17);
    input.title = std::string("two charges");
    input.unit = std::string("V");
    SceneWriter out;
    const BakedField baked = bake_field(input, out);
    const std::vector<std::byte> bytes = out.to_bytes();
    const SceneFile file = SceneFile::from_bytes(bytes, "a.tact");
    const FieldMeta read = read_field_meta(file);
    EXPECT_EQ(std::memcmp(&read, &baked.field, sizeof read), 0);
    EXPECT_EQ(read_grid(file).size[0], 17U + 2 * kFieldPad);
}

}  // namespace
}  // namespace tact::prep_field_test
