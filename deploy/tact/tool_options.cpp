#include "deploy/tact/tool_options.hpp"

namespace tact::launch {

void ToolOptions::add_to(BakeRequest& request) const {
    if (tool.empty()) return;
    std::error_code none;
    const bool file = std::filesystem::exists(tool, none);
    if (file) request.inputs.emplace_back(tool);
    request.options.insert(request.options.end(),
                           {"--tool", file ? std::filesystem::absolute(tool).string() : tool});
    request.options.insert(request.options.end(), prep.begin(), prep.end());
}

std::shared_ptr<ToolOptions> add_tool_options(CLI::App& app) {
    const auto o = std::make_shared<ToolOptions>();
    auto* const group = app.add_option_group("Tool", "tool that touches the surface, instead of a ball");
    auto* const tool =
        group
            ->add_option("--tool", o->tool,
                         "mesh that is the tool, in six degrees of freedom with torque; or scaler or block, "
                         "which are made here")
            ->type_name("FILE|NAME");
    for (const auto& [name, type, help] :
         {std::tuple("--tool-unit", "m|cm|mm|um|nm|a", "unit of lengths in the tool's file; default mm"),
          std::tuple("--tool-up", "y|z", "axis of the tool's file that points up; default y"),
          std::tuple("--tool-size-mm", "MM",
                     "length of the tool's diagonal in the hand's space; default: as large against the mesh "
                     "as it is"),
          std::tuple("--tool-points", "N",
                     "number of contact points, evenly over the tool's surface; default 1000"),
          std::tuple(
              "--tool-grip", "middle|origin",
              "point at which the tool is held: middle of its surface (default) or origin of its file")}) {
        group
            ->add_option_function<std::string>(
                name,
                [o, n = std::string(name)](const std::string& v) {
                    o->prep.insert(o->prep.end(), {n, v});
                },
                help)
            ->type_name(type)
            ->needs(tool);
    }
    return o;
}

}  // namespace tact::launch
