#include "deploy/tact/baked_run.hpp"

#include <cstdio>

#include "deploy/tact/run.hpp"

namespace tact::launch {

void add_baked_run_options(CLI::App& app, std::span<const PassedOption> prep, BakedRun& baked) {
    app.add_flag("--bake-only", baked.bake_only, "Bake the scene, print its path and exit");
    for (const PassedOption& option : prep)
        app.add_option_function<std::string>(
               option.name,
               [to = &baked.prep, name = option.name](const std::string& value) {
                   to->insert(to->end(), {name, value});
               },
               option.help)
            ->type_name(option.type);
    add_run_options(app, baked.run);
}

int bake_and_run(const BakeRequest& request, const BakedRun& baked) {
    const auto scene = baked_scene(request);
    if (scene.empty()) return 130;
    if (!baked.bake_only) return run_scene(scene, baked.run);
    std::puts(scene.c_str());
    return 0;
}

}  // namespace tact::launch
