#include "prep/search/refine_command.hpp"

#include <cstdio>
#include <memory>
#include <nlohmann/json.hpp>

#include "ipc/base/printed.hpp"
#include "ipc/base/units.hpp"
#include "ipc/base/whole_file.hpp"
#include "ipc/scene/fit/refine.hpp"
#include "prep/console/console.hpp"
#include "prep/console/target.hpp"
#include "prep/search/fit_input.hpp"
#include "prep/search/fit_program.hpp"
#include "prep/search/place_scorer.hpp"

namespace tact {
namespace {

constexpr std::size_t kRandomPlaces = 300;

struct RefineRequest {
    FitInput input;
    ServedProgram served;
    std::string objective = "laplacian", json;
    double range_a = 10.0, range_deg = 20.0;
};

const char* ended(RefineEnd end) {
    switch (end) {
        case RefineEnd::converged:
            return "converged";
        case RefineEnd::iterations:
            return "most iterations reached";
        case RefineEnd::cancelled:
            return "cancelled";
        case RefineEnd::no_density:
            return "no density here";
    }
    return "";
}

bool by_correlation(const RefineRequest& request) {
    return request.objective == "laplacian" || request.objective == "correlation-mean";
}

SearchSettings settings_of(const FitData& data, const RefineRequest& request) {
    return {.resolution_m = data.metrics.resolution_m,
            .background = data.metrics.background,
            .laplacian = request.objective == "laplacian",
            .hits_max = 1};
}

// The best place within the range, or the nearest optimum.
RefineResult by_search(const FitData& data, const StructureAt& model, const RefineRequest& request,
                       const Progress& progress) {
    const auto& [name, structure, start] = model;
    SearchSettings settings = settings_of(data, request);
    if (!(request.range_a > 0.0)) return refine_place(data.rest, structure, settings, start);
    settings.near = SearchNear{start, request.range_a * kAngstromM, request.range_deg * kDegreeRad};
    RefineResult result;
    result.score_start = place_score(data.rest, structure, settings, start);
    const SearchHit hit = search(data.rest, structure, settings, progress).hits.at(0);
    result.T_model_body = hit.T_model_body;
    result.score = hit.score;
    result.end = RefineEnd::converged;
    return result;
}

RefineResult refined(const FitData& data, const StructureAt& model, const RefineRequest& request,
                     const Progress& progress) {
    if (by_correlation(request)) return by_search(data, model, request, progress);
    RefineSettings settings;
    settings.goal = request.objective == "density" ? RefineGoal::mean_density : RefineGoal::correlation_zero;
    settings.resolution_m = data.metrics.resolution_m;
    settings.background_sigma = data.metrics.background / data.metrics.sigma;
    return refine(DensityMap(data.rest, data.metrics.background, data.metrics.sigma), model.structure,
                  model.T_model_body, settings);
}

void run_refine(const RefineRequest& request) {
    request.served.apply();
    if (!request.json.empty() && request.json != "-")
        check_target("write the places", request.json, request.input.paths());
    Console console;
    const Progress progress = console.progress();
    report(progress, 0.0, "reading the map");
    const FitData data = read_fit_input(request.input);
    nlohmann::ordered_json json{{"map", request.input.map.path},
                                {"resolution_a", data.metrics.resolution_m / kAngstromM},
                                {"objective", request.objective},
                                {"fixed", request.input.fixed},
                                {"bodies", nlohmann::ordered_json::array()}};
    std::string table;
    for (std::size_t i = 0; i < data.models.size(); ++i) {
        const StructureAt& m = data.models[i];
        const auto count = static_cast<double>(data.models.size());
        const RefineResult r =
            refined(data, m, request,
                    part(progress, static_cast<double>(i) / count, static_cast<double>(i + 1) / count));
        const double moved_a = (r.T_model_body.p_m - m.T_model_body.p_m).norm() / kAngstromM,
                     turned_deg = r.T_model_body.q.angularDistance(m.T_model_body.q) / kDegreeRad;
        nlohmann::ordered_json body{{"model", m.name},
                                    {"score_before", r.score_start},
                                    {"score_after", r.score},
                                    {"moved_a", moved_a},
                                    {"turned_deg", turned_deg},
                                    {"end", ended(r.end)},
                                    {"matrix", matrix_of(m.structure, r.T_model_body)}};
        table +=
            printed("%s: %s %.4f to %.4f, moved %.2f Å, turned %.2f degrees, %s\n", m.name.c_str(),
                    request.objective.c_str(), r.score_start, r.score, moved_a, turned_deg, ended(r.end));
        if (by_correlation(request)) {
            const RandomScores random =
                PlaceScorer(data.rest, m.structure, settings_of(data, request), data.metrics.resolution_m)
                    .random_scores(kRandomPlaces);
            body["z"] = random.z_of(r.score);
            body["random"] = {{"places", random.places},
                              {"mean", random.mean},
                              {"deviation", random.deviation},
                              {"best", random.best}};
            table += printed(
                "  z %.1f: standard deviations above %zu random places in the density, of which the best has "
                "%.4f\n",
                random.z_of(r.score), random.places, random.best);
        }
        json["bodies"].push_back(std::move(body));
    }
    console.clear();
    const std::string text = json.dump(2, ' ', false, nlohmann::json::error_handler_t::replace) + "\n";
    std::fputs(request.json == "-" ? text.c_str() : table.c_str(), stdout);
    if (!request.json.empty() && request.json != "-") write_whole_file(request.json, text);
}

}  // namespace

void set_up_refine(CLI::App& app) {
    const auto request = std::make_shared<RefineRequest>();
    request->input.add_to(app);
    request->input.add_scene_to(app);
    request->served.add_to(app);
    app.add_option(
           "--objective", request->objective,
           "laplacian: correlation about the mean of the Laplacians of the densities; correlation-mean, "
           "correlation-zero: of the densities, about the mean or zero; density: its mean at the atoms, as "
           "the "
           "docking force")
        ->check(CLI::IsMember({"laplacian", "correlation-mean", "correlation-zero", "density"}))
        ->capture_default_str();
    app.add_option("--range-a", request->range_a,
                   "How far away better places are looked for (angstrom); 0: only uphill from the start. The "
                   "objectives density and correlation-zero always go uphill only")
        ->check(CLI::Range(0.0, 100.0))
        ->capture_default_str();
    app.add_option("--range-deg", request->range_deg, "The same for the rotation (degrees)")
        ->check(CLI::Range(0.0, 180.0))
        ->capture_default_str();
    app.add_option("--json", request->json, "Write the places as JSON; -: to standard output")
        ->type_name("FILE");
    app.callback([request] { run_refine(*request); });
}

}  // namespace tact
