#include "ipc/scene/density/structure.hpp"

#include <cmath>

#include "ipc/scene/file/bytes.hpp"

namespace tact {
namespace {

constexpr SectionTag kBodyTag{'B', 'O', 'D', 'Y'};
constexpr SectionTag kCodeTag{'C', 'O', 'D', 'E'};
constexpr std::uint32_t kBodyVersion = 1;
constexpr std::uint32_t kCodeVersion = 1;
constexpr double kCoordinateMax_m = 1e-5;  // a structure is smaller than ten micrometres
constexpr double kSumTolerance = 1e-3;     // single-precision weights of a million atoms sum to 1 within 1e-4
constexpr std::uint8_t kElementMax = 118;
constexpr std::uint32_t kChainsMax = 65535;
constexpr std::uint32_t kLevelsMax = 256;

struct BodyHeader {
    std::uint32_t atoms, chains;
    double home_com_model_m[3];
    double mass_u;
};
static_assert(sizeof(BodyHeader) == 40);

struct LevelHeader {
    std::uint32_t points, edges;
    double rms_error_m;
};
static_assert(sizeof(LevelHeader) == 16);

std::string where(const SceneFile& file, const char* tag, std::uint32_t index) {
    return file.name() + ", section " + tag + " " + std::to_string(index);
}

void check_weights(const BytesIn& in, const std::vector<float>& weights, const std::string& what) {
    double sum = 0.0;
    for (const float w : weights) {
        if (!(w >= 0.0F)) in.fail("a weight of " + what + " is " + std::to_string(w));
        sum += static_cast<double>(w);
    }
    if (!(std::abs(sum - 1.0) <= kSumTolerance)) {
        in.fail("the weights of " + what + " sum to " + std::to_string(sum) + " instead of 1");
    }
}

}  // namespace

double radius_of_gyration_m(const Structure& s) {
    double sum_m2 = 0.0;
    for (std::size_t i = 0; i < s.size(); ++i)
        sum_m2 += static_cast<double>(s.mass_fraction[i]) *
                  Eigen::Vector3f(s.x_m[i], s.y_m[i], s.z_m[i]).cast<double>().squaredNorm();
    return std::sqrt(sum_m2);
}

void write_structure(SceneWriter& out, std::uint32_t index, const Structure& structure) {
    BodyHeader header{};
    header.atoms = static_cast<std::uint32_t>(structure.size());
    header.chains = static_cast<std::uint32_t>(structure.chain_names.size());
    for (int a = 0; a < 3; ++a) header.home_com_model_m[a] = structure.home_com_model_m[a];
    header.mass_u = structure.mass_u;
    BytesOut bytes;
    bytes.put(header);
    bytes.put_text(structure.name);
    for (const std::string& name : structure.chain_names) bytes.put_text(name);
    bytes.put_all(structure.x_m);
    bytes.put_all(structure.y_m);
    bytes.put_all(structure.z_m);
    bytes.put_all(structure.mass_fraction);
    bytes.put_all(structure.residue);
    bytes.put_all(structure.chain);
    bytes.put_all(structure.element);
    bytes.put_all(structure.trace);
    out.add(kBodyTag, kBodyVersion, index, bytes.take());
}

Structure read_structure(const SceneFile& file, std::uint32_t index) {
    BytesIn in(file.section(kBodyTag, kBodyVersion, index), where(file, "BODY", index));
    const auto header = in.get<BodyHeader>("header");
    if (header.atoms == 0) in.fail("it has no atoms");
    if (header.chains == 0 || header.chains > kChainsMax) {
        in.fail("it has " + std::to_string(header.chains) + " chains; 1 to 65535 are allowed");
    }
    Structure s;
    for (int a = 0; a < 3; ++a) {
        s.home_com_model_m[a] = header.home_com_model_m[a];
        if (!(std::abs(s.home_com_model_m[a]) <= 1e-3)) {
            in.fail("its home is at " + std::to_string(s.home_com_model_m[a]) + " m");
        }
    }
    s.mass_u = header.mass_u;
    if (!(s.mass_u > 0.0 && s.mass_u < 1e15)) in.fail("its mass is " + std::to_string(s.mass_u) + " u");
    s.name = in.get_text(4096, "name");
    for (std::uint32_t c = 0; c < header.chains; ++c) s.chain_names.push_back(in.get_text(64, "chain name"));
    s.x_m = in.get_all<float>(header.atoms, "x");
    s.y_m = in.get_all<float>(header.atoms, "y");
    s.z_m = in.get_all<float>(header.atoms, "z");
    s.mass_fraction = in.get_all<float>(header.atoms, "mass fraction");
    s.residue = in.get_all<std::int32_t>(header.atoms, "residue");
    s.chain = in.get_all<std::uint16_t>(header.atoms, "chain");
    s.element = in.get_all<std::uint8_t>(header.atoms, "element");
    s.trace = in.get_all<std::uint8_t>(header.atoms, "trace");
    in.finish();
    in.check_finite(s.x_m, kCoordinateMax_m, "x of atom");
    in.check_finite(s.y_m, kCoordinateMax_m, "y of atom");
    in.check_finite(s.z_m, kCoordinateMax_m, "z of atom");
    check_weights(in, s.mass_fraction, "its atoms");
    for (std::size_t i = 0; i < s.size(); ++i) {
        if (s.chain[i] >= header.chains)
            in.fail("atom " + std::to_string(i) + " is in chain " + std::to_string(s.chain[i]) + " of " +
                    std::to_string(header.chains));
        if (s.element[i] > kElementMax)
            in.fail("atom " + std::to_string(i) + " is of element " + std::to_string(s.element[i]));
        if (s.trace[i] > 1) in.fail("the trace mark of atom " + std::to_string(i) + " is neither 0 nor 1");
    }
    return s;
}

void write_codebook(SceneWriter& out, std::uint32_t index, const Codebook& codebook) {
    BytesOut bytes;
    bytes.put(static_cast<std::uint32_t>(codebook.levels.size()));
    bytes.put(std::uint32_t{0});
    for (const Codebook::Level& level : codebook.levels) {
        bytes.put(LevelHeader{static_cast<std::uint32_t>(level.size()),
                              static_cast<std::uint32_t>(level.edges.size()), level.rms_error_m});
        bytes.put_all(level.x_m);
        bytes.put_all(level.y_m);
        bytes.put_all(level.z_m);
        bytes.put_all(level.weight);
        bytes.put_all(level.edges);
    }
    out.add(kCodeTag, kCodeVersion, index, bytes.take());
}

Codebook read_codebook(const SceneFile& file, std::uint32_t index) {
    BytesIn in(file.section(kCodeTag, kCodeVersion, index), where(file, "CODE", index));
    const auto levels = in.get<std::uint32_t>("count of levels");
    if (levels > kLevelsMax) {
        in.fail("it has " + std::to_string(levels) + " levels, more than " + std::to_string(kLevelsMax));
    }
    if (in.get<std::uint32_t>("reserved") != 0) in.fail("a reserved field is not zero");
    Codebook codebook;
    for (std::uint32_t l = 0; l < levels; ++l) {
        const std::string what = "level " + std::to_string(l);
        const auto header = in.get<LevelHeader>("level header");
        Codebook::Level level;
        level.rms_error_m = header.rms_error_m;
        if (!(header.rms_error_m >= 0.0 && header.rms_error_m <= kCoordinateMax_m)) {
            in.fail("the error of " + what + " is " + std::to_string(header.rms_error_m) + " m");
        }
        if (header.points == 0) in.fail(what + " has no points");
        if (l > 0 && header.points <= codebook.levels.back().size()) {
            in.fail(what + " has " + std::to_string(header.points) +
                    " points, not more than the level before it");
        }
        level.x_m = in.get_all<float>(header.points, "x");
        level.y_m = in.get_all<float>(header.points, "y");
        level.z_m = in.get_all<float>(header.points, "z");
        level.weight = in.get_all<float>(header.points, "weight");
        level.edges = in.get_all<std::array<std::uint32_t, 2>>(header.edges, "edges");
        in.check_finite(level.x_m, kCoordinateMax_m, "x of point");
        in.check_finite(level.y_m, kCoordinateMax_m, "y of point");
        in.check_finite(level.z_m, kCoordinateMax_m, "z of point");
        check_weights(in, level.weight, what);
        for (const auto& [a, b] : level.edges) {
            if (a >= header.points || b >= header.points || a == b) {
                in.fail("an edge of " + what + " joins points " + std::to_string(a) + " and " +
                        std::to_string(b) + " of " + std::to_string(header.points));
            }
        }
        codebook.levels.push_back(std::move(level));
    }
    in.finish();
    return codebook;
}

}  // namespace tact
