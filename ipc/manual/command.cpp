#include "ipc/manual/command.hpp"

#include <CLI/Config.hpp>
#include <CLI/Formatter.hpp>
#include <algorithm>
#include <cctype>
#include <cstdio>
#include <cstdlib>

namespace tact::manual {
namespace {

std::string joined(const std::vector<std::string>& words, const char* between) {
    std::string text;
    for (const std::string& w : words) text += (text.empty() ? "" : between) + w;
    return text;
}

// Converts "1e+07" to "10000000".
std::string plain_number(const std::string& text) {
    char* end = nullptr;
    const double value = std::strtod(text.c_str(), &end);
    if (end == text.c_str() || *end != '\0') return text;
    char out[64];
    std::snprintf(out, sizeof out, "%.15g", value);
    return out;
}

// For "{a,b}" or "value in {a->1,b->2} OR {1,2}": a and b.
std::vector<std::string> choices_of(const std::string& check) {
    std::vector<std::string> found;
    const auto open = check.find('{'), close = check.find('}');
    if (open == std::string::npos || close == std::string::npos || close < open) return found;
    for (const std::string& item : CLI::detail::split(check.substr(open + 1, close - open - 1), ','))
        found.push_back(item.substr(0, item.find("->")));
    return found;
}

// Choices of a type such as "elastic|sensitus|fixed".
std::vector<std::string> choices_of_type(const std::string& type) {
    const bool lower = std::all_of(type.begin(), type.end(), [](unsigned char c) {
        return std::islower(c) != 0 || std::isdigit(c) != 0 || c == '|' || c == '-';
    });
    return lower && type.find('|') != std::string::npos ? CLI::detail::split(type, '|')
                                                        : std::vector<std::string>{};
}

std::vector<std::string> checks_of(CLI::Option& option) {
    std::vector<std::string> found;
    try {
        for (int i = 0;; ++i)
            if (const std::string text = option.get_validator(i)->get_description(); !text.empty())
                found.push_back(text);
    } catch (const CLI::OptionNotFound&) {  // the library's sign that no more exist
    }
    return found;
}

std::string first_name(const CLI::Option& option) {
    if (!option.get_lnames().empty()) return "--" + option.get_lnames().front();
    if (!option.get_snames().empty()) return "-" + option.get_snames().front();
    return capitals(option.get_name(true));
}

void apply_check(const std::string& check, Argument& a) {
    const auto range = check.find(" in [");
    if (range != std::string::npos && check.back() == ']') {
        const std::string inside = check.substr(range + 5, check.size() - range - 6);
        const auto middle = inside.find(" - ");
        a.low = plain_number(inside.substr(0, middle));
        if (middle != std::string::npos) a.high = plain_number(inside.substr(middle + 3));
        a.number = true;
    } else if (check.find('{') != std::string::npos) {
        a.choices = choices_of(check);
    } else if (check == "DIR") {
        a.folder = true;
        a.value = "DIR";
    } else if (check.find("PATH") == 0) {
        a.value = "PATH";
    } else if (check.find(' ') == std::string::npos) {
        a.value = check;
    }
}

std::string placeholder(const CLI::Option& option, const Argument& a, const std::string& named) {
    if (!a.choices.empty()) return joined(a.choices, "|");
    std::string one = named;
    if (one.empty() || one == "TEXT") one = a.value.empty() ? "TEXT" : a.value;
    if (one == "FLOAT") one = "X";
    if (one == "INT" || one == "UINT") one = "N";
    std::string all = one;
    const int values = std::min(option.get_items_expected_min(), 8);
    for (int i = 1; i < values; ++i)
        all += (option.get_delimiter() != '\0' ? option.get_delimiter() : ' ') + one;
    return all;
}

}  // namespace

Argument read_argument(CLI::Option& option) {
    Argument a;
    a.positional = option.get_positional();
    a.help = option.get_description();
    a.required = option.get_required();
    if (a.positional) {
        a.names = {capitals(option.get_name(true))};
    } else {
        for (const auto& n : option.get_snames()) a.names.push_back("-" + n);
        for (const auto& n : option.get_lnames()) a.names.push_back("--" + n);
    }
    for (const CLI::Option* o : option.get_needs()) a.needs.push_back(first_name(*o));
    for (const CLI::Option* o : option.get_excludes()) a.excludes.push_back(first_name(*o));
    std::sort(a.needs.begin(), a.needs.end());  // they are sorted by address
    std::sort(a.excludes.begin(), a.excludes.end());
    if (option.get_items_expected_max() == 0) return a;  // a flag
    // The library formats the type and every check as TYPE:CHECK:CHECK.
    const std::vector<std::string> checks = checks_of(option);
    a.type = option.get_type_name();
    for (auto c = checks.rbegin(); c != checks.rend(); ++c)
        if (const auto at = a.type.rfind(*c); at != std::string::npos && at + c->size() == a.type.size())
            a.type.erase(at > 0 ? at - 1 : 0);
    a.choices = choices_of_type(a.type);
    a.number = a.type == "FLOAT" || a.type == "INT" || a.type == "UINT";
    a.folder = a.type == "DIR";
    for (const std::string& check : checks) apply_check(check, a);
    a.value = placeholder(option, a, a.type);
    a.default_value = plain_number(option.get_default_str());
    a.default_value.erase(std::remove(a.default_value.begin(), a.default_value.end(), '"'),
                          a.default_value.end());
    a.repeated = option.get_expected_max() >= CLI::detail::expected_max_vector_size ||
                 (!a.positional && option.get_multi_option_policy() == CLI::MultiOptionPolicy::TakeAll);
    return a;
}

namespace {

void read_arguments(CLI::App& app, Command& command, Group& group) {
    const bool one = app.get_require_option_min() == 1 && app.get_require_option_max() == 1;
    for (CLI::Option* const option :
         app.get_options([](CLI::Option* o) { return !o->get_group().empty(); })) {
        if (app.get_name().empty() && app.get_parent() != nullptr && option == app.get_help_ptr())
            continue;  // a group inherits --help
        Argument a = read_argument(*option);
        if (one) group.one_of.push_back(a.names.back());
        (a.positional ? command.positionals : group.arguments).push_back(std::move(a));
    }
}

}  // namespace

Command read_command(CLI::App& app, std::vector<std::string> words) {
    Command command;
    command.words = std::move(words);
    command.about = app.get_description();
    command.footer = app.get_footer();
    command.version = app.version();
    command.passes_on = app.get_prefix_command();
    command.groups.emplace_back();
    read_arguments(app, command, command.groups.front());
    for (CLI::App* const sub : app.get_subcommands([](CLI::App* s) { return !s->get_group().empty(); })) {
        if (sub->get_name().empty()) {
            Group group{sub->get_group(), sub->get_description(), {}, {}};
            read_arguments(*sub, command, group);
            command.groups.push_back(std::move(group));
        } else {
            std::vector<std::string> deeper = command.words;
            deeper.push_back(sub->get_name());
            command.commands.push_back(read_command(*sub, std::move(deeper)));
        }
    }
    return command;
}

std::string capitals(std::string text) {
    for (char& c : text) c = static_cast<char>(std::toupper(static_cast<unsigned char>(c)));
    return text;
}

std::string typed(const Command& command) { return joined(command.words, " "); }
std::string page_name(const Command& command) { return joined(command.words, "-"); }

const std::vector<std::string>& programs() {
    static const std::vector<std::string> all{"tact",           "tact-bench",  "tact-certify", "tact-gui",
                                              "tact-prep",      "tact-record", "tact-refine",  "tact-replay",
                                              "tact-reproduce", "tact-rt",     "tact-search"};
    return all;
}

bool is_program(const std::string& page) {
    return std::find(programs().begin(), programs().end(), page) != programs().end();
}

}  // namespace tact::manual
