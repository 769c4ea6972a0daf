#include "tests/reproduce/summary.hpp"

#include <algorithm>
#include <sstream>

namespace tact::launch {
namespace {

constexpr std::size_t kWrap = 100;

// Splits a text into lines of at most kWrap characters.
std::vector<std::string> wrapped(const std::string& text) {
    std::vector<std::string> lines;
    std::istringstream words(text);
    for (std::string w; words >> w;) {
        if (lines.empty() || lines.back().size() + 1 + w.size() > kWrap)
            lines.push_back(w);
        else
            lines.back() += " " + w;
    }
    return lines;
}

std::string padded(std::string text, std::size_t width) {
    text.resize(std::max(text.size(), width), ' ');
    return text;
}

}  // namespace

std::string table_of(const std::vector<SummaryRow>& rows) {
    std::vector<SummaryRow> all{{"fig", "quantity", "published", "measured", ""}};
    all.insert(all.end(), rows.begin(), rows.end());
    std::size_t figure = 0, quantity = 0, published = 0;
    for (const SummaryRow& r : all) {
        figure = std::max(figure, r.figure.size());
        quantity = std::max(quantity, r.quantity.size());
        published = std::max(published, r.published.size());
    }
    std::string text;
    for (const SummaryRow& r : all) {
        text += padded(r.figure, figure) + "  " + padded(r.quantity, quantity) + "  " +
                padded(r.published, published) + "  " + r.measured + "\n";
        for (const std::string& line : wrapped(r.differs)) text += std::string(figure + 4, ' ') + line + "\n";
    }
    return text;
}

nlohmann::json json_of(const std::vector<SummaryRow>& rows) {
    nlohmann::json all = nlohmann::json::array();
    for (const SummaryRow& r : rows)
        all.push_back({{"figure", r.figure},
                       {"quantity", r.quantity},
                       {"published", r.published},
                       {"measured", r.measured},
                       {"differs", r.differs}});
    return all;
}

}  // namespace tact::launch
