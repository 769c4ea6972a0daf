#include "ipc/manual/page.hpp"

#include <algorithm>
#include <cctype>
#include <cstdlib>
#include <ctime>

#include "ipc/manual/roff.hpp"

namespace tact::manual {
namespace {

constexpr const char* kExitCodes = "Exit codes:";

std::string date() {
    const char* const epoch = std::getenv("SOURCE_DATE_EPOCH");
    if (epoch == nullptr) return {};
    const std::time_t seconds = std::strtoll(epoch, nullptr, 10);
    std::tm parts{};
    gmtime_r(&seconds, &parts);
    char text[16];
    std::strftime(text, sizeof text, "%Y-%m-%d", &parts);
    return text;
}

bool lower(char c) { return std::islower(static_cast<unsigned char>(c)) != 0; }
bool upper(char c) { return std::isupper(static_cast<unsigned char>(c)) != 0; }

// Makes a help text a sentence: a capital first, unless it is a symbol or a name, and a full stop.
std::string sentence(std::string text) {
    while (!text.empty() && std::isspace(static_cast<unsigned char>(text.back())) != 0) text.pop_back();
    if (text.empty()) return text;
    const bool word = text[std::min(text.find_first_of(" :,"), text.size() - 1)] != ':';
    if (word && text.size() > 1 && lower(text[0]) && (lower(text[1]) || text[1] == ' '))
        text[0] = static_cast<char>(std::toupper(static_cast<unsigned char>(text[0])));
    if (text.back() != '.' && text.back() != '?') text += '.';
    return text;
}

// Removes "Tact: " from "Tact: does this", since NAME already prints "tact - does this".
std::string without_name(const std::string& text, const std::string& name) {
    if (text.size() > name.size() + 2 && text[name.size()] == ':' &&
        CLI::detail::to_lower(text.substr(0, name.size())) == name)
        return text.substr(name.size() + 2);
    return text;
}

std::string summary(const std::string& about) {
    std::string first = about.substr(0, std::min(about.find('\n'), about.find(". ")));
    while (!first.empty() && (first.back() == '.' || first.back() == ' ')) first.pop_back();
    if (first.size() > 1 && upper(first[0]) && (lower(first[1]) || first[1] == ' '))
        first[0] = static_cast<char>(std::tolower(static_cast<unsigned char>(first[0])));
    return first;
}

// One paragraph per line.
std::string paragraphs(const std::string& text) {
    std::string out;
    for (const std::string& line : CLI::detail::split(text, '\n'))
        if (!line.empty()) out += (out.empty() ? "" : ".PP\n") + roff(sentence(line)) + "\n";
    return out;
}

std::string listed(const std::vector<std::string>& words) {
    std::string text;
    for (const std::string& w : words) text += (text.empty() ? "" : ", ") + bold(w);
    return text;
}

std::string heading(const Argument& a) {
    std::string text;
    for (const std::string& name : a.names)
        text += (text.empty() ? "" : ", ") + (a.positional ? italic(name) : bold(name));
    if (!a.positional && !a.value.empty())
        text += ' ' + (a.choices.empty() ? italic(a.value) : bold(a.value));
    return text;
}

std::string remarks(const Argument& a) {
    std::string text;
    const auto add = [&text](const std::string& remark) { text += (text.empty() ? "" : " ") + remark; };
    if (a.positional && !a.choices.empty()) add("One of " + listed(a.choices) + '.');
    if (!a.low.empty()) add(roff("Range: " + a.low + " to " + a.high + '.'));
    if (!a.default_value.empty()) add(roff("Default: " + a.default_value + '.'));
    if (a.required && !a.positional) add("Required.");
    if (a.repeated) add("May be repeated.");
    if (!a.needs.empty()) add("Needs " + listed(a.needs) + '.');
    if (!a.excludes.empty()) add("Not together with " + listed(a.excludes) + '.');
    return text;
}

std::string entries(const std::vector<Argument>& arguments) {
    std::string out;
    for (const Argument& a : arguments) {
        out += ".TP\n" + heading(a) + "\n" + roff(sentence(a.help));
        const std::string more = remarks(a);
        out += (more.empty() ? "" : " ") + more + "\n";
    }
    return out;
}

std::string synopsis(const Command& c) {
    std::string out = bold(typed(c));
    for (const Group& g : c.groups)
        for (const Argument& a : g.arguments)
            if (a.required) out += ' ' + bold(a.names.back()) + ' ' + italic(a.value);
    out += " [\\fIOPTION\\fR]...";
    if (!c.commands.empty()) out += " \\fICOMMAND\\fR ...";
    for (const Argument& a : c.positionals)
        out += ' ' + (a.required ? italic(a.names.front()) : '[' + italic(a.names.front()) + ']') +
               (a.repeated ? "..." : "");
    return out + '\n';
}

std::string options(const Command& c) {
    std::string out;
    for (const Group& g : c.groups) {
        if (g.arguments.empty()) continue;
        if (!g.title.empty()) out += ".SS \"" + roff(g.title) + "\"\n" + paragraphs(g.about);
        if (!g.one_of.empty()) out += "Exactly one of " + listed(g.one_of) + " is required.\n";
        out += entries(g.arguments);
    }
    return out;
}

// Formats "Exit codes: 0 success; 1 error" as a list.
std::string exit_status(const std::string& footer) {
    const auto at = footer.find(kExitCodes);
    if (at == std::string::npos) return {};
    std::string out = ".SH \"EXIT STATUS\"\n";
    const auto line = footer.substr(at, footer.find('\n', at) - at).substr(std::string(kExitCodes).size());
    for (std::string item : CLI::detail::split(line, ';')) {
        item = CLI::detail::trim(item);
        const auto space = item.find(' ');
        if (space == std::string::npos) continue;
        out += ".TP\n" + bold(item.substr(0, space)) + "\n" + roff(sentence(item.substr(space + 1))) + "\n";
    }
    return out;
}

std::string references(const std::string& own, const Command& c) {
    std::vector<std::string> names;
    for (const Command& sub : c.commands) names.push_back(page_name(sub));
    if (c.words.size() > 2) names.push_back(c.words[0] + '-' + c.words[1]);
    for (const std::string& p : programs()) names.push_back(p);
    std::sort(names.begin(), names.end());
    names.erase(std::unique(names.begin(), names.end()), names.end());
    names.erase(std::remove(names.begin(), names.end(), own), names.end());
    std::string out = ".SH \"SEE ALSO\"\n";
    for (const std::string& n : names)
        out += ".BR " + roff(n) + " (1)" + (&n == &names.back() ? "\n" : ",\n");
    return out;
}

std::string commands(const Command& c) {
    if (c.commands.empty()) return {};
    // Its own page would be the page of another program.
    const auto described_here = [](const Command& sub) {
        return is_program(page_name(sub)) && !sub.passes_on;
    };
    std::string out = ".SH COMMANDS\n";
    for (const Command& sub : c.commands)
        out += ".TP\n" + bold(sub.words.back()) + "\n" + roff(sentence(sub.about)) + " See " +
               (described_here(sub) ? capitals(sub.words.back()) + " below.\n"
                                    : bold(page_name(sub)) + "(1).\n");
    for (const Command& sub : c.commands)
        if (described_here(sub))
            out += ".SH \"" + roff(capitals(sub.words.back())) + "\"\n" + synopsis(sub) + ".PP\n" +
                   paragraphs(sub.about) + entries(sub.positionals) + options(sub);
    return out;
}

Page page(const Command& c, const std::string& version, const std::vector<File>& files) {
    const std::string name = page_name(c), about = without_name(c.about, c.words.back());
    Page p{name, {}};
    p.text = ".TH " + roff(capitals(name)) + " 1 \"" + date() + "\" \"" +
             roff(version.empty() ? "Tact" : "Tact " + version) + "\" \"Tact manual\"\n";
    p.text += ".nh\n.ad l\n";  // no hyphenation, no justification
    p.text += ".SH NAME\n" + roff(name) + " \\- " + roff(summary(about)) + "\n";
    p.text += ".SH SYNOPSIS\n" + synopsis(c) + ".SH DESCRIPTION\n" + paragraphs(about);
    p.text += entries(c.positionals);
    p.text += ".SH OPTIONS\n" + options(c) + commands(c) + exit_status(c.footer);
    if (!files.empty()) p.text += ".SH FILES\n";
    for (const File& f : files) p.text += ".TP\n" + italic(f.path) + "\n" + roff(sentence(f.about)) + "\n";
    p.text += references(name, c);
    return p;
}

void add_pages(const Command& c, const std::string& version, const std::vector<File>& files,
               std::vector<Page>& all) {
    all.push_back(page(c, version, files));
    for (const Command& sub : c.commands)
        if (!is_program(page_name(sub))) add_pages(sub, version, files, all);
}

}  // namespace

std::vector<Page> pages(const Command& program, const std::vector<File>& files) {
    // "tact 0.1.0" or "0.1.0"
    std::string version = program.version.substr(0, program.version.find('\n'));
    if (version.find(program.words.front() + ' ') == 0) version.erase(0, program.words.front().size() + 1);
    std::vector<Page> all;
    add_pages(program, version, files, all);
    return all;
}

}  // namespace tact::manual
