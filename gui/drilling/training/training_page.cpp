// The page of a training session: HTML that needs no other file.
#include <array>

#include "gui/drilling/training/training_report.hpp"
#include "gui/drilling/training/training_text.hpp"

namespace tact {
namespace {

using nlohmann::json;

constexpr std::size_t kDate = 0, kPoints = 4, kTimeS = 12, kInjuries = 14;  // columns of the table
constexpr std::size_t kEarlierMost = 10;

const char* part_text(TrainingPart part) {
    static constexpr std::array kTexts{"goal reached",    "bone outside the goal left",
                                       "bone thinned",    "structures kept",
                                       "force below 2 N", "burr in sight",
                                       "in time"};
    return kTexts[static_cast<std::size_t>(part)];
}

std::string html(const std::string& text) {
    std::string out;
    for (const char c : text) {
        switch (c) {
            case '&':
                out += "&amp;";
                break;
            case '<':
                out += "&lt;";
                break;
            case '>':
                out += "&gt;";
                break;
            case '"':
                out += "&quot;";
                break;
            default:
                out += c;
        }
    }
    return out;
}

std::string base64(const std::vector<std::uint8_t>& bytes) {
    static constexpr const char* kSigns = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    std::string out;
    for (std::size_t i = 0; i < bytes.size(); i += 3) {
        std::uint32_t three = 0;
        for (std::size_t k = 0; k < 3; ++k) three = three << 8U | (i + k < bytes.size() ? bytes[i + k] : 0U);
        for (std::size_t k = 0; k < 4; ++k)
            out += i + k <= bytes.size() ? kSigns[three >> (18U - 6U * k) & 63U] : '=';
    }
    return out;
}

constexpr const char* kStyle = R"(<style>
body{font:15px/1.45 system-ui,sans-serif;color:#1c2430;max-width:60em;margin:2em auto;padding:0 1em}
h1{font-size:1.6em;margin:0}h2{font-size:1.15em;margin:1.6em 0 .4em}
.sub{color:#5a6675;margin:.2em 0 1em}.total{font-size:2.6em;font-weight:600}.total small{font-size:.4em;color:#5a6675}
table{border-collapse:collapse;width:100%}td,th{padding:.3em .6em;border-bottom:1px solid #dde3ea;text-align:left}
td.n,th.n{text-align:right;font-variant-numeric:tabular-nums}
.bar{background:#e6ebf1;border-radius:3px;height:.7em;width:12em}.bar i{display:block;background:#2f7fd0;border-radius:3px;height:100%}
.done{color:#1d7f45}.failed{color:#c0322b}.open{color:#8a6d1c}
figure{display:inline-block;margin:0 1% 1em 0;width:48%}figure img{width:100%;border-radius:4px}figcaption{color:#5a6675;font-size:.9em}
@media print{body{margin:0}figure{break-inside:avoid}}
</style>
)";

std::string parts_table(const TrainingScore& score) {
    std::string out = "<table><tr><th>part<th><th class=n>points</tr>\n";
    for (const TrainingPoints& p : score.part)
        out += std::string("<tr><td>") + part_text(p.part) + "<td><div class=bar><i style=\"width:" +
               rounded(p.of > 0.0 ? 100.0 * p.points / p.of : 0.0, 0) + "%\"></i></div><td class=n>" +
               rounded(p.points, 1) + " of " + rounded(p.of, 0) + "</tr>\n";
    return out + "</table>\n";
}

std::string checklist(const TrainingScore& score) {
    std::string out = "<table>\n";
    for (const TrainingItem& i : score.item)
        out += std::string("<tr><td class=") + state_name(i.state) + ">" +
               (i.state == TrainingItem::State::done     ? "&#10003; done"
                : i.state == TrainingItem::State::failed ? "&#10007; failed"
                                                         : "&#9675; open") +
               "<td>" + html(i.name) + "<td class=n>" + html(i.value) + "</tr>\n";
    return out + "</table>\n";
}

std::string performance_table(const json& p) {
    const json force = p.value("force", json::object()), strokes = p.value("strokes", json::object());
    std::string out = "<table>\n";
    const auto row = [&out](const std::string& name, const std::string& value) {
        out += "<tr><td>" + html(name) + "<td class=n>" + html(value) + "</tr>\n";
    };
    row("bone removed", rounded(number(p, "removed_mm3"), 1) + " mm³");
    row("drilling, of it cutting",
        rounded(number(p, "drilling_s"), 0) + " s, " + rounded(number(p, "cutting_s"), 0) + " s");
    row("force while cutting: mean, greatest",
        rounded(number(force, "mean_cutting_n"), 2) + " N, " + rounded(number(force, "max_n"), 2) + " N");
    row("time above " + rounded(number(force, "excess_above_n"), 0) + " N",
        rounded(number(force, "excess_s"), 1) + " s");
    row("strokes: number, mean length, mean speed",
        rounded(number(strokes, "count"), 0) + ", " + rounded(number(strokes, "mean_length_mm"), 1) +
            " mm, " + rounded(number(strokes, "mean_speed_mm_s"), 0) + " mm/s");
    if (p.contains("burr_visible_share") && p["burr_visible_share"].is_number())
        row("burr in sight", rounded(100.0 * number(p, "burr_visible_share"), 0) + " % of the drilling time");
    for (const json& b : p.value("burrs", json::array()))
        row("burr " + rounded(number(b, "diameter_mm"), 1) + " mm " + b.value("grit", "") + " " +
                b.value("shape", ""),
            rounded(number(b, "drilling_s"), 0) + " s, " + rounded(number(b, "removed_mm3"), 1) + " mm³");
    out += "</table>\n";
    std::string structures;
    for (const json& s : p.value("structures", json::array()))
        if (s.value("critical", false))
            structures += "<tr><td>" + html(s.value("name", "")) + "<td class=n>" +
                          (s["nearest_mm"].is_number() ? rounded(number(s, "nearest_mm"), 1) + " mm" : "") +
                          "<td class=n>" + rounded(number(s, "removed_mm3"), 2) + " mm³<td class=n>" +
                          rounded(number(s, "injuries"), 0) + "</tr>\n";
    if (!structures.empty())
        out +=
            "<h2>Critical structures</h2><table><tr><th>structure<th class=n>nearest<th class=n>removed<th "
            "class=n>injuries</tr>\n" +
            structures + "</table>\n";
    return out;
}

std::string pictures(const TrainingSession& s) {
    std::string out;
    for (std::size_t i = 0; i < s.after.size(); ++i)
        for (const auto* const list : {&s.before, &s.after})
            if (i < list->size())
                out += "<figure><img alt=\"" + html((*list)[i].name) + "\" src=\"data:image/png;base64," +
                       base64((*list)[i].png) + "\"><figcaption>" + html((*list)[i].name) +
                       (list == &s.before ? ", before" : ", at the end") + "</figcaption></figure>\n";
    return out.empty() ? out : "<h2>Pictures</h2>\n" + out;
}

}  // namespace

std::string training_page(const TrainingSession& s, const std::vector<std::vector<std::string>>& earlier) {
    std::string page = "<!doctype html>\n<html lang=en><meta charset=utf-8>\n<title>" + html(s.plan->title) +
                       "</title>\n" + kStyle + "<h1>" + html(s.plan->title) + "</h1>\n<p class=sub>" +
                       (s.trainee.empty() ? "" : html(s.trainee) + ", ") + html(s.date) + ", " +
                       html(s.scene) + "</p>\n";
    if (!s.plan->task.empty()) page += "<p>" + html(s.plan->task) + "</p>\n";
    page += "<p class=total>" + rounded(s.score.total, 0) + " <small>of 100 points</small></p>\n";
    page += parts_table(s.score) + "<h2>Checklist</h2>\n" + checklist(s.score) + pictures(s) +
            "<h2>Performance</h2>\n" + performance_table(s.performance);
    if (!earlier.empty()) {
        page +=
            "<h2>Earlier sessions</h2><table><tr><th>date<th class=n>points<th class=n>time<th "
            "class=n>injuries</tr>\n";
        const std::size_t first = earlier.size() > kEarlierMost ? earlier.size() - kEarlierMost : 0;
        for (std::size_t i = first; i < earlier.size(); ++i)
            page += "<tr><td>" + html(earlier[i][kDate]) + "<td class=n>" + html(earlier[i][kPoints]) +
                    "<td class=n>" + html(earlier[i][kTimeS]) + " s<td class=n>" +
                    html(earlier[i][kInjuries]) + "</tr>\n";
        page += "</table>\n";
    }
    return page + "</html>\n";
}

}  // namespace tact
