#include "deploy/tact/surface/tool_options.hpp"

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
    auto* const group = app.add_option_group("Tool", "Tool that touches the surface, instead of a ball");
    auto* const tool =
        group
            ->add_option(
                "--tool", o->tool,
                "Tool with six degrees of freedom and torque: a mesh file, or the synthetic scaler or "
                "block; default: a ball")
            ->type_name("FILE|NAME");
    for (const auto& [name, type, help] :
         {std::tuple("--tool-unit", "m|cm|mm|um|nm|a", "Unit of length in the tool's file; default mm"),
          std::tuple("--tool-up", "y|z", "Axis of the tool's file that points up; default y"),
          std::tuple("--tool-size-mm", "MM",
                     "Length of the tool's diagonal in the workspace (mm); default: the scale of the mesh"),
          std::tuple("--tool-points", "N",
                     "Number of contact points, distributed evenly over the tool's surface; default 1000"),
          std::tuple(
              "--tool-grip", "middle|origin",
              "Grip point of the tool: middle of the surface, or origin of the file; default middle")}) {
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
