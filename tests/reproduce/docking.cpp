#include "tests/reproduce/docking.hpp"

#include <cstdio>

#include "deploy/tact/files.hpp"
#include "ipc/base/error.hpp"
#include "tests/reproduce/draw.hpp"
#include "tests/reproduce/mesh_figures.hpp"

namespace tact::launch {

namespace {

int reproduce(const DockingExperiment& e) {
    std::vector<SummaryRow> rows;
    int exit_code = 0;
    const auto add = [&rows](const std::vector<SummaryRow>& more) {
        rows.insert(rows.end(), more.begin(), more.end());
    };
    if (e.with_meshes) {
        const ScratchFolder scratch;
        std::printf("meshes ...\n");
        try {
            add(mesh_figures(e.out, scratch.path()));
        } catch (const StartupError& error) {
            // The rates do not depend on the meshes, so the experiment continues; table and exit code report the
            // failure.
            std::fprintf(stderr, "tact: %s\n", error.what());
            add({{"3, 4", "meshes", "1250 to 8, 12835 to 200", "NOT MADE", error.what()}});
            exit_code = 1;
        }
    }
    const std::optional<Rates> rates = measure_rates(e.rates);
    if (!rates) return 130;
    write_rates(*rates, e.out);
    add(summary_of(*rates));
    if (e.with_meshes)
        add(adapted_figure(*rates->mesh, static_cast<std::uint32_t>(rates->low.free.vertices_mean), e.out));
    const nlohmann::json report{{"rates", json_of(*rates)}, {"summary", json_of(rows)}};
    write_whole(e.out / "docking.json", report.dump(2) + "\n");
    draw_figures(e.out);
    std::printf("\n%s\nwrote %s and CSV and PNG files in the same folder\n", table_of(rows).c_str(),
                (e.out / "docking.json").c_str());
    return exit_code;
}

}  // namespace

int reproduce_docking(const DockingExperiment& experiment) {
    // Checks now that the folder is writable, not after two minutes.
    write_whole(experiment.out / ".writable", "");
    std::filesystem::remove(experiment.out / ".writable");
    return in_own_session([&](Precedence reached) {
        DockingExperiment e = experiment;
        e.rates.precedence = reached;
        return reproduce(e);
    });
}

}  // namespace tact::launch
