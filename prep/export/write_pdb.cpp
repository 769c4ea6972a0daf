#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>

#include "prep/export/write_structure_file.hpp"

namespace tact {
namespace {

// PDB allows free remarks with numbers 6 to 99.
constexpr char kRemark[] = "REMARK   6 TACT ";
constexpr char kNoCell[] =  // as in files of electron microscopy
    "CRYST1    1.000    1.000    1.000  90.00  90.00  90.00 P 1           1\n";

constexpr std::array kTitleRecords{"HEADER", "OBSLTE", "TITLE ", "SPLIT ", "CAVEAT", "COMPND",
                                   "SOURCE", "KEYWDS", "EXPDTA", "NUMMDL", "MDLTYP", "AUTHOR",
                                   "REVDAT", "SPRSDE", "JRNL  ", "REMARK"};
constexpr std::array kUntrueRecords{"CRYST1", "ORIGX", "SCALE", "MTRIX", "TVECT", "MASTER", "SIGATM",
                                    "SIGUIJ",
                                    // symmetry, and assemblies by matrices
                                    "REMARK 290", "REMARK 350", kRemark};

template <std::size_t N>
bool begins_with_one_of(std::string_view line, const std::array<const char*, N>& starts) {
    for (const char* const s : starts)
        if (line.starts_with(s)) return true;
    return false;
}

std::string remark_lines(const Remarks& remarks) {
    std::string text = std::string(kRemark) + "PLACED BY TACT; LENGTHS IN ANGSTROM, PLACE = MATRIX * FILE\n";
    for (const auto& [key, value] : remarks) {
        std::string rest = key + ": " + value;
        for (char& c : rest)  // PDB is ASCII
            if (static_cast<unsigned char>(c) < 0x20 || static_cast<unsigned char>(c) >= 0x7f) c = '?';
        while (!rest.empty()) {  // 80 columns; longer text continues on the next line
            std::size_t room = 80 - (sizeof kRemark - 1);
            if (rest.size() > room)
                if (const std::size_t blank = rest.rfind(' ', room - 1);
                    blank != std::string::npos && blank > 2)
                    room = blank + 1;
            text += kRemark + rest.substr(0, room) + '\n';
            rest = rest.size() > room ? "  " + rest.substr(room) : std::string();
        }
    }
    return text;
}

// Writes three columns of eight characters; false if a coordinate does not fit.
bool put_place(const Vec3& p, char* to) {
    char text[64];
    if (!(p.minCoeff() > -999.9995 && p.maxCoeff() < 9999.9995)) return false;
    std::snprintf(text, sizeof text, "%8.3f%8.3f%8.3f", p.x(), p.y(), p.z());
    std::copy(text, text + 24, to);
    return true;
}

bool put_adp(const Adp& u, char* to) {
    for (const double v : u) {
        const double scaled = std::round(1e4 * v);
        if (!(scaled > -1e6 && scaled < 1e7)) return false;
        char text[16];
        std::snprintf(text, sizeof text, "%7d", static_cast<int>(scaled));
        to = std::copy(text, text + 7, to);
    }
    return true;
}

}  // namespace

std::optional<std::string> moved_pdb(std::string_view text, const std::string& name, const AtomMove& move,
                                     const Remarks& remarks, std::span<const Vec3> bent_a) {
    const std::vector<FileAtom> atoms = pdb_atoms(text, name);  // checks every number
    std::size_t next = 0;
    bool said = false;
    std::string out;
    out.reserve(text.size() + 4096);
    while (!text.empty()) {
        const std::size_t end = text.find('\n');
        std::string line(text.substr(0, end));
        text.remove_prefix(end == std::string_view::npos ? text.size() : end + 1);
        if (!line.empty() && line.back() == '\r') line.pop_back();
        if (begins_with_one_of(line, kUntrueRecords)) continue;
        if (!said && !begins_with_one_of(line, kTitleRecords)) {
            out += remark_lines(remarks) + kNoCell;
            said = true;
        }
        if (line.starts_with("ATOM  ") || line.starts_with("HETATM")) {
            if (line.size() < 54) line.resize(54, ' ');
            const Vec3& place_a = bent_a.empty() ? atoms[next].place_a : bent_a[next];
            ++next;
            if (!put_place(move * place_a, &line[30])) return std::nullopt;
        } else if (line.starts_with("ANISOU") && next > 0 && atoms[next - 1].adp_u) {
            if (line.size() < 70) line.resize(70, ' ');
            if (!put_adp(move.turned(*atoms[next - 1].adp_u), &line[28])) return std::nullopt;
        }
        out += line + '\n';
    }
    return out;
}

std::optional<std::string> new_pdb(const std::vector<FileAtom>& atoms, const Remarks& remarks) {
    std::string out = remark_lines(remarks) + kNoCell;
    int serial = 0;
    for (std::size_t i = 0; i < atoms.size(); ++i) {
        const FileAtom& a = atoms[i];
        if (++serial > 99'999 || a.chain.size() > 1 || a.residue.size() > 4 || a.residue_name.size() > 3 ||
            a.name.size() > 4)
            return std::nullopt;
        // Atom names begin in column 14, except names of four letters and elements of two letters.
        const std::string name = a.name.size() < 4 && a.element.size() < 2 ? " " + a.name : a.name;
        char line[128];
        const auto head = [&](const char* record) {
            std::snprintf(line, sizeof line, "%-6s%5d %-4s%c%3s %1s%4s%c   ", record, serial, name.c_str(),
                          a.alternate, a.residue_name.c_str(), a.chain.c_str(), a.residue.c_str(),
                          a.insertion);
        };
        head(a.het ? "HETATM" : "ATOM");
        char rest[64];
        std::snprintf(rest, sizeof rest, "%6.2f%6.2f          %2.2s%-2.2s",
                      std::clamp(a.occupancy, -99.0, 999.99), std::clamp(a.b_iso, -99.0, 999.99),
                      a.element.c_str(), a.charge.c_str());
        char place[25] = {};
        if (!put_place(a.place_a, place)) return std::nullopt;
        out += std::string(line) + place + rest + '\n';
        if (a.adp_u) {
            head("ANISOU");
            char u[43] = {};
            if (!put_adp(*a.adp_u, u)) return std::nullopt;
            out += std::string(line).substr(0, 28) + u + "      " + std::string(rest).substr(22) + '\n';
        }
        const bool last = i + 1 == atoms.size();
        if (a.ends_chain || last || atoms[i + 1].chain != a.chain) {
            if (++serial > 99'999) return std::nullopt;
            std::snprintf(line, sizeof line, "TER   %5d      %3s %1s%4s%c\n", serial, a.residue_name.c_str(),
                          a.chain.c_str(), a.residue.c_str(), a.insertion);
            out += line;
        }
    }
    return out + "END\n";
}

}  // namespace tact
