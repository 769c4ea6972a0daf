// A run of a docking scene: bodies and fit in the report, offset of the active body in the table, --save.
#include <algorithm>
#include <array>
#include <cstdio>
#include <nlohmann/json.hpp>
#include <optional>

#include "deploy/tact/docking/docking.hpp"
#include "deploy/tact/docking/places.hpp"
#include "deploy/tact/docking/save_fit.hpp"
#include "deploy/tact/observer.hpp"
#include "ipc/base/error.hpp"
#include "ipc/base/units.hpp"

namespace tact::launch {
namespace {

using nlohmann::json;

json offset_json(const Offset& o) { return {{"offset_a", o.distance_a}, {"angle_deg", o.angle_deg}}; }

json fit_numbers(const Places& places, const std::vector<BodyAt>& bodies, const BodyAt& judged) {
    json j = offset_json(places.offset(judged));
    const FitMetrics fit = places.fit(bodies);
    j["cc_zero"] = fit.cc_zero;
    j["cc_mean"] = fit.cc_mean;
    j["mean_density_sigma"] = fit.mean_density_sigma;
    j["fraction_inside"] = fit.fraction_inside;
    j["region_voxels"] = fit.region_voxels;
    return j;
}

std::optional<std::vector<BodyAt>> bodies_of(const RtRegion& region, const Places& places) {
    const auto topic = newest(region.bodies);
    const auto shapes = newest(region.shapes);
    return topic ? places.bodies(*topic, shapes ? &*shapes : nullptr) : std::nullopt;
}

// The format that tact-rt --poses reads.
json bodies_report(const RtRegion& region, const Places& places) {
    const auto bodies = bodies_of(region, places);
    if (!bodies) return nullptr;
    json all = json::array();
    for (const BodyAt& b : *bodies) {
        const Vec3 p_a = b.T_model_body.p_m / kAngstromM;
        const Quat& q = b.T_model_body.q;
        json j = offset_json(places.offset(b));
        j["id"] = b.id;
        j["structure"] = b.structure;
        j["name"] = places.structures()[b.structure].name;
        j["pos_model_a"] = {p_a.x(), p_a.y(), p_a.z()};
        j["quat_model_body_xyzw"] = {q.x(), q.y(), q.z(), q.w()};
        j["fixed"] = b.fixed;
        j["in_hand"] = b.in_hand;
        if (!b.amplitude_m.empty()) {
            j["mode_amplitudes_a"] = amplitudes_json(b.amplitude_m);
            j["bent_rmsd_a"] = Eigen::Map<const Eigen::VectorXf>(
                                   b.amplitude_m.data(), static_cast<Eigen::Index>(b.amplitude_m.size()))
                                   .cast<double>()
                                   .norm() /
                               kAngstromM;
        }
        all.push_back(j);
    }
    return all;
}

// Offsets: of the body in the hand, else of the first body. Fit: of all bodies together.
json fit_report(const RtRegion& region, const Places& places,
                const std::optional<std::vector<BodyAt>>& bodies_start) {
    const auto bodies = bodies_of(region, places);
    if (!bodies || bodies->empty()) return nullptr;
    const auto in_hand =
        std::find_if(bodies->begin(), bodies->end(), [](const BodyAt& b) { return b.in_hand; });
    const BodyAt judged = in_hand != bodies->end() ? *in_hand : bodies->front();
    json j = fit_numbers(places, *bodies, judged);
    j["body"] = places.structures()[judged.structure].name;
    j["body_id"] = judged.id;
    j["region"] = kFitRegion;
    j["resolution_a"] = places.meta().resolution_m * 1e10;
    j["voxel_a"] = places.grid().spacing_m.maxCoeff() * 1e10;
    if (bodies_start) {
        const auto& start = *bodies_start;
        const auto same =
            std::find_if(start.begin(), start.end(), [&](const BodyAt& b) { return b.id == judged.id; });
        if (same != start.end()) j["at_start"] = fit_numbers(places, start, *same);
    }
    const std::vector<BodyAt> file = places.file_bodies();
    j["at_file_place"] = fit_numbers(places, file, file[judged.structure]);
    return j;
}

class DockingRun final : public SystemRun {
public:
    explicit DockingRun(const SceneFile& scene)
        : places_(scene), has_sources_(structures_have_sources(scene)), name_(scene.name()) {}

    void watch(const RtRegion& region) override {
        if (!bodies_start_) bodies_start_ = bodies_of(region, places_);
    }

    void sample(const RtRegion& region, Sample& sample) const override {
        sample.heading = "   offset from the file";
        const auto topic = newest(region.bodies);
        const auto all = topic ? places_.bodies(*topic) : std::nullopt;
        if (!all || topic->active >= all->size()) return;
        const Offset offset = places_.offset((*all)[topic->active]);
        sample.own = {{"offset_a", offset.distance_a, 4}, {"angle_deg", offset.angle_deg, 4}};
        std::array<char, 64> text{};
        std::snprintf(text.data(), text.size(), "   %7.2f A %6.2f deg", offset.distance_a, offset.angle_deg);
        sample.line_end = text.data();
    }

    void report(const RtRegion& region, json& report) const override {
        report["bodies"] = bodies_report(region, places_);
        report["fit"] = fit_report(region, places_, bodies_start_);
    }

    void check_save(const std::filesystem::path& folder) const override {
        check_save_folder(folder);
        if (!has_sources_)
            throw StartupError(
                "saving to " + folder.string(),
                "the scene " + name_ +
                    " does not name the files of its structures: it is synthetic, or baked by an "
                    "older tact-prep",
                "run the scene without --save, or dock files: tact dock MAP MODEL --save DIR");
    }

    // Saves the last poses published by the controller, however it ended.
    void save(const RtRegion* region, const SaveRequest& request, Signals& signals) const override {
        const auto bodies = region != nullptr ? newest(region->bodies) : std::nullopt;
        const auto shapes = region != nullptr ? newest(region->shapes) : std::nullopt;
        const json poses =
            bodies ? poses_json(*bodies, shapes ? &*shapes : nullptr, places_.structures()) : json::object();
        if (!poses.contains("bodies") || poses["bodies"].empty())
            throw StartupError("saving to " + request.folder.string(),
                               "the controller did not publish poses of the bodies",
                               "see the messages of tact-rt above");
        save_fit(request, poses, signals);
    }

private:
    Places places_;
    std::optional<std::vector<BodyAt>> bodies_start_;  // when the controller was first seen
    bool has_sources_;
    std::string name_;
};

}  // namespace

std::unique_ptr<SystemRun> open_docking_run(const SceneFile& scene) {
    return std::make_unique<DockingRun>(scene);
}

std::string docking_summary(const json& r) {
    std::string text;
    std::array<char, 512> line{};
    const auto add = [&](const char* format, auto... values) {
        std::snprintf(line.data(), line.size(), format, values...);
        text += line.data();
    };
    const auto number = [](const json& j) { return j.is_number() ? j.get<double>() : 0.0; };
    if (r.contains("fit") && r["fit"].is_object()) {
        const json& f = r["fit"];
        if (f.contains("at_start"))
            add("structure: offset from the position in its file: %.2f A, %.1f deg at the start, %.2f A, "
                "%.1f deg at the end\n",
                number(f["at_start"]["offset_a"]), number(f["at_start"]["angle_deg"]), number(f["offset_a"]),
                number(f["angle_deg"]));
        add("fit: correlation about zero %.4f, about the mean %.4f (at the position in the file: %.4f, "
            "%.4f; %s)\n",
            number(f["cc_zero"]), number(f["cc_mean"]), number(f["at_file_place"]["cc_zero"]),
            number(f["at_file_place"]["cc_mean"]), kFitRegion);
    }
    return text;
}

}  // namespace tact::launch
