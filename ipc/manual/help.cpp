#include "ipc/manual/help.hpp"

#include <CLI/App.hpp>

#include "ipc/manual/command.hpp"

namespace tact::manual {
namespace {

std::string range_text(const Argument& a) {
    if (a.low.empty()) return {};
    return a.high.empty() ? "at least " + a.low : a.low + " to " + a.high;
}

}  // namespace

std::string HelpFormatter::make_option_opts(const CLI::Option* option) const {
    // The library's access to an option's checks is not const, but changes nothing.
    const Argument a =
        read_argument(const_cast<CLI::Option&>(*option));  // NOLINT(cppcoreguidelines-pro-type-const-cast)
    std::string text;
    if (!a.value.empty() && !a.positional) text += " " + a.value;
    if (a.repeated) text += " ...";
    std::string notes;
    const auto note = [&](const std::string& what) { notes += (notes.empty() ? "" : "; ") + what; };
    if (const std::string range = range_text(a); !range.empty()) note(range);
    if (!a.default_value.empty()) note("default " + a.default_value);
    if (a.required) note("required");
    for (const std::string& n : a.needs) note("needs " + n);
    for (const std::string& n : a.excludes) note("not with " + n);
    if (!notes.empty()) text += " (" + notes + ")";
    return text;
}

void use_help_formatter(CLI::App& app) {
    app.formatter(std::make_shared<HelpFormatter>());
    for (CLI::App* const sub : app.get_subcommands([](CLI::App*) { return true; })) use_help_formatter(*sub);
}

}  // namespace tact::manual
