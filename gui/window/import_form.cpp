#include "gui/window/import_form.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstdio>
#include <cstring>
#include <nlohmann/json.hpp>

namespace tact {
namespace {

using nlohmann::json;

std::string short_text(const json& j, const char* key) {
    const auto found = j.find(key);
    if (found == j.end() || !found->is_string()) return {};
    std::string text = found->get<std::string>();
    if (text.size() <= ImportForm::kTextMost) return text;
    std::size_t end = ImportForm::kTextMost;  // whole characters of UTF-8
    while (end > 0 && (static_cast<unsigned char>(text[end]) & 0xc0U) == 0x80U) --end;
    return text.substr(0, end) + "...";
}

std::optional<double> finite_number(const json& j, const char* key) {
    const auto found = j.find(key);
    if (found == j.end() || !found->is_number()) return std::nullopt;
    const double value = found->get<double>();
    return std::isfinite(value) ? std::optional(value) : std::nullopt;
}

// The objects of an array, at most so many.
std::vector<json> objects(const json& j, const char* key, std::size_t most) {
    std::vector<json> out;
    const auto found = j.find(key);
    if (found == j.end() || !found->is_array()) return out;
    for (const json& each : *found)
        if (each.is_object() && out.size() < most) out.push_back(each);
    return out;
}

std::string short_path(const json& j) {
    const auto found = j.find("structure_table");
    if (found == j.end() || !found->is_string()) return {};
    const std::string path = found->get<std::string>();
    return path.size() < 4096 && path.starts_with('/') && path.ends_with("structures.toml") ? path
                                                                                            : std::string();
}

// Options become arguments of a command.
bool is_option(const std::string& text) {
    return text.starts_with("--") && text.size() > 2 && std::all_of(text.begin() + 2, text.end(), [](char c) {
               return (c >= 'a' && c <= 'z') || (c >= '0' && c <= '9') || c == '-';
           });
}

void read_bins(const json& j, ImportForm& form) {
    const auto found = j.find("histogram");
    if (found == j.end() || !found->is_object()) return;
    const auto low = finite_number(*found, "low"), high = finite_number(*found, "high");
    const auto count = found->find("count");
    if (!low || !high || !(*high > *low) || count == found->end() || !count->is_array() ||
        count->size() > ImportForm::kBinsMost)
        return;
    std::vector<float> bins;
    float most = 0.0F;
    for (const json& n : *count) {
        const double value = n.is_number() ? n.get<double>() : 0.0;
        bins.push_back(value > 0.0 && std::isfinite(value) ? static_cast<float>(std::log1p(value)) : 0.0F);
        most = std::max(most, bins.back());
    }
    if (!(most > 0.0F)) return;
    for (float& b : bins) b /= most;
    form.low = *low;
    form.high = *high;
    form.bins = std::move(bins);
}

// "#RRGGBB"
std::optional<std::array<std::uint8_t, 3>> colour_of(const std::string& text) {
    std::array<std::uint8_t, 3> rgb{};
    if (text.size() != 7 || text[0] != '#') return std::nullopt;
    for (std::size_t c = 0; c < 3; ++c) {
        const char* const at = text.data() + 1 + 2 * c;
        if (std::from_chars(at, at + 2, rgb[c], 16).ptr != at + 2) return std::nullopt;
    }
    return rgb;
}

void read_structures(const json& j, ImportForm& form) {
    form.structure_table = short_path(j);
    if (form.structure_table.empty()) return;
    for (const json& each : objects(j, "structures", ImportForm::kStructuresMost)) {
        ImportForm::Structure s;
        const auto label = finite_number(each, "label"), voxels = finite_number(each, "voxels");
        const auto colour = colour_of(short_text(each, "colour"));
        s.row.name = short_text(each, "name");
        if (!label || !(*label >= 0.0 && *label <= 255.0) || !colour || s.row.name.empty()) continue;
        s.row.label = static_cast<std::uint8_t>(*label);
        s.row.rgb = *colour;
        s.row.voxels = voxels && *voxels >= 0.0 && *voxels < 1e18 ? static_cast<std::uint64_t>(*voxels) : 0;
        s.row.critical = each.value("critical", json()).is_boolean() && each["critical"].get<bool>();
        s.critical = s.row.critical;
        std::snprintf(s.name.data(), s.name.size(), "%s", s.row.name.c_str());
        s.row.name = s.name.data();  // a longer name is not taken for a changed one
        form.structures.push_back(std::move(s));
    }
}

}  // namespace

std::optional<double> ImportForm::Number::value() const {
    const char* const end = typed.data() + std::strlen(typed.data());
    double out = 0.0;
    const auto [stopped, error] = std::from_chars(typed.data(), end, out);
    if (error != std::errc{} || stopped != end) return std::nullopt;
    // Not a number fails the comparison.
    if (!(out >= low && out <= high)) return std::nullopt;
    return out;
}

void ImportForm::Number::set(double value) { std::snprintf(typed.data(), typed.size(), "%.4g", value); }

bool ImportForm::complete() const {
    return std::all_of(numbers.begin(), numbers.end(),
                       [](const Number& n) { return n.value().has_value(); }) &&
           std::none_of(structures.begin(), structures.end(),
                        [](const Structure& s) { return s.name[0] == 0; });
}

std::string ImportForm::edited_table() const {
    const bool same = std::all_of(structures.begin(), structures.end(), [](const Structure& s) {
        return s.row.name == s.name.data() && s.row.critical == s.critical;
    });
    if (same) return {};
    std::vector<StructureRow> rows;
    for (const Structure& s : structures) {
        rows.push_back(s.row);
        rows.back().name = s.name.data();
        rows.back().critical = s.critical;
    }
    return structure_table_text(rows);
}

std::vector<std::string> ImportForm::choice_arguments() const {
    std::vector<std::string> out;
    for (const Choice& c : choices)
        if (c.chosen < c.rows.size()) out.insert(out.end(), {c.option, c.rows[c.chosen].first});
    return out;
}

std::vector<std::string> ImportForm::arguments() const {
    std::vector<std::string> out = choice_arguments();
    // One of several values of the files alone could contradict the others.
    const bool moved = std::any_of(numbers.begin(), numbers.end(), [](const Number& n) {
        return n.in_histogram && n.proposed != n.typed.data();
    });
    for (const Number& n : numbers)
        if (n.proposed != n.typed.data() || (moved && n.in_histogram))
            out.insert(out.end(), {n.option, n.typed.data()});
    return out;
}

std::optional<ImportForm> read_import_form(std::string_view text) {
    const json j = json::parse(text, nullptr, false);
    if (!j.is_object() || !j.contains("lines")) return std::nullopt;
    ImportForm form;
    for (const json& l : objects(j, "lines", ImportForm::kLinesMost))
        form.lines.push_back({short_text(l, "label"), short_text(l, "value")});
    read_bins(j, form);
    for (const json& n : objects(j, "numbers", ImportForm::kNumbersMost)) {
        ImportForm::Number number;
        number.option = short_text(n, "option");
        number.label = short_text(n, "label");
        number.unit = short_text(n, "unit");
        number.help = short_text(n, "help");
        const auto low = finite_number(n, "low"), high = finite_number(n, "high");
        if (!is_option(number.option) || !low || !high) continue;
        number.low = *low;
        number.high = *high;
        number.in_histogram = !form.bins.empty() && n.value("in_histogram", json()).is_boolean() &&
                              n["in_histogram"].get<bool>();
        number.of_file = n.value("of_file", json()).is_boolean() && n["of_file"].get<bool>();
        if (const auto proposed = finite_number(n, "proposed")) {
            number.set(*proposed);
            number.proposed = number.typed.data();
        }
        form.numbers.push_back(std::move(number));
    }
    for (const json& c : objects(j, "choices", ImportForm::kChoicesMost)) {
        ImportForm::Choice choice{short_text(c, "option"), short_text(c, "label"), {}, 0};
        for (const json& row : objects(c, "rows", ImportForm::kRowsMost))
            choice.rows.emplace_back(short_text(row, "value"), short_text(row, "text"));
        const auto chosen = finite_number(c, "chosen");
        if (!is_option(choice.option) || choice.rows.empty() || !chosen || !(*chosen >= 0.0)) continue;
        choice.chosen = static_cast<std::size_t>(std::min(*chosen, 1e6));
        const bool plain = std::none_of(choice.rows.begin(), choice.rows.end(), [](const auto& row) {
            return row.first.empty() || row.first.front() == '-';
        });
        if (plain && choice.chosen < choice.rows.size()) form.choices.push_back(std::move(choice));
    }
    read_structures(j, form);
    if (const auto warnings = j.find("warnings"); warnings != j.end() && warnings->is_array())
        for (const json& w : *warnings)
            if (w.is_string() && form.warnings.size() < ImportForm::kLinesMost)
                form.warnings.push_back(short_text({{"text", w}}, "text"));
    return form;
}

}  // namespace tact
