// Compares the files of deploy/monitoring with the exporter's output: every series named in a rule, in a test of a rule
// or in the dashboard is exported by Metrics::text(), with its labels and their values.
#include <gtest/gtest.h>

#include <fstream>
#include <map>
#include <nlohmann/json.hpp>
#include <regex>
#include <sstream>
#include <string>
#include <vector>

#include "deploy/tact/metrics.hpp"
#include "tests/unit/deploy_metrics_region.hpp"

namespace tact::launch::deploy_monitoring_test {
namespace {

using Labels = std::map<std::string, std::string>;
using Series = std::multimap<std::string, Labels>;

const std::string kFolder = "deploy/monitoring/";

std::string file_text(const std::string& path) {
    std::ifstream in(path);
    EXPECT_TRUE(in) << path;
    return {std::istreambuf_iterator<char>(in), {}};
}

std::vector<std::smatch> matches(const std::string& text, const std::regex& pattern) {
    return {std::sregex_iterator(text.begin(), text.end(), pattern), std::sregex_iterator()};
}

Labels labels_of(const std::string& inside) {
    Labels labels;
    static const std::regex label(R"((\w+)\s*(?:=~|!~|!=|=)\s*\\?"([^"\\]*)\\?")");
    for (const std::smatch& m : matches(inside, label)) labels[m[1]] = m[2];
    return labels;
}

// Series of other exporters: Prometheus itself and node_exporter.
const Series kOthers{{"up", {{"job", "tact"}}}, {"node_textfile_mtime_seconds", {{"file", "tact.prom"}}}};

// All series of the exporter: of a complete region, and of a controller that is gone.
Series exported() {
    const auto region = a_region();
    Metrics metrics("default");
    metrics.follow(*region, 1);
    std::string page = metrics.text(region.get());
    metrics.left(*region, 1);
    page += metrics.text(nullptr);
    Series all = kOthers;
    static const std::regex line(R"(^(\w+)\{(.*)\} \S+$)");
    std::istringstream lines(page);
    for (std::string text; std::getline(lines, text);) {
        std::smatch m;
        if (text[0] != '#' && std::regex_match(text, m, line)) all.emplace(m[1], labels_of(m[2]));
    }
    return all;
}

// Labels added by the scrape.
bool from_scrape(const std::string& label) { return label == "instance" || label == "job"; }
// Labels with a fixed set of values.
bool fixed_values(const std::string& label) {
    return label == "cause" || label == "state" || label == "kind" || label == "le" || label == "quantile";
}

// "" if a series of this name has these labels with such values; whole: and no other labels.
std::string wrong(const Series& all, const std::string& name, const Labels& labels, bool whole) {
    const auto [first, last] = all.equal_range(name);
    if (first == last) return name + " is not exported";
    for (auto at = first; at != last; ++at) {
        std::size_t own = 0;
        bool fits = true;
        for (const auto& [key, value] : labels) {
            const auto theirs = at->second.find(key);
            if (from_scrape(key) && theirs == at->second.end()) continue;
            ++own;
            fits = fits && theirs != at->second.end() && (!fixed_values(key) || theirs->second == value);
        }
        if (fits && (!whole || own == at->second.size())) return "";
    }
    std::string text = name + " is not exported with";
    for (const auto& [key, value] : labels) text += " " + key + "=" + value;
    return text;
}

// Checks each name in a PromQL expression, with the labels in the braces after it.
std::string wrong_in_expression(const Series& all, const std::string& expression) {
    static const std::regex name(R"(\b((?:tact|node)_\w+|up(?=\{))(?:\{([^}]*)\})?)");
    std::string bad;
    for (const std::smatch& m : matches(expression, name)) {
        const std::string one = wrong(all, m[1], labels_of(m[2]), false);
        if (!one.empty()) bad += one + "; ";
    }
    return bad;
}

TEST(Monitoring, the_comparison_finds_names_labels_and_values_that_are_not_exported) {
    const Series all = exported();
    EXPECT_EQ(wrong_in_expression(all, "rate(tact_faults_total{cause=\"overruns\"}[5m]) / up{job=\"tact\"}"),
              "");
    EXPECT_NE(wrong_in_expression(all, "increase(tact_fault_total[5m])"), "");
    EXPECT_NE(wrong_in_expression(all, "tact_faults_total{cause=\"the device is lost\"}"), "");
    EXPECT_NE(wrong_in_expression(all, "tact_faults_total{reason=\"overruns\"}"), "");
    EXPECT_NE(wrong(all, "tact_up", {{"instance", "lab1"}}, true), "");  // without its session
    EXPECT_EQ(wrong(all, "tact_up", {{"instance", "lab1"}, {"session", "x"}}, true), "");
}

TEST(Monitoring, every_rule_uses_series_that_are_exported) {
    const Series all = exported();
    const std::string rules = file_text(kFolder + "tact_rules.yml");
    static const std::regex expression(R"(\n +expr: ([^\n]+))");
    const auto found = matches(rules, expression);
    EXPECT_EQ(found.size(), matches(rules, std::regex("- alert: ")).size());
    EXPECT_GE(found.size(), 15U);
    for (const std::smatch& m : found) EXPECT_EQ(wrong_in_expression(all, m[1]), "") << m[1];
}

TEST(Monitoring, every_series_of_the_rules_test_is_exported) {
    const Series all = exported();
    const std::string text = file_text(kFolder + "tact_rules_test.yml");
    static const std::regex series(R"(series: '(\w+)\{([^}]*)\}')");
    const auto found = matches(text, series);
    EXPECT_EQ(found.size(), matches(text, std::regex("series: ")).size() -
                                matches(text, std::regex("input_series: ")).size());
    EXPECT_GE(found.size(), 20U);
    for (const std::smatch& m : found) EXPECT_EQ(wrong(all, m[1], labels_of(m[2]), true), "") << m[0];
}

TEST(Monitoring, every_query_of_the_dashboard_uses_series_that_are_exported) {
    const Series all = exported();
    const auto dashboard = nlohmann::json::parse(file_text(kFolder + "tact_dashboard.json"));
    std::size_t queries = 0;
    for (const auto& panel : dashboard["panels"])
        for (const auto& target : panel["targets"]) {
            const std::string text = target["expr"];
            EXPECT_EQ(wrong_in_expression(all, text), "") << text;
            ++queries;
        }
    for (const auto& variable : dashboard["templating"]["list"])
        EXPECT_EQ(wrong_in_expression(all, variable["query"].get<std::string>()), "");
    EXPECT_GE(queries, 12U);
}

TEST(Monitoring, every_rule_is_tested_and_has_severity_summary_fix_and_a_line_in_the_readme) {
    const std::string rules = file_text(kFolder + "tact_rules.yml");
    const std::string tests = file_text(kFolder + "tact_rules_test.yml");
    const std::string readme = file_text(kFolder + "README.md");
    static const std::regex begin(R"(- alert: (\w+)\n)");
    const auto found = matches(rules, begin);
    for (std::size_t i = 0; i < found.size(); ++i) {
        const auto at = static_cast<std::size_t>(found[i].position());
        const auto end =
            i + 1 < found.size() ? static_cast<std::size_t>(found[i + 1].position()) : rules.size();
        const std::string block = rules.substr(at, end - at), name = found[i][1];
        for (const char* const part : {"severity: ", "summary: ", "fix: \""})
            EXPECT_NE(block.find(part), std::string::npos) << name << " has no " << part;
        EXPECT_NE(readme.find("| `" + name + "` |"), std::string::npos) << name << " is not in README.md";
        const std::string tested = "alertname: " + name;
        EXPECT_NE(tests.find(tested + "\n"), std::string::npos) << name << " fires in no test";
        EXPECT_NE(tests.find(tested + ", exp_alerts: []"), std::string::npos)
            << name << " is quiet in no test";
    }
}

TEST(Monitoring, the_readme_lists_every_cause_of_a_fault) {
    const std::string readme = file_text(kFolder + "README.md");
    for (const auto& [name, labels] : exported()) {
        if (name != "tact_faults_total") continue;
        EXPECT_NE(readme.find("| `" + labels.at("cause") + "` |"), std::string::npos) << labels.at("cause");
    }
}

}  // namespace
}  // namespace tact::launch::deploy_monitoring_test
