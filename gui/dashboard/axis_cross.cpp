#include "gui/dashboard/axis_cross.hpp"

#include <algorithm>

namespace tact {

std::vector<AxisEnd> axis_cross(const float (&eye_axes)[3][3], const SceneState& scene) {
    static constexpr const char* kScene[3] = {"x", "y", "z"};
    static constexpr const char* kPositive[3] = {"L", "P", "H"};
    static constexpr const char* kNegative[3] = {"R", "A", "F"};
    std::vector<AxisEnd> ends;
    for (int i = 0; i < 3; ++i) {
        float e[3] = {0.0F, 0.0F, 0.0F};
        for (int k = 0; k < 3; ++k)
            for (int a = 0; a < 3; ++a)
                e[k] += (scene.patient ? scene.patient_axes[i][a] : a == i ? 1.0F : 0.0F) * eye_axes[a][k];
        ends.push_back({scene.patient ? kPositive[i] : kScene[i], i, false, e[0], e[1], e[2]});
        if (scene.patient) ends.push_back({kNegative[i], i, true, -e[0], -e[1], -e[2]});
    }
    std::sort(ends.begin(), ends.end(), [](const AxisEnd& a, const AxisEnd& b) { return a.depth < b.depth; });
    return ends;
}

}  // namespace tact
