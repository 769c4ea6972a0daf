#include "gui/drilling/training/training_plan.hpp"

#include <toml++/toml.h>

#include <algorithm>
#include <cmath>
#include <initializer_list>
#include <optional>

#include "gui/base/toml_keys.hpp"
#include "ipc/base/error.hpp"

namespace tact {
namespace {

namespace fs = std::filesystem;
constexpr const char* kTaskFix = "see the example deploy/training/mastoid.toml";
constexpr double kFarMm = 1e5;
constexpr std::size_t kTextMost = 2000;

class Reader {
public:
    Reader(std::string name, fs::path folder) : name_(std::move(name)), folder_(std::move(folder)) {}

    [[noreturn]] void fail(const toml::node* at, const std::string& why) const {
        const auto line = at != nullptr ? at->source().begin.line : 0;
        throw StartupError("reading the training task '" + name_ + "'" +
                               (line > 0 ? ", line " + std::to_string(line) : std::string()),
                           why, kTaskFix);
    }
    void only(const toml::table& t, std::initializer_list<std::string_view> known) const {
        for (const auto& [key, node] : t)
            if (std::find(known.begin(), known.end(), key.str()) == known.end()) {
                std::string all;
                for (const std::string_view k : known) all += (all.empty() ? "" : ", ") + std::string(k);
                fail(&node, "unknown key '" + std::string(key.str()) + "'; known here: " + all);
            }
    }
    [[nodiscard]] std::string text(const toml::table& t, std::string_view key, bool required) const {
        const toml::node* const node = t.get(key);
        if (node == nullptr) {
            if (required) fail(&t, "'" + std::string(key) + "' is missing");
            return {};
        }
        auto value = node->value_exact<std::string>();
        if (!value || value->size() > kTextMost || (required && value->empty()))
            fail(node, "'" + std::string(key) + "' must be a text of 1 to 2000 characters");
        return *value;
    }
    [[nodiscard]] double number(const toml::table& t, std::string_view key, double otherwise, double low,
                                double high) const {
        const toml::node* const node = t.get(key);
        if (node == nullptr) return otherwise;
        const auto value = node->value<double>();
        if (!value || !(*value >= low && *value <= high))
            fail(node,
                 "'" + std::string(key) + "' must be a number from " + round(low) + " to " + round(high));
        return *value;
    }
    [[nodiscard]] Vec3 place(const toml::table& t, std::string_view key) const {
        const toml::node* const node = t.get(key);
        const toml::array* const list = node != nullptr ? node->as_array() : nullptr;
        if (list == nullptr || list->size() != 3)
            fail(node != nullptr ? node : &t, "'" + std::string(key) + "' must be three numbers (mm)");
        Vec3 place;
        for (std::size_t i = 0; i < 3; ++i) {
            const auto value = (*list)[i].value<double>();
            if (!value || !(std::abs(*value) <= kFarMm))
                fail(node, "'" + std::string(key) + "' must be three numbers (mm)");
            place[static_cast<Eigen::Index>(i)] = *value;
        }
        return place;
    }
    [[nodiscard]] std::optional<TrainingRegion> region(const toml::table& t) const {
        std::optional<TrainingRegion> found;
        const auto one = [&](TrainingRegion::Kind kind) -> TrainingRegion& {
            if (found) fail(&t, "give one of sphere, box, expert and structure");
            found.emplace().kind = kind;
            return *found;
        };
        if (const toml::table* const s = table(t, "sphere")) {
            only(*s, {"centre_mm", "radius_mm"});
            TrainingRegion& r = one(TrainingRegion::Kind::sphere);
            r.a_mm = place(*s, "centre_mm");
            r.radius_mm = number(*s, "radius_mm", 0.0, 0.01, 1e3);
            if (r.radius_mm == 0.0) fail(s, "'radius_mm' is missing");
        }
        if (const toml::table* const b = table(t, "box")) {
            only(*b, {"from_mm", "to_mm"});
            TrainingRegion& r = one(TrainingRegion::Kind::box);
            const Vec3 p = place(*b, "from_mm"), q = place(*b, "to_mm");
            r.a_mm = p.cwiseMin(q);
            r.b_mm = p.cwiseMax(q);
            if (!((r.b_mm - r.a_mm).minCoeff() > 0.0)) fail(b, "the box has no volume");
        }
        if (t.contains("expert")) {
            TrainingRegion& r = one(TrainingRegion::Kind::expert);
            r.expert = text(t, "expert", true);
            if (r.expert.is_relative()) r.expert = folder_ / r.expert;
        }
        if (t.contains("structure")) {
            TrainingRegion& r = one(TrainingRegion::Kind::structure);
            r.structure = text(t, "structure", true);
            r.margin_mm = number(t, "margin_mm", 0.0, 0.0, 20.0);
        } else if (t.contains("margin_mm")) {
            fail(t.get("margin_mm"), "'margin_mm' belongs to a structure");
        }
        return found;
    }
    template <class Take>
    void each(const toml::table& t, std::string_view key, Take&& take) const {
        const toml::node* const node = t.get(key);
        if (node == nullptr) return;
        const toml::array* const list = node->as_array();
        if (list == nullptr || !list->is_array_of_tables())
            fail(node, "write each as a part of its own: [[" + std::string(key) + "]]");
        if (list->size() > TrainingPlan::kRegionsMost)
            fail(node, "more than " + std::to_string(TrainingPlan::kRegionsMost) + " of them");
        for (const toml::node& one : *list) take(*one.as_table());
    }
    [[nodiscard]] const toml::table* table(const toml::table& t, std::string_view key) const {
        const toml::node* const node = t.get(key);
        if (node == nullptr) return nullptr;
        if (node->as_table() == nullptr) fail(node, "'" + std::string(key) + "' must be { ... }");
        return node->as_table();
    }

private:
    static std::string round(double value) {
        char text[32];
        std::snprintf(text, sizeof text, "%.6g", value);
        return text;
    }
    std::string name_;
    fs::path folder_;
};

TrainingPlan plan_of(const toml::table& t, const Reader& in) {
    in.only(t, {"title", "task", "time_s", "frame", "goal", "thin", "forbidden", "points"});
    TrainingPlan plan;
    plan.title = in.text(t, "title", true);
    plan.task = in.text(t, "task", false);
    plan.time_s = in.number(t, "time_s", 0.0, 1.0, 1e5);
    const std::string frame = in.text(t, "frame", false);
    if (!frame.empty() && frame != "scene" && frame != "patient")
        in.fail(t.get("frame"), "'frame' must be \"scene\" or \"patient\"");
    plan.patient = frame == "patient";
    in.each(t, "goal", [&](const toml::table& g) {
        in.only(g, {"name", "sphere", "box", "expert", "share"});
        TrainingGoal goal;
        goal.name = in.text(g, "name", true);
        goal.share = in.number(g, "share", goal.share, 0.01, 1.0);
        const auto region = in.region(g);
        if (!region) in.fail(&g, "a goal needs a sphere, a box or an expert's file");
        goal.region = *region;
        plan.goal.push_back(goal);
    });
    in.each(t, "thin", [&](const toml::table& s) {
        in.only(s, {"structure", "leave_mm", "share"});
        TrainingThin thin;
        thin.structure = in.text(s, "structure", true);
        thin.leave_mm = in.number(s, "leave_mm", thin.leave_mm, 0.1, 10.0);
        thin.share = in.number(s, "share", thin.share, 0.01, 1.0);
        plan.thin.push_back(thin);
    });
    in.each(t, "forbidden", [&](const toml::table& f) {
        in.only(f, {"name", "sphere", "box", "structure", "margin_mm", "most_mm3"});
        TrainingForbidden no;
        const auto region = in.region(f);
        if (!region) in.fail(&f, "a forbidden zone needs a structure, a sphere or a box");
        no.region = *region;
        no.name = in.text(f, "name", no.region.structure.empty());
        if (no.name.empty()) no.name = no.region.structure;
        no.most_mm3 = in.number(f, "most_mm3", no.most_mm3, 0.0, 1e6);
        plan.forbidden.push_back(no);
    });
    if (const toml::table* const points = in.table(t, "points")) {
        in.only(*points, {"goal", "outside", "thin", "structures", "force", "sight", "time"});
        for (std::size_t i = 0; i < plan.points.size(); ++i)
            plan.points[i] = in.number(*points, kTrainingPartNames[i], plan.points[i], 0.0, 1000.0);
    }
    if (plan.goal.empty() && plan.thin.empty())
        in.fail(nullptr, "it has neither a goal nor a structure to thin");
    return plan;
}

}  // namespace

TrainingPlan read_training_plan_text(std::string_view text, const std::string& name, const fs::path& folder) {
    const Reader in(name, folder);
    try {
        return plan_of(toml::parse(text, name), in);
    } catch (const toml::parse_error& e) {
        throw StartupError(
            "reading the training task '" + name + "', line " + std::to_string(e.source().begin.line),
            std::string(e.description()), kTaskFix);
    }
}

TrainingPlan read_training_plan(const fs::path& path) {
    return read_training_plan_text(read_typed_file(path, kTaskFix), path.string(), path.parent_path());
}

}  // namespace tact
