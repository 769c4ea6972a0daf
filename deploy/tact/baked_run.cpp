#include "deploy/tact/baked_run.hpp"

#include <cstdio>

#include "deploy/tact/run.hpp"

namespace tact::launch {
namespace {

// The scene depends on what is in the files, and its note names them.
void add_file_option(CLI::App& app, const PassedOption& option, BakedRun& baked) {
    app.add_option_function<std::vector<std::string>>(
           option.name,
           [to = &baked, name = option.name](const std::vector<std::string>& values) {
               for (const std::string& value : values) {
                   to->files.emplace_back(value);
                   to->prep.insert(to->prep.end(), {name, std::filesystem::absolute(value).string()});
               }
           },
           option.help)
        ->type_name(option.type)
        ->expected(1)
        ->multi_option_policy(CLI::MultiOptionPolicy::TakeAll)
        ->check(CLI::ExistingFile);
}

}  // namespace

void add_demo_run_options(CLI::App& app, BakedRun& baked) { add_baked_run_options(app, {}, baked); }

void add_baked_run_options(CLI::App& app, std::span<const PassedOption> prep, BakedRun& baked) {
    app.add_flag("--bake-only", baked.bake_only, "Bake the scene, print its path and exit");
    for (const PassedOption& option : prep) {
        if (option.file) {
            add_file_option(app, option, baked);
            continue;
        }
        app.add_option_function<std::string>(
               option.name,
               [to = &baked.prep, name = option.name](const std::string& value) {
                   to->insert(to->end(), {name, value});
               },
               option.help)
            ->type_name(option.type);
    }
    add_run_options(app, baked.run);
}

int bake_and_run(BakeRequest request, const BakedRun& baked) {
    request.inputs.insert(request.inputs.end(), baked.files.begin(), baked.files.end());
    const auto scene = baked_scene(request);
    if (scene.empty()) return 130;
    if (!baked.bake_only) return run_scene(scene, baked.run);
    std::puts(scene.c_str());
    return 0;
}

}  // namespace tact::launch
