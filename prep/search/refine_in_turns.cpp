#include "prep/search/refine_in_turns.hpp"

#include "ipc/scene/fit/refine.hpp"
#include "prep/map/low_pass.hpp"

namespace tact {

void refine_in_turns(const DensityGrid& map, double background, double resolution_m,
                     std::vector<PlacedStructure>& placed, int turns) {
    DensityGrid own = map;
    for (float& v : own.values) v -= static_cast<float>(background);
    std::vector<std::vector<float>> simulated;
    for (const PlacedStructure& p : placed) simulated.push_back(simulated_map(map, {&p, 1}, resolution_m));
    std::vector<float> sum(map.count(), 0.0F);
    for (const auto& one : simulated)
        for (std::size_t v = 0; v < sum.size(); ++v) sum[v] += one[v];
    DensityGrid rest = own;
    for (int turn = 0; turn < turns; ++turn)
        for (std::size_t i = 0; i < placed.size(); ++i) {
            double with_map = 0.0, with_itself = 0.0;
            for (std::size_t v = 0; v < sum.size(); ++v) {
                with_map += static_cast<double>(sum[v]) * static_cast<double>(own.values[v]);
                with_itself += static_cast<double>(sum[v]) * static_cast<double>(sum[v]);
            }
            if (!(with_map > 0.0 && with_itself > 0.0)) return;
            const auto scale = static_cast<float>(with_map / with_itself);
            for (std::size_t v = 0; v < sum.size(); ++v)
                rest.values[v] = own.values[v] - scale * (sum[v] - simulated[i][v]);
            const DensityMap felt(low_pass(rest, 0.0, resolution_m), 0.0, 1.0);
            placed[i].T_model_body = refine(felt, *placed[i].structure, placed[i].T_model_body).T_model_body;
            for (std::size_t v = 0; v < sum.size(); ++v) sum[v] -= simulated[i][v];
            simulated[i] = simulated_map(map, {&placed[i], 1}, resolution_m);
            for (std::size_t v = 0; v < sum.size(); ++v) sum[v] += simulated[i][v];
        }
}

}  // namespace tact
