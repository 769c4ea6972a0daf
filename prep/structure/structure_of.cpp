#include <cmath>
#include <filesystem>
#include <unordered_map>

#include "ipc/base/error.hpp"
#include "ipc/base/printable.hpp"
#include "ipc/base/units.hpp"
#include "prep/structure/atom_rows.hpp"

namespace tact {
namespace {

constexpr double kWidestA = 2e4;  // two micrometres; BODY sections allow ten

// File names may contain control characters; text in sections may not.
std::string plain_name(const std::string& name) {
    return printable(std::filesystem::path(name).filename().string().substr(0, 255));
}

}  // namespace

Structure structure_of(const std::vector<AtomRow>& rows, const std::string& name) {
    double mass_u = 0.0;
    Vec3 com_a = Vec3::Zero();
    for (const AtomRow& r : rows) {
        mass_u += r.mass_u;
        com_a += r.mass_u * r.position_a;
    }
    com_a /= mass_u;
    Structure s;
    s.name = plain_name(name);
    s.mass_u = mass_u;
    s.home_com_model_m = kAngstromM * com_a;
    std::unordered_map<std::string, std::uint16_t> chain_index;
    for (const AtomRow& r : rows) {
        const Vec3 body_a = r.position_a - com_a;
        if (body_a.norm() > kWidestA) {
            throw StartupError("read structure " + name,
                               "atom " + r.atom_name + " of residue " + std::to_string(r.residue) + " lies " +
                                   std::to_string(body_a.norm()) + " ångström from the centre of mass",
                               "remove stray atoms from the file");
        }
        s.x_m.push_back(static_cast<float>(kAngstromM * body_a.x()));
        s.y_m.push_back(static_cast<float>(kAngstromM * body_a.y()));
        s.z_m.push_back(static_cast<float>(kAngstromM * body_a.z()));
        s.mass_fraction.push_back(static_cast<float>(r.mass_u / mass_u));
        s.element.push_back(r.element);
        s.residue.push_back(r.residue);
        const auto [at, fresh] =
            chain_index.try_emplace(r.chain, static_cast<std::uint16_t>(s.chain_names.size()));
        if (fresh) {
            if (s.chain_names.size() == 65535) {
                throw StartupError("read structure " + name, "the file has more than 65535 chains",
                                   "split the file into several files");
            }
            s.chain_names.push_back(r.chain);
        }
        s.chain.push_back(at->second);
        // Calcium also has the atom name CA, and phosphates of ligands also have P.
        const bool trace =
            (r.atom_name == "CA" && r.element == 6) || (r.atom_name == "P" && r.element == 15 && r.nucleic);
        s.trace.push_back(trace ? 1 : 0);
    }
    return s;
}

}  // namespace tact
