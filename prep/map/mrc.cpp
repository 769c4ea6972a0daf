// MRC2014 / CCP4 maps.
//
// Division of work. gemmi converts the modes and puts the axes into the order x, y, z. Before it sees the
// file, everything its header says is checked here, because gemmi believes the machine stamp (real files
// have 0 there), cannot swap 16-bit data and takes memory for whatever size is declared.
//
// Byte order. The stamp (word 54) is not looked at. Of both orders, the one is taken in which sizes, mode and
// axis words make sense.
//
// Place of voxel (0,0,0). Where ORIGIN (words 50-52) is not zero it is right; else NSTART (words 5-7) x
// voxel. Among the maps that this was checked on with structures, some have an NSTART that contradicts a
// right ORIGIN, none the other way round. Voxel = cell / M (words 8-10), not cell / N.
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

// Words count from 1, as in the format's description.
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
            return 2;
        case 3:
        case 4:
            reader.fail("word 4: mode " + std::to_string(mode) + " is a Fourier transform, not a density",
                        "transform it to a density first");
        case 12:
            reader.fail("word 4: mode 12 (16-bit floats) is not read",
                        "convert it to mode 2, for example with e2proc3d.py or relion_image_handler");
        default:
            break;
    }
    reader.fail("word 4: mode " + std::to_string(mode) + " is not read; modes 0, 1, 2 and 6 are",
                "convert it to mode 2");
}

// Sizes, cell and bytes agree with each other and with the file.
void check_header(const Reader& reader, const Header& h, std::size_t file_bytes) {
    std::uint64_t voxels = 1;
    for (int w = 1; w <= 3; ++w) {
        if (h.i(w) < 4 || h.i(w) > kSizeMax) {
            reader.fail("word " + std::to_string(w) + ": " + std::to_string(h.i(w)) +
                            " voxels along an axis, outside of 4 to " + std::to_string(kSizeMax),
                        "give a three-dimensional map");
        }
        voxels *= static_cast<std::uint64_t>(h.i(w));
    }
    if (voxels > kMapVoxelsMax) {
        reader.fail("words 1-3: " + std::to_string(h.i(1)) + " x " + std::to_string(h.i(2)) + " x " +
                        std::to_string(h.i(3)) + " voxels are more than " + std::to_string(kMapVoxelsMax),
                    "crop it, or bin it to larger voxels");
    }
    if (h.i(24) < 0 || h.i(24) > kExtendedMax) {
        reader.fail("word 24: an extended header of " + std::to_string(h.i(24)) + " bytes",
                    "repair its header");
    }
    const std::uint64_t expected =
        kHeaderBytes + static_cast<std::uint64_t>(h.i(24)) + voxels * bytes_of_mode(reader, h.i(4));
    if (file_bytes != expected) {
        reader.fail("its header declares " + std::to_string(h.i(1)) + " x " + std::to_string(h.i(2)) + " x " +
                        std::to_string(h.i(3)) + " voxels of mode " + std::to_string(h.i(4)) +
                        ", which with the headers is " + std::to_string(expected) + " bytes, but it has " +
                        std::to_string(file_bytes) +
                        (file_bytes < expected ? " (truncated)" : " (oversized)"),
                    "fetch the file again, or repair its header");
    }
    for (int w = 11; w <= 13; ++w) {
        if (!(h.f(w) > 0.0 && h.f(w) < 1e6)) {
            reader.fail(
                "word " + std::to_string(w) + ": a cell edge of " + std::to_string(h.f(w)) + " ångström",
                "set the cell in its header (voxel size x M)");
        }
    }
    for (int w = 8; w <= 10; ++w) {
        if (h.i(w) < 0 || h.i(w) > 1'000'000)
            reader.fail(
                "word " + std::to_string(w) + ": " + std::to_string(h.i(w)) + " intervals along the cell",
                "repair its header");
    }
    for (int w = 5; w <= 7; ++w) {
        if (std::abs(static_cast<std::int64_t>(h.i(w))) > 10'000'000) {
            reader.fail("word " + std::to_string(w) + ": a start at voxel " + std::to_string(h.i(w)),
                        "repair its header");
        }
    }
    for (int w = 50; w <= 52; ++w) {
        if (!std::isfinite(h.f(w)))
            reader.fail("word " + std::to_string(w) + ": the origin is not a number",
                        "set ORIGIN in its header");
    }
    bool no_angles = true;
    for (int w = 14; w <= 16; ++w) no_angles = no_angles && h.f(w) == 0.0;
    for (int w = 14; w <= 16; ++w) {
        if (!no_angles && !(h.f(w) >= 30.0 && h.f(w) <= 150.0)) {
            reader.fail(
                "word " + std::to_string(w) + ": a cell angle of " + std::to_string(h.f(w)) + " degrees",
                "set the angles to 90 in its header");
        }
    }
}

void swap_data(char* data, std::size_t bytes, std::size_t each) {
    for (std::size_t i = 0; i + each <= bytes; i += each) std::reverse(data + i, data + i + each);
}

}  // namespace

ImportedMap read_mrc(std::vector<char> bytes, const std::string& name) {
    const Reader reader{name};
    if (bytes.size() < kHeaderBytes) {
        reader.fail("it has " + std::to_string(bytes.size()) +
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
        reader.fail("its header makes sense in neither byte order: as little endian " + say(little) +
                        "; as big endian " + say(big),
                    "check that it is an MRC or CCP4 map and fetch it again");
    }
    Header h = swap ? big : little;
    check_header(reader, h, bytes.size());

    ImportedMap map;
    map.format = "MRC/CCP4 mode " + std::to_string(h.i(4)) + (swap ? ", big endian" : ", little endian");
    if (h.i(17) == 0) {
        map.notes.push_back("axis words 17-19 are zero: taken as x, y, z");
        for (int a = 0; a < 3; ++a) h.set(17 + a, a + 1);
    }
    int position[3];  // of x, y, z among columns, rows, sections
    for (int a = 0; a < 3; ++a) position[h.i(17 + a) - 1] = a;
    Vec3 voxel_m, nstart;
    for (int a = 0; a < 3; ++a) {
        std::int32_t intervals = h.i(8 + a);
        if (intervals == 0) {
            intervals = h.i(1 + position[a]);
            map.notes.push_back("word " + std::to_string(8 + a) +
                                " (intervals along the cell) is zero: taken as the voxels along that axis");
        }
        voxel_m[a] = h.f(11 + a) / intervals * kAngstromM;
        nstart[a] = h.i(5 + position[a]);
        h.set(8 + a, intervals);
    }
    if (!(voxel_m.minCoeff() > 1e-13))
        reader.fail("words 8-13: a voxel is below a thousandth of an ångström", "set the cell in its header");

    // gemmi gets a plain file: this machine's byte order, no extended header, no symmetry.
    const std::size_t each = bytes_of_mode(reader, h.i(4));
    bytes.erase(bytes.begin() + kHeaderBytes,
                bytes.begin() + static_cast<std::ptrdiff_t>(kHeaderBytes) + h.i(24));
    if (swap) swap_data(bytes.data() + kHeaderBytes, bytes.size() - kHeaderBytes, each);
    const Vec3 origin_words(h.f(50), h.f(51), h.f(52));
    Header plain = h;
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
        reader.fail(error.what(), "check that it is an MRC or CCP4 map and fetch it again");
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
            reader.fail("words 14-16: the cell angles make no cell", "set the angles to 90 in its header");
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
