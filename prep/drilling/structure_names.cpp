#include "prep/drilling/structure_names.hpp"

#include <toml++/toml.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cstdio>
#include <optional>

#include "ipc/base/error.hpp"
#include "ipc/scene/bone/structure_table.hpp"
#include "prep/drilling/import_bone.hpp"
#include "prep/input/read_file.hpp"

namespace tact {
namespace {

using Colour = std::array<std::uint8_t, 3>;

struct KnownColour {
    Colour rgb;
    const char* name;
};

// Colours of the segmented temporal bones of Johns Hopkins and SickKids (Munawar et al., volumetric drilling simulator).
constexpr Colour kTemporalBone{255, 249, 219};
constexpr std::array<KnownColour, 15> kTemporalBones{{{{233, 0, 255}, "malleus"},
                                                      {{0, 255, 149}, "incus"},
                                                      {{63, 0, 255}, "stapes"},
                                                      {{91, 123, 91}, "bony labyrinth"},
                                                      {{244, 142, 52}, "internal auditory canal"},
                                                      {{255, 191, 135}, "superior vestibular nerve"},
                                                      {{121, 70, 24}, "inferior vestibular nerve"},
                                                      {{219, 244, 52}, "cochlear nerve"},
                                                      {{244, 214, 49}, "facial nerve"},
                                                      {{151, 131, 29}, "chorda tympani"},
                                                      {{216, 100, 79}, "internal carotid artery"},
                                                      {{110, 184, 209}, "sigmoid sinus and dura"},
                                                      {{91, 98, 123}, "vestibular aqueduct"},
                                                      {{100, 0, 0}, "temporomandibular joint"},
                                                      {{255, 225, 214}, "external auditory canal"}}};

class TableReader {
public:
    explicit TableReader(const std::string& attempt) : attempt_(attempt) {}

    [[noreturn]] void fail(const toml::node& at, const std::string& why) const {
        fail_at(at.source().begin.line, why);
    }
    [[noreturn]] void fail_at(std::uint32_t line, const std::string& why) const {
        throw StartupError(
            attempt_ + (line > 0 ? ", line " + std::to_string(line) : std::string()), why,
            "write [[structure]] with label or colour, name, and critical; --write-structures writes "
            "such a table");
    }
    [[nodiscard]] std::uint8_t byte(const toml::node& node, int least, const char* what) const {
        const auto value = node.value_exact<std::int64_t>();
        if (!value || *value < least || *value > 255)
            fail(node,
                 std::string(what) + " must be a whole number from " + std::to_string(least) + " to 255");
        return static_cast<std::uint8_t>(*value);
    }
    [[nodiscard]] Colour colour(const toml::node& node) const {
        Colour c{};
        if (const toml::array* const list = node.as_array(); list != nullptr && list->size() == 3) {
            for (std::size_t i = 0; i < 3; ++i) c[i] = byte((*list)[i], 0, "a part of a colour");
            return c;
        }
        const auto text = node.value_exact<std::string>();
        unsigned rgb = 0;
        const bool form = text && text->size() == 7 && text->front() == '#';
        const char* const end = form ? text->data() + 7 : nullptr;
        if (!form || std::from_chars(text->data() + 1, end, rgb, 16).ptr != end)
            fail(node, "a colour must be \"#RRGGBB\" or [red, green, blue]");
        return {static_cast<std::uint8_t>(rgb >> 16U), static_cast<std::uint8_t>(rgb >> 8U & 255U),
                static_cast<std::uint8_t>(rgb & 255U)};
    }
    [[nodiscard]] ScanLabel structure(const toml::table& t) const {
        ScanLabel s;
        for (const auto& [key, node] : t) {
            const std::string_view name = key.str();
            if (name == "label") {
                s.value = byte(node, 1, "a label");
            } else if (name == "colour") {
                const Colour c = colour(node);
                s.rgba = {c[0], c[1], c[2], 255};
            } else if (name == "name") {
                const auto text = node.value_exact<std::string>();
                if (!text || text->empty()) fail(node, "a name must be a text");
                s.name = *text;
            } else if (name == "critical") {
                s.critical = node.value_exact<bool>();
                if (!s.critical) fail(node, "critical must be true or false");
            } else {
                fail(node,
                     "unknown key '" + std::string(name) + "'; known here: label, colour, name, critical");
            }
        }
        if (s.name.empty()) fail(t, "'name' is missing");
        if (s.value == 0 && s.rgba[3] == 0) fail(t, "a structure needs a label or a colour");
        return s;
    }

private:
    const std::string& attempt_;
};

}  // namespace

std::vector<ScanLabel> parse_structure_table(std::string_view text, const std::string& attempt) {
    const TableReader in(attempt);
    toml::table all;
    try {
        all = toml::parse(text);
    } catch (const toml::parse_error& e) {
        in.fail_at(e.source().begin.line, std::string(e.description()));
    }
    std::vector<ScanLabel> structures;
    for (const auto& [key, node] : all) {
        const toml::array* const list = node.as_array();
        if (key.str() != "structure" || list == nullptr || !list->is_array_of_tables())
            in.fail(node, "unknown part '" + std::string(key.str()) + "'; known here: [[structure]]");
        for (const toml::node& one : *list) structures.push_back(in.structure(*one.as_table()));
    }
    return structures;
}

std::string structure_table_text(const std::vector<ScanLabel>& structures,
                                 const std::vector<std::uint64_t>& voxels) {
    std::vector<StructureRow> rows;
    for (std::size_t i = 0; i < structures.size(); ++i) {
        const ScanLabel& s = structures[i];
        rows.push_back({s.value,
                        {s.rgba[0], s.rgba[1], s.rgba[2]},
                        s.name,
                        s.critical.value_or(false),
                        i < voxels.size() ? voxels[i] : 0});
    }
    return structure_table_text(rows);
}

std::vector<ScanLabel> names_of_palette(const StackPalette& palette, std::string& name) {
    const auto has = [&palette](const Colour& rgb) {
        return std::any_of(palette.rgba.begin(), palette.rgba.end(),
                           [&rgb](const std::array<std::uint8_t, 4>& c) {
                               return c[3] != 0 && std::equal(rgb.begin(), rgb.end(), c.begin());
                           });
    };
    std::vector<ScanLabel> names;
    if (!has(kTemporalBone)) return names;
    for (const KnownColour& k : kTemporalBones)
        if (has(k.rgb))
            names.push_back({.value = 0, .name = k.name, .rgba = {k.rgb[0], k.rgb[1], k.rgb[2], 255}});
    if (names.size() < kPaletteLeast) return {};
    name = "segmented temporal bones of Johns Hopkins and SickKids";
    return names;
}

std::vector<ScanLabel> read_structure_names(const std::filesystem::path& file) {
    const std::vector<char> bytes = read_whole_file(file, 1U << 20);
    const std::string_view text(bytes.data(), bytes.size());
    const std::string attempt = "read label names " + file.string();
    return file.extension() == ".toml" ? parse_structure_table(text, attempt)
                                       : parse_label_names(text, attempt);
}

std::vector<ScanLabel> known_names(const std::filesystem::path& scan, const StackPalette& palette) {
    if (const auto table = structure_table_beside(scan); !table.empty()) return read_structure_names(table);
    std::string name;
    return names_of_palette(palette, name);
}

}  // namespace tact
