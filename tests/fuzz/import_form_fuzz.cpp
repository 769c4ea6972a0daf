// A report of tact-prep examine, of arbitrary bytes: no form, or one whose sizes, numbers and arguments are in bounds.
#include <cmath>

#include "gui/window/import_form.hpp"
#include "tests/fuzz/fuzz.hpp"

namespace tact::fuzz {

bool run(std::span<const std::byte> input) {
    auto form = read_import_form({reinterpret_cast<const char*>(input.data()), input.size()});
    if (!form) return false;
    using F = ImportForm;
    require(form->lines.size() <= F::kLinesMost && form->numbers.size() <= F::kNumbersMost &&
            form->choices.size() <= F::kChoicesMost && form->bins.size() <= F::kBinsMost &&
            form->warnings.size() <= F::kLinesMost);
    require(form->bins.empty() || form->high > form->low);
    for (const float bin : form->bins) require(bin >= 0.0F && bin <= 1.0F);
    for (const F::Choice& c : form->choices)
        require(c.chosen < c.rows.size() && c.rows.size() <= F::kRowsMost);
    for (F::Number& n : form->numbers)
        if (const auto value = n.value()) require(*value >= n.low && *value <= n.high);
    require(form->structures.size() <= F::kStructuresMost);
    require(form->edited_table().empty());
    for (F::Structure& s : form->structures) s.critical = !s.critical;
    require(form->edited_table().empty() == form->structures.empty());
    const auto arguments = form->arguments();
    require(arguments.size() % 2 == 0);
    for (std::size_t i = 0; i < arguments.size(); i += 2) require(arguments[i].starts_with("--"));
    return true;
}

std::vector<Input> seeds() {
    std::vector<Input> all;
    for (
        const std::string& text :
        {std::string(
             R"({"lines":[{"label":"Format","value":"NRRD"}],"histogram":{"low":0,"high":255,"count":[1,2,30]},)"
             R"("numbers":[{"option":"--threshold-hu","label":"Bone above","unit":"","help":"h","low":-1e6,)"
             R"("high":1e6,"proposed":120.5,"in_histogram":true}],"choices":[],"warnings":["w"]})"),
         std::string(
             R"({"lines":[],"histogram":null,"numbers":[{"option":"--resolution-a","low":0.5,"high":200,)"
             R"("proposed":null}],"choices":[{"option":"--series","label":"Series","chosen":1,)"
             R"("rows":[{"value":"1","text":"a"},{"value":"2","text":"b"}]}],"warnings":[],)"
             R"("structures":[{"label":0,"colour":"#0aFF10","name":"n","critical":true,"voxels":7}],)"
             R"("structure_table":"/a/structures.toml"})")})
        all.emplace_back(std::as_bytes(std::span(text)).begin(), std::as_bytes(std::span(text)).end());
    return all;
}

}  // namespace tact::fuzz
