#include "deploy/tact/findings.hpp"

#include <algorithm>
#include <cstdio>

namespace tact::launch {
namespace {

const char* level_text(FindingLevel level) {
    switch (level) {
        case FindingLevel::ok:
            return "ok";
        case FindingLevel::warn:
            return "warn";
        case FindingLevel::fail:
            return "fail";
    }
    return "unknown";
}

}  // namespace

bool none_fails(const std::vector<Finding>& findings) {
    return std::none_of(findings.begin(), findings.end(),
                        [](const Finding& f) { return f.level == FindingLevel::fail; });
}

nlohmann::json findings_json(const std::vector<Finding>& findings) {
    nlohmann::json rows = nlohmann::json::array();
    for (const Finding& f : findings)
        rows.push_back({{"name", f.name}, {"level", level_text(f.level)}, {"says", f.says}, {"fix", f.fix}});
    return rows;
}

void print_findings(const std::vector<Finding>& findings) {
    for (const Finding& f : findings) {
        std::printf("%-4s  %-14s  %s\n", level_text(f.level), f.name.c_str(), f.says.c_str());
        if (!f.fix.empty()) std::printf("%22sfix: %s\n", "", f.fix.c_str());
    }
}

}  // namespace tact::launch
