#include "prep/modes/bake_modes.hpp"

#include <cstdio>

#include "ipc/scene/density/normal_modes.hpp"
#include "prep/modes/elastic_network.hpp"

namespace tact {

std::vector<std::string> bake_modes(const std::vector<Structure>& structures, std::uint32_t count,
                                    SceneWriter& out, const Progress& progress) {
    std::vector<std::string> lines;
    if (count == 0) return lines;
    for (std::size_t i = 0; i < structures.size(); ++i) {
        const auto all = static_cast<double>(structures.size());
        const NormalModes modes =
            elastic_modes(structures[i], count,
                          part(progress, static_cast<double>(i) / all, static_cast<double>(i + 1) / all));
        char line[200];
        if (modes.count() == 0) {
            std::snprintf(line, sizeof line, "normal modes of body %zu: none, it has fewer than %zu residues",
                          i, kNodesMin);
        } else {
            std::snprintf(
                line, sizeof line,
                "normal modes of body %zu: %u of %zu residues, the last one %.1f times as stiff as the first",
                i, modes.count(), modes.nodes(), static_cast<double>(modes.stiffness.back()));
        }
        lines.emplace_back(line);
        write_modes(out, static_cast<std::uint32_t>(i), modes);
    }
    return lines;
}

}  // namespace tact
