// Input files written byte by byte for importer tests, and the folder of real data.
#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <string>
#include <vector>

#include "tests/support/error_of.hpp"

namespace tact::sample {

// Returns an empty path without the data folder.
inline std::filesystem::path em_folder() {
    const char* const shared = std::getenv("TACT_SHARED");
    const std::filesystem::path folder =
        std::filesystem::path(shared != nullptr ? shared : "../shared") / "data" / "em";
    return std::filesystem::is_directory(folder) ? folder : std::filesystem::path();
}

// IEEE 754 binary16 of a number that it holds exactly.
inline std::uint16_t half_of(float value) {
    if (value == 0.0F) return 0;
    int exponent = 0;
    const float part = std::frexp(std::abs(value), &exponent);  // 0.5 to 1
    const auto sign = value < 0.0F ? 0x8000U : 0U;
    return static_cast<std::uint16_t>(sign | static_cast<unsigned>(exponent + 14) << 10 |
                                      static_cast<unsigned>((2.0F * part - 1.0F) * 1024.0F));
}

// An MRC file with voxel value value(x, y, z), indexed along the model axes.
struct Mrc {
    std::array<int, 3> size{6, 5, 4};       // x, y, z
    std::array<int, 3> axes{1, 2, 3};       // MAPC, MAPR, MAPS
    std::array<int, 3> start{0, 0, 0};      // x, y, z
    std::array<int, 3> intervals{6, 5, 4};  // x, y, z
    std::array<float, 3> cell{12.0F, 15.0F, 16.0F};
    std::array<float, 3> angles{90.0F, 90.0F, 90.0F};
    std::array<float, 3> origin{0.0F, 0.0F, 0.0F};
    int mode = 2;
    int extended = 0;  // size of the extended header (bytes)
    bool big_endian = false;
    std::uint32_t stamp = 0;
    const char* magic = "MAP ";

    static int value(int x, int y, int z) { return x + 10 * y + 30 * z - 40; }

    [[nodiscard]] std::vector<char> bytes() const {
        std::vector<char> out(1024 + static_cast<std::size_t>(extended), 'S');
        std::fill_n(out.begin(), 1024, '\0');
        const auto word = [&](int w, std::uint32_t v) {
            if (big_endian) v = __builtin_bswap32(v);
            std::memcpy(out.data() + 4 * (w - 1), &v, 4);
        };
        const auto put = [&](int w, float v) { word(w, std::bit_cast<std::uint32_t>(v)); };
        for (int a = 0; a < 3; ++a) {
            const auto along = static_cast<std::size_t>(axes[static_cast<std::size_t>(a)] - 1);
            const auto i = static_cast<std::size_t>(a);
            word(1 + a, static_cast<std::uint32_t>(size[along]));
            word(5 + a, static_cast<std::uint32_t>(start[along]));
            word(8 + a, static_cast<std::uint32_t>(intervals[i]));
            put(11 + a, cell[i]);
            put(14 + a, angles[i]);
            word(17 + a, static_cast<std::uint32_t>(axes[i]));
            put(50 + a, origin[i]);
        }
        word(4, static_cast<std::uint32_t>(mode));
        word(23, 1);
        word(24, static_cast<std::uint32_t>(extended));
        std::memcpy(out.data() + 208, magic, 4);
        std::memcpy(out.data() + 212, &stamp, 4);
        const auto add = [&](auto v) {
            char raw[sizeof v];
            std::memcpy(raw, &v, sizeof v);
            if (big_endian) std::reverse(raw, raw + sizeof v);
            out.insert(out.end(), raw, raw + sizeof v);
        };
        std::array<int, 3> i{};  // x, y, z
        const auto c = static_cast<std::size_t>(axes[0] - 1), r = static_cast<std::size_t>(axes[1] - 1),
                   s = static_cast<std::size_t>(axes[2] - 1);
        for (i[s] = 0; i[s] < size[s]; ++i[s]) {
            for (i[r] = 0; i[r] < size[r]; ++i[r]) {
                for (i[c] = 0; i[c] < size[c]; ++i[c]) {
                    const int v = value(i[0], i[1], i[2]);
                    if (mode == 0) add(static_cast<std::int8_t>(v));
                    if (mode == 1) add(static_cast<std::int16_t>(v * 100));
                    if (mode == 2) add(static_cast<float>(v) * 0.25F);
                    if (mode == 6) add(static_cast<std::uint16_t>(v + 40000));
                    if (mode == 12) add(half_of(static_cast<float>(v) * 0.25F));
                }
            }
        }
        return out;
    }
    [[nodiscard]] float stored(int x, int y, int z) const {
        const int v = value(x, y, z);
        if (mode == 1) return static_cast<float>(v * 100);
        if (mode == 2 || mode == 12) return static_cast<float>(v) * 0.25F;
        if (mode == 6) return static_cast<float>(v + 40000);
        return static_cast<float>(v);
    }
};

// One atom line of a PDB file.
inline std::string pdb_atom(const char* name, const char* residue, char chain, int sequence, double x,
                            double y, double z, double occupancy = 1.0, char alternate = ' ',
                            const char* element = "  ", const char* record = "ATOM  ") {
    char line[96];
    std::snprintf(line, sizeof line, "%-6s%5d %-4s%c%3s %c%4d    %8.3f%8.3f%8.3f%6.2f%6.2f          %2s\n",
                  record, 1, name, alternate, residue, chain, sequence, x, y, z, occupancy, 10.0, element);
    return line;
}

}  // namespace tact::sample
