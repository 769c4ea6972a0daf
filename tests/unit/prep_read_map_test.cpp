// Masks, half-maps and the resolution of a map: the Fourier shell correlation against direct sums in double precision and against
// the signal and noise that the half-maps were made of.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <complex>
#include <filesystem>
#include <fstream>
#include <numbers>
#include <random>

#include "ipc/base/units.hpp"
#include "prep/map/map_mask.hpp"
#include "prep/map/map_statistics.hpp"
#include "prep/map/read_map.hpp"
#include "prep/map/shell_correlation.hpp"
#include "tests/support/error_of.hpp"
#include "tests/support/map_file.hpp"

namespace tact::prep_read_map_test {
namespace {

constexpr double kTurn = 2.0 * std::numbers::pi;

DensityGrid box(std::uint32_t x, std::uint32_t y, std::uint32_t z, double voxel_a) {
    DensityGrid g;
    g.size = {x, y, z};
    g.spacing_m = Vec3::Constant(voxel_a * kAngstromM);
    g.origin_m = Vec3(-3.0, 5.0, 7.0) * kAngstromM;
    g.values.assign(std::size_t{x} * y * z, 0.0F);
    return g;
}

using sample::error_of;

// One wave of the transform, by its definition.
std::complex<double> wave_of(const DensityGrid& g, const std::array<int, 3>& k) {
    std::complex<double> sum;
    std::size_t i = 0;
    for (std::uint32_t z = 0; z < g.size[2]; ++z)
        for (std::uint32_t y = 0; y < g.size[1]; ++y)
            for (std::uint32_t x = 0; x < g.size[0]; ++x, ++i) {
                const double phase = static_cast<double>(k[0]) * x / g.size[0] +
                                     static_cast<double>(k[1]) * y / g.size[1] +
                                     static_cast<double>(k[2]) * z / g.size[2];
                sum += static_cast<double>(g.values[i]) * std::polar(1.0, -kTurn * phase);
            }
    return sum;
}

TEST(ShellCorrelation, is_the_sum_over_the_waves_of_each_shell) {
    DensityGrid a = box(10, 8, 6, 2.0), b = a;
    std::mt19937_64 random(1);
    std::normal_distribution<float> noise;
    for (std::size_t i = 0; i < a.values.size(); ++i) {
        const float both = noise(random);
        a.values[i] = 5.0F + both + 0.5F * noise(random);
        b.values[i] = 5.0F + both + 0.5F * noise(random);
    }
    const ShellCorrelation found = shell_correlation(a, b, nullptr);
    // Shells one wave of the longest side (10 voxels) wide, to half a wave per voxel: 1 to 5, the fifth not whole.
    ASSERT_EQ(found.shells.size(), 4U);
    std::vector<double> ab(5), aa(5), bb(5), waves(5);
    for (int z = -2; z <= 3; ++z)
        for (int y = -3; y <= 4; ++y)
            for (int x = -4; x <= 5; ++x) {
                const double length = 10.0 * std::hypot(x / 10.0, y / 8.0, z / 6.0);
                const auto shell = static_cast<std::size_t>(std::lround(length));
                if (shell < 1 || shell > 4) continue;
                const std::complex<double> p = wave_of(a, {x, y, z}), q = wave_of(b, {x, y, z});
                ab[shell] += (p * std::conj(q)).real();
                aa[shell] += std::norm(p);
                bb[shell] += std::norm(q);
                waves[shell] += 0.5;
            }
    for (std::size_t i = 1; i <= 4; ++i) {
        EXPECT_NEAR(found.shells[i - 1].correlation, ab[i] / std::sqrt(aa[i] * bb[i]), 1e-5) << i;
        EXPECT_NEAR(found.shells[i - 1].frequency_per_m, static_cast<double>(i) / (20.0 * kAngstromM), 1.0);
        EXPECT_EQ(found.shells[i - 1].waves, static_cast<std::size_t>(waves[i])) << i;
    }
    EXPECT_NEAR(found.finest_m, 4.0 * kAngstromM, 1e-15);
}

// Blobs of a Gaussian at random places have the power n exp(-4 pi^2 s^2 f^2) V^2, white noise N: FSC = signal / (signal + noise).
struct Halves {
    DensityGrid half_1, half_2;
    double crossing_m = 0.0;  // where the expected FSC is 0.143
};
Halves halves(double share_of_blobs) {
    constexpr std::uint32_t n = 64;
    constexpr double voxel_a = 1.5, sigma_voxels = 1.6, noise_sigma = 0.3;
    constexpr int blobs = 1500;
    Halves h{box(n, n, n, voxel_a), box(n, n, n, voxel_a), 0.0};
    std::mt19937_64 random(7);
    std::uniform_real_distribution<double> place(0.5 * n * (1.0 - share_of_blobs),
                                                 0.5 * n * (1.0 + share_of_blobs));
    std::vector<double> signal(h.half_1.values.size());
    for (int blob = 0; blob < blobs; ++blob) {
        const Vec3 p(place(random), place(random), place(random));
        for (int dz = -8; dz <= 8; ++dz)
            for (int dy = -8; dy <= 8; ++dy)
                for (int dx = -8; dx <= 8; ++dx) {
                    const int x = static_cast<int>(p.x()) + dx, y = static_cast<int>(p.y()) + dy,
                              z = static_cast<int>(p.z()) + dz;
                    const double square = (Vec3(x, y, z) - p).squaredNorm();
                    const auto wrap = [](int i) {
                        return static_cast<std::size_t>((i + 4 * static_cast<int>(n)) % static_cast<int>(n));
                    };
                    signal[(wrap(z) * n + wrap(y)) * n + wrap(x)] +=
                        std::exp(-0.5 * square / (sigma_voxels * sigma_voxels));
                }
    }
    std::normal_distribution<double> noise(0.0, noise_sigma);
    for (std::size_t i = 0; i < signal.size(); ++i) {
        h.half_1.values[i] = static_cast<float>(signal[i] + noise(random));
        h.half_2.values[i] = static_cast<float>(signal[i] + noise(random));
    }
    // Power of a wave: blobs (2 pi s^2)^3 exp(-4 pi^2 s^2 f^2), f in waves per voxel; of the noise: n^3 sigma^2.
    const double s2 = sigma_voxels * sigma_voxels;
    const double ratio =
        0.143 / (1.0 - 0.143) * (n * n * n * noise_sigma * noise_sigma) / (blobs * std::pow(kTurn * s2, 3.0));
    const double f = std::sqrt(-std::log(ratio) / (kTurn * kTurn * s2));
    h.crossing_m = voxel_a * kAngstromM / f;
    return h;
}

TEST(ShellCorrelation, gives_the_resolution_at_which_known_signal_and_noise_cross) {
    const Halves h = halves(1.0);
    const ShellCorrelation found = shell_correlation(h.half_1, h.half_2, nullptr);
    ASSERT_TRUE(found.resolution_m);
    EXPECT_NEAR(*found.resolution_m / h.crossing_m, 1.0, 0.04);
}

TEST(ShellCorrelation, half_maps_without_noise_are_finer_than_their_voxels_show) {
    const Halves h = halves(1.0);
    const ShellCorrelation found = shell_correlation(h.half_1, h.half_1, nullptr);
    EXPECT_FALSE(found.resolution_m);
    EXPECT_NEAR(found.finest_m, 3.0 * kAngstromM, 1e-15);
}

// A mask with rough edges makes even noise correlate: both halves have the same edges. What it adds is taken out.
TEST(ShellCorrelation, a_mask_adds_no_resolution) {
    Halves h = halves(0.5);
    DensityGrid mask = h.half_1;
    std::mt19937_64 random(3);
    std::vector<float> on(16 * 16 * 16);
    for (float& v : on) v = random() % 2 == 0 ? 1.0F : 0.0F;
    std::size_t i = 0;
    for (std::uint32_t z = 0; z < 64; ++z)
        for (std::uint32_t y = 0; y < 64; ++y)
            for (std::uint32_t x = 0; x < 64; ++x, ++i)
                mask.values[i] = on[(z / 4 * 16 + y / 4) * 16 + x / 4];
    const ShellCorrelation whole = shell_correlation(h.half_1, h.half_2, nullptr),
                           masked = shell_correlation(h.half_1, h.half_2, &mask);
    for (DensityGrid* const half : {&h.half_1, &h.half_2}) apply_mask(*half, mask, 0.0);
    const ShellCorrelation uncorrected = shell_correlation(h.half_1, h.half_2, nullptr);
    ASSERT_TRUE(whole.resolution_m);
    const auto mean_beyond = [&](const ShellCorrelation& c) {
        double sum = 0.0;
        int count = 0;
        for (const Shell& s : c.shells) {
            if (s.frequency_per_m < 1.3 / *whole.resolution_m) continue;
            sum += s.correlation;
            ++count;
        }
        EXPECT_GT(count, 3);
        return sum / count;
    };
    EXPECT_NEAR(mean_beyond(whole), 0.0, 0.05);
    EXPECT_GT(mean_beyond(uncorrected), 0.15) << "the mask would be taken for structure";
    EXPECT_NEAR(mean_beyond(masked), 0.0, 0.05);
}

TEST(ShellCorrelation, refuses_halves_that_do_not_belong_together) {
    DensityGrid a = box(8, 8, 8, 2.0), b = box(8, 8, 9, 2.0);
    a.values[3] = 1.0F;
    b.values[3] = 1.0F;
    EXPECT_NE(error_of([&] { (void)shell_correlation(a, b, nullptr); }).find("boxes or voxels differ"),
              std::string::npos);
    DensityGrid flat = box(8, 8, 8, 2.0);
    EXPECT_NE(error_of([&] { (void)shell_correlation(a, flat, nullptr); }).find("same value everywhere"),
              std::string::npos);
    DensityGrid moved = a;
    moved.spacing_m.z() *= 1.01;
    EXPECT_NE(error_of([&] { (void)shell_correlation(a, moved, nullptr); }).find("boxes or voxels differ"),
              std::string::npos);
}

TEST(Mask, is_interpolated_at_the_voxels_of_the_map_and_zero_outside) {
    const DensityGrid map = box(6, 6, 6, 3.0);  // from (-3, 5, 7) to (12, 20, 22) Å
    DensityGrid mask = box(4, 4, 4, 2.0);       // to (3, 11, 13) Å
    for (std::size_t i = 0; i < mask.values.size(); ++i)
        mask.values[i] = static_cast<float>(i % 4) / 3.0F;  // rises along x
    const DensityGrid on = mask_on(map, mask, "m");
    EXPECT_NEAR(on.at(0, 0, 0), 0.0F, 1e-6F);
    EXPECT_NEAR(on.at(1, 1, 1), 0.5F, 1e-6F);  // 3 Å along x: between 1/3 and 2/3
    EXPECT_NEAR(on.at(2, 2, 2), 1.0F, 1e-6F);
    EXPECT_EQ(on.at(3, 1, 1), 0.0F);
    EXPECT_EQ(on.at(1, 3, 1), 0.0F);
}

TEST(Mask, moves_the_density_outside_to_the_background) {
    DensityGrid map = box(4, 4, 4, 2.0), mask = map;
    for (std::size_t i = 0; i < map.values.size(); ++i) {
        map.values[i] = static_cast<float>(i);
        mask.values[i] = i < 16 ? 1.0F : i < 32 ? 0.5F : 0.0F;
    }
    apply_mask(map, mask, 10.0);
    EXPECT_EQ(map.values[3], 3.0F);
    EXPECT_EQ(map.values[20], 15.0F);
    EXPECT_EQ(map.values[60], 10.0F);
    EXPECT_DOUBLE_EQ(share_inside(mask), 0.25);
}

TEST(Mask, what_is_no_mask_is_refused) {
    const DensityGrid map = box(4, 4, 4, 2.0);
    DensityGrid mask = map;
    EXPECT_NE(error_of([&] { (void)mask_on(map, mask, "m.mrc"); }).find("nothing of the map"),
              std::string::npos);
    for (float& v : mask.values) v = 1.0F;
    EXPECT_NE(error_of([&] { (void)mask_on(map, mask, "m.mrc"); }).find("all of the map"), std::string::npos);
    mask.values[5] = 255.0F;
    const std::string error = error_of([&] { (void)mask_on(map, mask, "m.mrc"); });
    EXPECT_NE(error.find("m.mrc"), std::string::npos);
    EXPECT_NE(error.find("from 1 to 255"), std::string::npos) << error;
}

class ReadMapFiles : public testing::Test {
protected:
    void SetUp() override {
        char name[] = "/tmp/tact-read-map-XXXXXX";
        folder_ = mkdtemp(name);
    }
    void TearDown() override { std::filesystem::remove_all(folder_); }
    std::string write(const char* name, const DensityGrid& grid) {
        const std::string bytes = map_file_bytes(grid);
        const std::string path = folder_ / name;
        std::ofstream(path, std::ios::binary).write(bytes.data(), static_cast<std::streamsize>(bytes.size()));
        return path;
    }
    std::filesystem::path folder_;
};

TEST_F(ReadMapFiles, the_resolution_is_that_of_the_half_maps_unless_one_is_given) {
    const Halves h = halves(1.0);
    DensityGrid sum = h.half_1;
    for (std::size_t i = 0; i < sum.values.size(); ++i) sum.values[i] += h.half_2.values[i];
    MapRequest request;
    request.path = write("map.mrc", sum);
    request.half_maps = {write("1.mrc", h.half_1), write("2.mrc", h.half_2)};
    const ReadMap measured = read_map(request);
    EXPECT_NEAR(measured.resolution_m / h.crossing_m, 1.0, 0.04);
    const auto said = [](const ReadMap& map, const char* words) {
        return std::any_of(map.note.begin(), map.note.end(),
                           [&](const std::string& line) { return line.find(words) != std::string::npos; });
    };
    EXPECT_EQ(measured.resolution_source, "of the half-maps");
    request.resolution_a = 9.0;
    const ReadMap given = read_map(request);
    EXPECT_NEAR(given.resolution_m, 9.0 * kAngstromM, 1e-18);
    EXPECT_TRUE(said(given, "Fourier shell correlation of 0.143 at"))
        << "measured all the same, for the note";
    EXPECT_EQ(given.grid.values, sum.values);
}

TEST_F(ReadMapFiles, a_mask_acts_on_the_map_and_an_unknown_resolution_is_refused) {
    DensityGrid map = box(8, 8, 8, 2.0), mask = map;
    for (std::size_t i = 0; i < map.values.size(); ++i) map.values[i] = static_cast<float>(i % 8);
    for (std::size_t i = 0; i < 256; ++i) mask.values[i] = 1.0F;
    MapRequest request;
    request.path = write("map.mrc", map);
    request.mask = write("mask.mrc", mask);
    const std::string error = error_of([&] { (void)read_map(request); });
    EXPECT_NE(error.find("resolution is unknown"), std::string::npos) << error;
    EXPECT_NE(error.find("between 4.0 and 10.0"), std::string::npos) << error;
    request.resolution_a = 8.0;
    const ReadMap masked = read_map(request);
    const auto background = static_cast<float>(map_statistics(map).background);
    EXPECT_EQ(masked.grid.values[7], 7.0F);
    EXPECT_EQ(masked.grid.values[511], background);
    request.half_maps = {request.path};
    EXPECT_NE(error_of([&] { (void)read_map(request); }).find("1 given"), std::string::npos);
    request.half_maps = {write("a.mrc", halves(1.0).half_1), request.path};
    EXPECT_NE(error_of([&] { (void)read_map(request); }).find("not those of the map"), std::string::npos);
}

}  // namespace
}  // namespace tact::prep_read_map_test
