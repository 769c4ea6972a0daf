#include <algorithm>

#include "prep/drilling/import_bone.hpp"
#include "prep/volume/header_text.hpp"

namespace tact {
namespace {

constexpr const char* kCriticalWords[] = {
    "nerve",  "nerv",     "facial", "chorda", "sinus",   "dura",    "carotid", "internal auditory",
    "artery", "arteria",  "vein",   "vena",   "vessel",  "jugular", "labyr",   "cochlea",
    "vestib", "semicirc", "incus",  "stapes", "malleus", "ossic",   "brain",   "orbit",
    "optic"};

// Abbreviations, which count as whole words only: "ica" is in "topical".
constexpr const char* kCriticalShort[] = {"ica", "iac", "iam", "ijv",  "fn",
                                          "cn7", "cn8", "vii", "viii", "scc"};

bool has_short_name(const std::string& low) {
    std::string words = " ";
    for (const char c : low) words += (c >= 'a' && c <= 'z') || (c >= '0' && c <= '9') ? c : ' ';
    words += ' ';
    return std::any_of(
        std::begin(kCriticalShort), std::end(kCriticalShort),
        [&words](const std::string& word) { return words.find(" " + word + " ") != std::string::npos; });
}

}  // namespace

std::vector<ScanLabel> parse_label_names(std::string_view text, const std::string& attempt) {
    constexpr const char* kFix = "write the list as ITK-SNAP does (Segmentation, Export Label Descriptions)";
    HeaderText in(text, attempt, kFix);
    std::vector<ScanLabel> labels;
    std::string_view line;
    while (in.line(line)) {
        line = HeaderText::trimmed(line);
        if (line.empty() || line.front() == '#') continue;
        const std::size_t quote = line.find('"'), end = line.rfind('"');
        const auto words = HeaderText::words(line.substr(0, std::min(quote, line.size())));
        if (quote == std::string_view::npos || end == quote || words.size() < 4)
            in.fail("a line does not have the form: value red green blue opacity visible mesh \"name\"");
        std::array<std::uint64_t, 4> number{};
        for (std::size_t i = 0; i < 4; ++i) {
            number[i] = in.whole(words[i], "a number of a label");
            if (number[i] > 255)
                in.fail("a number of a label is " + std::to_string(number[i]) + ", outside 0 to 255");
        }
        if (number[0] == 0) continue;  // skips "clear label"
        labels.push_back({static_cast<std::uint8_t>(number[0]),
                          std::string(line.substr(quote + 1, end - quote - 1)),
                          {static_cast<std::uint8_t>(number[1]), static_cast<std::uint8_t>(number[2]),
                           static_cast<std::uint8_t>(number[3]), 255},
                          {}});
    }
    return labels;
}

bool critical_name(const std::string& name, const std::vector<std::string>& more) {
    const std::string low = HeaderText::lower(name);
    const auto holds = [&](const std::string& word) {
        return !word.empty() && low.find(word) != std::string::npos;
    };
    return std::any_of(std::begin(kCriticalWords), std::end(kCriticalWords), holds) || has_short_name(low) ||
           std::any_of(more.begin(), more.end(),
                       [&](const std::string& w) { return holds(HeaderText::lower(w)); });
}

}  // namespace tact
