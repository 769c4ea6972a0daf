#include "prep/search/search_command.hpp"

#include <chrono>
#include <cstdio>
#include <memory>

#include "ipc/base/units.hpp"
#include "ipc/base/whole_file.hpp"
#include "prep/console/console.hpp"
#include "prep/console/target.hpp"
#include "prep/search/fit_input.hpp"
#include "prep/search/fit_program.hpp"
#include "prep/search/place_symmetric.hpp"
#include "prep/search/place_together.hpp"
#include "prep/search/search_report.hpp"

namespace tact {
namespace {

struct SearchRequest {
    FitInput input;
    ServedProgram served;
    std::string objective = "laplacian", json, csv;
    std::size_t rotations_max = 4000, hits_max = 20;
    unsigned threads = 0;
    bool together = false;
    std::string symmetry;  // of copies
};

double seconds_since(std::chrono::steady_clock::time_point begin) {
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
}

// Measured in the map as it is. Copies clash with each other too.
void measure(SearchedModel& m, const FitData& data) {
    for (const SearchHit& hit : m.found.hits) {
        const PlacedStructure alone{&m.structure, hit.T_model_body};
        m.cc_about_mean.push_back(fit_metrics(data.grid, {&alone, 1}, data.metrics).cc_mean);
        std::vector<PlacedStructure> all = data.placed();
        all.insert(all.begin(), alone);
        if (m.copies)
            for (const SearchHit& other : m.found.hits)
                if (&other != &hit) all.push_back({&m.structure, other.T_model_body});
        m.clashes.push_back(count_clashes(all).pairs_of[0]);
    }
}

SearchReport search_files(const SearchRequest& request, const Progress& progress) {
    const std::vector<Symmetry> symmetries =
        request.symmetry.empty() ? std::vector<Symmetry>{} : symmetries_of(request.symmetry);
    report(progress, 0.0, "reading the map");
    const FitData data = read_fit_input(request.input);
    const SearchSettings settings{.resolution_m = data.metrics.resolution_m,
                                  .background = data.metrics.background,
                                  .laplacian = request.objective == "laplacian",
                                  .rotations_max = request.rotations_max,
                                  .hits_max = request.hits_max,
                                  .threads = request.threads};
    SearchReport out{request.input.map.path,
                     request.objective,
                     settings.resolution_m / kAngstromM,
                     request.input.fixed,
                     {}};
    const std::size_t models = data.models.size();
    for (std::size_t i = 0; i < models; ++i) {
        SearchedModel& m = out.models.emplace_back();
        m.model = data.models[i].name;
        m.structure = data.models[i].structure;
        if (request.together) continue;
        const auto begin = std::chrono::steady_clock::now();
        const auto count = static_cast<double>(models);
        const Progress own =
            part(progress, static_cast<double>(i) / count, static_cast<double>(i + 1) / count);
        if (symmetries.empty()) {
            m.found = search(data.rest, m.structure, settings, own);
        } else {
            m.copies = place_symmetric(data.rest, m.structure, symmetries, settings, own);
            m.found = m.copies->found;
        }
        m.seconds = seconds_since(begin);
    }
    if (request.together) {
        const auto begin = std::chrono::steady_clock::now();
        std::vector<Structure> structures;
        for (const SearchedModel& m : out.models) structures.push_back(m.structure);
        PlacedTogether together = place_together(data.rest, structures, settings, progress);
        for (std::size_t i = 0; i < models; ++i) out.models[i].found = std::move(together.found[i]);
        out.together_correlation = together.correlation;
        for (SearchedModel& m : out.models) m.seconds = seconds_since(begin);
    }
    for (SearchedModel& m : out.models) measure(m, data);
    return out;
}

void run_search(const SearchRequest& request) {
    request.served.apply();
    const std::vector<std::string> inputs = request.input.paths();
    for (const std::string& path : {request.json, request.csv})
        if (!path.empty() && path != "-") check_target("write the hits", path, inputs);
    Console console;
    const SearchReport found = search_files(request, console.progress());
    console.clear();
    const auto put = [](const std::string& path, const std::string& text) {
        if (path == "-")
            std::fputs(text.c_str(), stdout);
        else if (!path.empty())
            write_whole_file(path, text);
    };
    if (request.json != "-" && request.csv != "-") std::fputs(as_table(found).c_str(), stdout);
    put(request.json, as_json(found).dump(2, ' ', false, nlohmann::json::error_handler_t::replace) + "\n");
    put(request.csv, as_csv(found));
}

}  // namespace

void set_up_search(CLI::App& app) {
    const auto request = std::make_shared<SearchRequest>();
    request->input.add_to(app);
    request->input.add_scene_to(app);
    request->served.add_to(app);
    app.add_option("--objective", request->objective,
                   "Correlation about the mean of the Laplacians of the densities, or of the densities")
        ->check(CLI::IsMember({"laplacian", "density"}))
        ->capture_default_str();
    CLI::Option* const together =
        app.add_flag("--together", request->together,
                     "Place all models in one map, so that together they explain it best");
    app.add_option(
           "--symmetry", request->symmetry,
           "Place copies of each model, related by this symmetry: C7, D3, helix:RISE,TWIST,COPIES (angstrom, "
           "degrees), or find, to try C2 to C12 and D2 to D7; its axis is found")
        ->type_name("NAME")
        ->excludes(together);
    app.add_option("--hits", request->hits_max, "Number of places per model")
        ->check(CLI::Range(1, 1000))
        ->capture_default_str();
    app.add_option(
           "--orientations-max", request->rotations_max,
           "Largest number of orientations; a model that needs more is searched at a coarser resolution")
        ->check(CLI::Range(500, 100'000))
        ->capture_default_str();
    app.add_option("--threads", request->threads, "Number of threads; 0: one per processor")
        ->check(CLI::Range(0, 256))
        ->capture_default_str();
    app.add_option("--json", request->json, "Write the hits as JSON; -: to standard output")
        ->type_name("FILE");
    app.add_option("--csv", request->csv, "Write the best hit of each model as CSV; -: to standard output")
        ->type_name("FILE");
    app.callback([request] { run_search(*request); });
}

}  // namespace tact
