// MRC2014 / CCP4 maps.
//
// Division of work. gemmi converts the modes and orders the axes as x, y, z. The header is checked here first, because
// gemmi trusts the machine stamp (0 in real files), cannot swap 16-bit data and allocates whatever size is declared.
//
// Byte order. The stamp (word 54) is ignored. The byte order is the one in which sizes, mode and axis words are valid.
//
// Position of voxel (0,0,0). ORIGIN (words 50-52) if it is not zero, else NSTART (words 5-7) x voxel. Of the maps that
// were checked against structures, some have an NSTART that contradicts a correct ORIGIN, none the other way round.
// Voxel = cell / M (words 8-10), not cell / N.
#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>
#include <gemmi/ccp4.hpp>
#include <gemmi/unitcell.hpp>
#include <optional>

#include "ipc/base/error.hpp"
#include "ipc/base/units.hpp"
#include "prep/map/formats.hpp"

namespace tact::map_format {
namespace {

constexpr std::size_t kHeaderBytes = 1024;
constexpr std::int32_t kSizeMax = 16384;
constexpr std::int32_t kExtendedMax = 1 << 28;
constexpr std::int32_t kHalfMode = 12;  // 16-bit floats (IEEE 754 binary16)

// Words count from 1, as in the format description.
struct Header {
    std::int32_t word[256];
    [[nodiscard]] std::int32_t i(int w) const { return word[w - 1]; }
    [[nodiscard]] double f(int w) const { return static_cast<double>(std::bit_cast<float>(word[w - 1])); }
    void set(int w, std::int32_t value) { word[w - 1] = value; }
};
static_assert(sizeof(Header) == kHeaderBytes);

Header swapped(const Header& header) {
    Header out = header;
    for (std::int32_t& w : out.word)
        w = static_cast<std::int32_t>(__builtin_bswap32(static_cast<std::uint32_t>(w)));
    return out;
}

bool axes_make_sense(const Header& h) {
    std::array<std::int32_t, 3> axes{h.i(17), h.i(18), h.i(19)};
    std::sort(axes.begin(), axes.end());
    return axes == std::array<std::int32_t, 3>{1, 2, 3} || axes == std::array<std::int32_t, 3>{0, 0, 0};
}

bool makes_sense(const Header& h) {
    for (int w = 1; w <= 3; ++w) {
        if (h.i(w) < 1 || h.i(w) > 65535) return false;
    }
    return h.i(4) >= 0 && h.i(4) <= 127 && axes_make_sense(h);
}

struct Reader {
    const std::string& name;
    [[noreturn]] void fail(const std::string& why, const std::string& fix) const {
        throw StartupError("read map " + name, why, fix);
    }
};

std::string triple(double a, double b, double c) {
    char text[96];
    std::snprintf(text, sizeof text, "(%.6g, %.6g, %.6g)", a, b, c);
    return text;
}

std::size_t bytes_of_mode(const Reader& reader, std::int32_t mode) {
    switch (mode) {
        case 0:
            return 1;
        case 1:
            return 2;
        case 2:
            return 4;
        case 6:
        case kHalfMode:
            return 2;
        case 3:
        case 4:
            reader.fail("word 4: mode " + std::to_string(mode) + " is a Fourier transform, not a density",
                        "convert the file to a density map of mode 2");
        default:
            break;
    }
    reader.fail("word 4: mode " + std::to_string(mode) + " is not supported; modes 0, 1, 2, 6 and 12 are",
                "convert the map to mode 2");
}

// Checks that sizes, cell and number of bytes agree.
void check_header(const Reader& reader, const Header& h, std::size_t file_bytes) {
    std::uint64_t voxels = 1;
    for (int w = 1; w <= 3; ++w) {
        if (h.i(w) < 4 || h.i(w) > kSizeMax) {
            reader.fail("word " + std::to_string(w) + ": the map has " + std::to_string(h.i(w)) +
                            " voxels along an axis, outside 4 to " + std::to_string(kSizeMax),
                        "give a three-dimensional map of 4 to " + std::to_string(kSizeMax) +
                            " voxels along each axis");
        }
        voxels *= static_cast<std::uint64_t>(h.i(w));
    }
    if (voxels > kMapVoxelsMax) {
        reader.fail("words 1-3: " + std::to_string(h.i(1)) + " x " + std::to_string(h.i(2)) + " x " +
                        std::to_string(h.i(3)) + " voxels are more than " + std::to_string(kMapVoxelsMax),
                    "crop the map, or bin it to larger voxels");
    }
    if (h.i(24) < 0 || h.i(24) > kExtendedMax) {
        reader.fail("word 24: the extended header has " + std::to_string(h.i(24)) + " bytes, outside 0 to " +
                        std::to_string(kExtendedMax),
                    "fetch the file again, or correct word 24 of the header");
    }
    const std::uint64_t expected =
        kHeaderBytes + static_cast<std::uint64_t>(h.i(24)) + voxels * bytes_of_mode(reader, h.i(4));
    if (file_bytes != expected) {
        reader.fail("the header declares " + std::to_string(h.i(1)) + " x " + std::to_string(h.i(2)) + " x " +
                        std::to_string(h.i(3)) + " voxels of mode " + std::to_string(h.i(4)) + ", together " +
                        std::to_string(expected) + " bytes with the headers, but the file has " +
                        std::to_string(file_bytes) +
                        (file_bytes < expected ? " (truncated)" : " (oversized)"),
                    "fetch the file again, or repair the header");
    }
    for (int w = 11; w <= 13; ++w) {
        if (!(h.f(w) > 0.0 && h.f(w) < 1e6)) {
            reader.fail("word " + std::to_string(w) + ": the cell edge is " + std::to_string(h.f(w)) +
                            " ångström, outside 0 to 1000000",
                        "set the cell in the header (voxel size x M)");
        }
    }
    for (int w = 8; w <= 10; ++w) {
        if (h.i(w) < 0 || h.i(w) > 1'000'000)
            reader.fail("word " + std::to_string(w) + ": the cell has " + std::to_string(h.i(w)) +
                            " intervals along an edge, outside 0 to 1000000",
                        "set MX, MY and MZ in the header to the numbers of voxels of the cell");
    }
    for (int w = 5; w <= 7; ++w) {
        if (std::abs(static_cast<std::int64_t>(h.i(w))) > 10'000'000) {
            reader.fail("word " + std::to_string(w) + ": the map starts at voxel " + std::to_string(h.i(w)) +
                            ", beyond 10000000",
                        "correct NXSTART, NYSTART and NZSTART in the header");
        }
    }
    for (int w = 50; w <= 52; ++w) {
        if (!std::isfinite(h.f(w)))
            reader.fail("word " + std::to_string(w) + ": the origin is not a finite number",
                        "set ORIGIN in the header");
    }
    bool no_angles = true;
    for (int w = 14; w <= 16; ++w) no_angles = no_angles && h.f(w) == 0.0;
    for (int w = 14; w <= 16; ++w) {
        if (!no_angles && !(h.f(w) >= 30.0 && h.f(w) <= 150.0)) {
            reader.fail("word " + std::to_string(w) + ": the cell angle is " + std::to_string(h.f(w)) +
                            " degrees, outside 30 to 150",
                        "set the cell angles in the header to 90");
        }
    }
}

void swap_data(char* data, std::size_t bytes, std::size_t each) {
    for (std::size_t i = 0; i + each <= bytes; i += each) std::reverse(data + i, data + i + each);
}

// The values of a file of mode 12 as those of mode 2, which gemmi reads.
void widen_halves(std::vector<char>& bytes) {
    const std::size_t count = (bytes.size() - kHeaderBytes) / 2;
    std::vector<char> wide(kHeaderBytes + 4 * count);
    for (std::size_t i = 0; i < count; ++i) {
        std::uint16_t half = 0;
        std::memcpy(&half, bytes.data() + kHeaderBytes + 2 * i, 2);
        const auto value = static_cast<float>(Eigen::numext::bit_cast<Eigen::half>(half));
        std::memcpy(wide.data() + kHeaderBytes + 4 * i, &value, 4);
    }
    bytes = std::move(wide);
}

}  // namespace

ImportedMap read_mrc(std::vector<char> bytes, const std::string& name) {
    const Reader reader{name};
    if (bytes.size() < kHeaderBytes) {
        reader.fail("the file has " + std::to_string(bytes.size()) +
                        " bytes, fewer than the header of an MRC or CCP4 map (1024)",
                    "fetch the file again");
    }
    Header little;
    std::memcpy(&little, bytes.data(), sizeof little);
    const Header big = swapped(little);
    const bool swap = !makes_sense(little);
    if (swap && !makes_sense(big)) {
        const auto say = [](const Header& h) {
            return "sizes " + std::to_string(h.i(1)) + ", " + std::to_string(h.i(2)) + ", " +
                   std::to_string(h.i(3)) + ", mode " + std::to_string(h.i(4)) + ", axes " +
                   std::to_string(h.i(17)) + ", " + std::to_string(h.i(18)) + ", " + std::to_string(h.i(19));
        };
        reader.fail("the header is invalid in both byte orders: as little endian " + say(little) +
                        "; as big endian " + say(big),
                    "check that the file is an MRC or CCP4 map, and fetch it again");
    }
    Header h = swap ? big : little;
    check_header(reader, h, bytes.size());

    ImportedMap map;
    map.format = "MRC/CCP4 mode " + std::to_string(h.i(4)) + (swap ? ", big endian" : ", little endian");
    if (h.i(17) == 0) {
        map.notes.push_back("axis words 17-19 are zero; the axes are assumed to be x, y, z");
        for (int a = 0; a < 3; ++a) h.set(17 + a, a + 1);
    }
    int position[3];  // of x, y, z among columns, rows, sections
    for (int a = 0; a < 3; ++a) position[h.i(17 + a) - 1] = a;
    Vec3 voxel_m, nstart;
    for (int a = 0; a < 3; ++a) {
        std::int32_t intervals = h.i(8 + a);
        if (intervals == 0) {
            intervals = h.i(1 + position[a]);
            map.notes.push_back(
                "word " + std::to_string(8 + a) +
                " (intervals along the cell) is zero; the number of voxels along that axis is used");
        }
        voxel_m[a] = h.f(11 + a) / intervals * kAngstromM;
        nstart[a] = h.i(5 + position[a]);
        h.set(8 + a, intervals);
    }
    if (!(voxel_m.minCoeff() > 1e-13))
        reader.fail("words 8-13: the voxel size is below 0.001 ångström", "set the cell in the header");

    // Pass gemmi a plain file: the machine's byte order, no extended header, no symmetry.
    const std::size_t each = bytes_of_mode(reader, h.i(4));
    bytes.erase(bytes.begin() + kHeaderBytes,
                bytes.begin() + static_cast<std::ptrdiff_t>(kHeaderBytes) + h.i(24));
    if (swap) swap_data(bytes.data() + kHeaderBytes, bytes.size() - kHeaderBytes, each);
    if (h.i(4) == kHalfMode) widen_halves(bytes);
    const Vec3 origin_words(h.f(50), h.f(51), h.f(52));
    Header plain = h;
    if (h.i(4) == kHalfMode) plain.set(4, 2);
    plain.set(23, 1);
    plain.set(24, 0);
    std::memcpy(plain.word + 52, "MAP ", 4);
    plain.set(54, 0x00004144);
    std::memcpy(bytes.data(), &plain, sizeof plain);
    gemmi::Ccp4<float> file;
    try {
        file.read_ccp4_from_memory(bytes.data(), bytes.size(), name);
        bytes = {};
        file.setup(0.0F, gemmi::MapSetup::ReorderOnly);
    } catch (const std::runtime_error& error) {
        reader.fail(error.what(), "check that the file is an MRC or CCP4 map, and fetch it again");
    }
    const std::array<std::uint32_t, 3> size{static_cast<std::uint32_t>(file.grid.nu),
                                            static_cast<std::uint32_t>(file.grid.nv),
                                            static_cast<std::uint32_t>(file.grid.nw)};

    bool skew = false;
    for (int w = 14; w <= 16; ++w) skew = skew || (h.f(w) != 0.0 && std::abs(h.f(w) - 90.0) > 0.01);
    Eigen::Matrix3d step_m = voxel_m.asDiagonal();
    if (skew) {
        const gemmi::UnitCell cell(h.f(11), h.f(12), h.f(13), h.f(14), h.f(15), h.f(16));
        for (int c = 0; c < 3; ++c) {
            gemmi::Fractional unit(0, 0, 0);
            unit.at(c) = 1.0 / h.i(8 + c);
            const gemmi::Position step = cell.orthogonalize(unit);
            step_m.col(c) = kAngstromM * Vec3(step.x, step.y, step.z);
        }
        if (!step_m.allFinite() || !(step_m.determinant() > 0.05 * voxel_m.prod())) {
            reader.fail("words 14-16: no cell has these angles", "set the cell angles in the header to 90");
        }
    }
    Vec3 origin_m;
    if (!origin_words.isZero(0.0)) {
        origin_m = kAngstromM * origin_words;
        map.origin_rule = "ORIGIN words 50-52 " +
                          triple(origin_words.x(), origin_words.y(), origin_words.z()) +
                          " A, which are not zero";
        const Vec3 other_m = step_m * nstart;
        if ((other_m - origin_m).norm() > 0.5 * voxel_m.minCoeff() && !nstart.isZero(0.0)) {
            map.origin_rule +=
                "; NSTART " + triple(nstart.x(), nstart.y(), nstart.z()) + " x voxel differs and is ignored";
        }
    } else {
        origin_m = step_m * nstart;
        map.origin_rule = "NSTART words 5-7 " + triple(nstart.x(), nstart.y(), nstart.z()) +
                          " x voxel, because ORIGIN words 50-52 are zero";
    }
    if (skew) {
        map.notes.push_back("the cell has angles " + triple(h.f(14), h.f(15), h.f(16)) +
                            " degrees: resampled trilinearly onto axes at right angles");
        map.grid = resample({size, origin_m, step_m, std::move(file.grid.data)}, name);
    } else {
        map.grid = {size, origin_m, voxel_m, std::move(file.grid.data)};
    }
    return map;
}

}  // namespace tact::map_format
