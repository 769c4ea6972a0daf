// Four arrays, keyed by the words typed so far:
//   _tact_commands[tact]='demo dock ...'
//   _tact_options['tact dock']='--seconds ...'
//   _tact_values['tact dock --law']='words elastic ...', _tact_values['tact dock 1']='files mrc ...'; the key * is
//     the last argument if it may be repeated
//   _tact_program['tact record']='tact-record', which handles the rest
// Values are words, files with one of these endings (none: any), folders, or none when there is nothing to offer.
#include "ipc/manual/completion.hpp"

#include <array>
#include <utility>

namespace tact::manual {
namespace {

// By the name of the argument; includes compressed formats that Tact reads.
constexpr std::array<std::pair<const char*, const char*>, 6> kEndings{{
    {"SCENE", "tact"},
    {"MAP", "mrc map ccp4 situs mrc.gz map.gz ccp4.gz situs.gz"},
    {"MODEL", "pdb ent cif mmcif pdb.gz ent.gz cif.gz mmcif.gz"},
    {"MODELS", "pdb ent cif mmcif pdb.gz ent.gz cif.gz mmcif.gz"},
    {"MESH", "ply obj stl off ply.gz obj.gz stl.gz off.gz"},
    {"--mesh", "ply obj stl off ply.gz obj.gz stl.gz off.gz"},
}};

std::string in_quotes(const std::string& text) {
    std::string out = "'";
    for (const char c : text) out += c == '\'' ? std::string("'\\''") : std::string(1, c);
    return out + '\'';
}

std::string values(const Argument& a) {
    std::string text = "words";
    for (const std::string& c : a.choices) text += ' ' + c;
    if (!a.choices.empty()) return text;
    if (a.folder) return "folders";
    for (const auto& [name, endings] : kEndings)
        if (a.names.back() == name || a.type == name) return std::string("files ") + endings;
    if (a.number) return "none";
    // "FILE.h5": a file with this ending.
    if (const auto dot = a.type.find("."); dot != std::string::npos) return "files " + a.type.substr(dot + 1);
    return "files";
}

void add(const Command& c, std::string& out) {
    const std::string here = typed(c);
    if (c.passes_on) {
        out += "_tact_program[" + in_quotes(here) + "]=" + page_name(c) + '\n';
        return;
    }
    std::string words;
    for (const Command& sub : c.commands) words += (words.empty() ? "" : " ") + sub.words.back();
    if (!words.empty()) out += "_tact_commands[" + in_quotes(here) + "]=" + in_quotes(words) + '\n';
    words.clear();
    std::string all_values;
    for (const Group& g : c.groups)
        for (const Argument& a : g.arguments)
            for (const std::string& name : a.names) {
                words += (words.empty() ? "" : " ") + name;
                if (!a.value.empty())
                    all_values +=
                        "_tact_values[" + in_quotes(here + ' ' + name) + "]=" + in_quotes(values(a)) + '\n';
            }
    out += "_tact_options[" + in_quotes(here) + "]=" + in_quotes(words) + '\n' + all_values;
    for (std::size_t i = 0; i < c.positionals.size(); ++i) {
        const Argument& a = c.positionals[i];
        out += "_tact_values[" + in_quotes(here + ' ' + std::to_string(i + 1)) + "]=" + in_quotes(values(a)) +
               '\n';
        if (a.repeated) out += "_tact_values[" + in_quotes(here + " *") + "]=" + in_quotes(values(a)) + '\n';
    }
    for (const Command& sub : c.commands) add(sub, out);
}

}  // namespace

std::string completion(const Command& program) {
    std::string out;
    add(program, out);
    return out;
}

}  // namespace tact::manual
