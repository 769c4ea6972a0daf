#include "gui/window/start_controller.hpp"

#include <algorithm>
#include <nlohmann/json.hpp>
#include <utility>

#include "gui/window/import_progress.hpp"
#include "ipc/base/error.hpp"
#include "ipc/scene/file/scene_switch.hpp"

namespace tact {
namespace {

constexpr std::size_t kTextMost = 400, kDetailMost = 4000;

struct Remark {
    std::string name, says, fix;
    bool fails = false, warns = false;
};

std::string text_of(const nlohmann::json& object, const char* key) {
    const auto found = object.find(key);
    return found != object.end() && found->is_string() ? found->get<std::string>().substr(0, kTextMost)
                                                       : std::string();
}

// Those that are not "ok", failures first; nullopt: not the output of such a program.
std::optional<std::vector<Remark>> remarks_of(std::string_view text, std::vector<Remark>& all) {
    const auto begin = text.find('{');
    if (begin == std::string_view::npos) return std::nullopt;
    const nlohmann::json json = nlohmann::json::parse(text.substr(begin), nullptr, false);
    const auto findings = json.is_object() ? json.find("findings") : json.end();
    if (!json.is_object() || findings == json.end() || !findings->is_array()) return std::nullopt;
    std::vector<Remark> out;
    for (const nlohmann::json& finding : *findings) {
        if (!finding.is_object()) return std::nullopt;
        const std::string level = text_of(finding, "level");
        all.push_back({text_of(finding, "name"), text_of(finding, "says"), text_of(finding, "fix"),
                       level == "fail", level == "warn"});
        if (all.back().fails || all.back().warns) out.push_back(all.back());
    }
    std::stable_sort(out.begin(), out.end(),
                     [](const Remark& a, const Remark& b) { return a.fails && !b.fails; });
    return out;
}

std::string details_of(const std::vector<Remark>& remarks) {
    std::string text;
    for (const Remark& r : remarks) {
        if (text.size() > kDetailMost) break;
        if (!text.empty()) text += "\n";
        text += r.says;
        if (!r.fix.empty()) text += "\n    fix: " + r.fix;
    }
    return text;
}

StartFinding unreadable(const char* command) {
    return {{Grade::watch, std::string("unknown: ") + command + " gave no answer"}, {}};
}

}  // namespace

std::vector<DemoCard> demo_cards() {
    return {{"dock", "Docking",
             "An atomic structure is drawn into an electron density map: feel force and torque."},
            {"touch", "Surface", "Stroke rough terrain: fine detail, friction and the force that answers."},
            {"drill", "Drilling", "Open a temporal bone with a burr, with dust, water, blood and suction."},
            {"train", "Training task", ""},
            {"field", "Electric field", ""}};
}

StartFinding computer_finding(std::string_view json) {
    std::vector<Remark> all;
    const auto remarks = remarks_of(json, all);
    if (!remarks) return unreadable("tact doctor");
    if (remarks->empty()) return {{Grade::good, "ready: tact doctor found nothing to improve"}, {}};
    const std::string first = (*remarks)[0].says;
    const std::string more =
        remarks->size() > 1 ? " (and " + std::to_string(remarks->size() - 1) + " more: tact doctor)" : "";
    if ((*remarks)[0].fails) return {{Grade::bad, first + more}, details_of(*remarks)};
    return {{Grade::watch, "works; the force rate would be steadier with " + std::to_string(remarks->size()) +
                               (remarks->size() == 1 ? " change: tact doctor" : " changes: tact doctor")},
            details_of(*remarks)};
}

StartFinding device_finding(std::string_view json) {
    std::vector<Remark> all;
    const auto remarks = remarks_of(json, all);
    if (!remarks) return unreadable("tact probe");
    const auto device =
        std::find_if(all.begin(), all.end(), [](const Remark& r) { return r.name == "device"; });
    if (device == all.end()) return unreadable("tact probe");
    const Grade grade = device->fails ? Grade::bad : device->warns ? Grade::watch : Grade::good;
    return {{grade, device->says}, device->fix.empty() ? "" : device->says + "\n    fix: " + device->fix};
}

void StartController::examine(StartPageState& page) {
    if (!std::exchange(examined_, true)) {
        page.device.status.text = page.computer.status.text = "examining ...";
        try {
            doctor_.start("tact", {"doctor", "--json"});
            probe_.start("tact", {"probe", "--json"});
        } catch (const StartupError& e) {
            page.computer = {{Grade::bad, e.what()}, {}};
        }
    }
    if (const auto done = doctor_.poll()) page.computer = computer_finding(done->output);
    if (const auto done = probe_.poll()) page.device = device_finding(done->output);
}

void StartController::prepare(StartPageState& page) {
    const std::string wanted = std::exchange(page.demo_wanted, {});
    const bool cancel = std::exchange(page.cancel_wanted, false);
    try {
        if (!wanted.empty() && !demo_.running()) {
            demo_name_ = wanted;
            cancelled_ = false;
            demo_.start("tact", {"demo", wanted, "--bake-only"});
        }
        if (cancel && demo_.running()) {
            cancelled_ = true;
            demo_.cancel();
        }
        const auto done = demo_.poll();
        page.preparing = demo_.running();
        if (page.preparing) {
            const std::string output = demo_.output();
            page.share = share_done(output);
            page.message = {Grade::unknown,
                            "Preparing the demo, once: " +
                                (output.empty() ? std::string("starting") : last_line(output))};
        }
        if (!done) return;
        if (cancelled_) {
            page.message = {Grade::unknown, "Cancelled."};
        } else if (!done->good()) {
            page.message = {Grade::bad, error_text(done->output)};
        } else {
            ask_for_demo(scene_switch_, demo_name_);
            page.message = {Grade::unknown, "Starting ..."};
        }
    } catch (const StartupError& e) {
        page.message = {Grade::bad, e.what()};
    }
}

void StartController::follow(StartPageState& page) {
    examine(page);
    prepare(page);
}

}  // namespace tact
