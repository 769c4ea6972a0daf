// Fit: how well the structures, where they are now, explain the map. Every number says how it is defined.
#include "gui/panels/panels.hpp"
#include "gui/panels/widgets.hpp"
#include "ipc/base/units.hpp"

namespace tact {

void draw_fit(const Theme& theme, const DashboardState& state, const PixelRect& card) {
    begin_card(theme, "Fit", card);
    const FitFacts& f = state.fit;
    if (f.pose_known)
        row(theme, "Distance",
            format("%.2f Å, %.1f°", f.from_file_m / kAngstromM, f.from_file_rad / kDegreeRad),
            "from file position");
    if (f.known) {
        row(theme, "Correlation", format("%.4f", f.cc_zero), "about zero");
        row(theme, "", format("%.4f", f.cc_mean), "about the mean");
        row(theme, "Density", format("%.2f σ", f.mean_density_sigma), "mean over atoms");
        row(theme, "Inside", format("%.1f %%", 100.0 * f.fraction_inside), "of atoms above contour");
        text_small(theme, colour::kDim,
                   format("Region: %s, %s voxels. Simulated at %.1f Å%s, Gaussians, weight Z.", f.region,
                          grouped(f.region_voxels).c_str(), f.resolution_m / kAngstromM,
                          f.resolution_assumed ? " (assumed: 3 voxels)" : ""));
    }
    if (!f.status.empty()) text_small(theme, colour::kDim, f.status);
    end_card();
}

}  // namespace tact
