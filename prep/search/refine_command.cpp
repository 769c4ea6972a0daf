#include "prep/search/refine_command.hpp"

#include <cstdio>
#include <memory>
#include <nlohmann/json.hpp>

#include "ipc/base/units.hpp"
#include "ipc/base/whole_file.hpp"
#include "ipc/scene/fit/refine.hpp"
#include "prep/console/console.hpp"
#include "prep/console/target.hpp"
#include "prep/search/fit_input.hpp"
#include "prep/search/search.hpp"

namespace tact {
namespace {

struct RefineRequest {
    FitInput input;
    std::string objective = "density", json;
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

RefineResult refined(const FitData& data, const Structure& structure, const std::string& objective,
                     const RefineProgress& progress) {
    if (objective == "laplacian")
        return refine_place(
            data.rest, structure,
            {.resolution_m = data.metrics.resolution_m, .background = data.metrics.background},
            structure.home(), progress);
    RefineSettings settings;
    settings.goal = objective == "density"            ? RefineGoal::mean_density
                    : objective == "correlation-zero" ? RefineGoal::correlation_zero
                                                      : RefineGoal::correlation_mean;
    settings.resolution_m = data.metrics.resolution_m;
    settings.background_sigma = data.metrics.background / data.metrics.sigma;
    return refine(DensityMap(data.rest, data.metrics.background, data.metrics.sigma), structure,
                  structure.home(), settings, progress);
}

void run_refine(const RefineRequest& request) {
    if (!request.json.empty() && request.json != "-")
        check_target("write the places", request.json, request.input.paths());
    Console console;
    const Progress progress = console.progress();
    report(progress, 0.0, "reading the map");
    const FitData data = read_fit_input(request.input);
    nlohmann::ordered_json json{{"map", request.input.map},
                                {"resolution_a", data.metrics.resolution_m / kAngstromM},
                                {"objective", request.objective},
                                {"fixed", request.input.fixed},
                                {"bodies", nlohmann::ordered_json::array()}};
    std::string table;
    for (std::size_t i = 0; i < data.models.size(); ++i) {
        const Structure& s = data.models[i];
        const RefineResult r = refined(data, s, request.objective, [&](std::uint32_t, double) {
            report(progress, static_cast<double>(i) / static_cast<double>(data.models.size()), "refining");
            return true;
        });
        const double moved_a = (r.T_model_body.p_m - s.home_com_model_m).norm() / kAngstromM,
                     turned_deg = r.T_model_body.q.angularDistance(Quat::Identity()) / kDegreeRad;
        json["bodies"].push_back({{"model", request.input.models[i]},
                                  {"score_before", r.score_start},
                                  {"score_after", r.score},
                                  {"moved_a", moved_a},
                                  {"turned_deg", turned_deg},
                                  {"iterations", r.iterations},
                                  {"end", ended(r.end)},
                                  {"matrix", matrix_of(s, r.T_model_body)}});
        char line[400];
        std::snprintf(line, sizeof line, "%s: %s %.4f to %.4f, moved %.2f Å, turned %.2f degrees, %s\n",
                      request.input.models[i].c_str(), request.objective.c_str(), r.score_start, r.score,
                      moved_a, turned_deg, ended(r.end));
        table += line;
    }
    console.clear();
    const std::string text = json.dump(2, ' ', false, nlohmann::json::error_handler_t::replace) + "\n";
    std::fputs(request.json == "-" ? text.c_str() : table.c_str(), stdout);
    if (!request.json.empty() && request.json != "-") write_whole_file(request.json, text);
}

}  // namespace

void add_refine(CLI::App& app) {
    const auto request = std::make_shared<RefineRequest>();
    CLI::App* const command = app.add_subcommand(
        "refine",
        "Move structures from the positions of their files to the nearest optimum of their fit to a map");
    request->input.add_to(*command);
    command
        ->add_option("--objective", request->objective,
                     "density: its mean at the atoms, as the docking force; correlation-zero, "
                     "correlation-mean: of the "
                     "simulated density, about zero or the mean; laplacian: of the Laplacians, as the search")
        ->check(CLI::IsMember({"density", "correlation-zero", "correlation-mean", "laplacian"}))
        ->capture_default_str();
    command->add_option("--json", request->json, "Write the places as JSON; -: to standard output")
        ->type_name("FILE");
    command->callback([request] { run_refine(*request); });
}

}  // namespace tact
