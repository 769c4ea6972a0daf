// Fit card: how well the structures, at their current poses, explain the map. Every value states its definition.
#include <array>
#include <string>

#include "gui/dashboard/widgets.hpp"
#include "gui/docking/docking_panels.hpp"
#include "ipc/base/units.hpp"

namespace tact {

namespace {

void metrics(const Theme& theme, const FitMetrics& m, double contour) {
    row(theme, "Correlation", fixed(m.cc_zero, 4), "about zero");
    row(theme, "", fixed(m.cc_mean, 4), "about the mean");
    // With the value in the map's unit if it fits.
    const std::array<std::string, 3> notes{format("%.4g, mean over atoms", m.mean_density),
                                           format("%.2g, mean over atoms", m.mean_density),
                                           std::string("mean over atoms")};
    row(theme, "Density", fixed(m.mean_density_sigma, 2) + " σ", notes);
    const std::array<std::string, 2> inside{format("of atoms above contour %.4g", contour),
                                            std::string("of atoms above contour")};
    row(theme, "Inside", format("%.1f %%", 100.0 * m.fraction_inside), inside);
    row(theme, "Overlap", format("%.4g", m.overlap), "map unit · Z");
}

}  // namespace

void DockingPanels::draw_card(const Theme& theme, const PixelRect& card, DashboardState& /*state*/) const {
    const FitState& f = fit;
    begin_card(theme, "Fit", card);
    if (f.known) {
        ImGui::SameLine(0.0F, theme.px(10.0F));
        text_coloured(colour::kText, f.body_id != 0 ? format("body %u, in the hand", f.body_id)
                                                    : format("all %zu bodies", f.bodies));
    }
    if (f.pose_known)
        row(theme, "Distance",
            format("%.2f Å, %.1f°", f.from_file_m / kAngstromM, f.from_file_rad / kDegreeRad),
            "from file position");
    if (f.known) {
        metrics(theme, f.body_id != 0 ? f.body : f.all, f.contour);
        if (f.body_id != 0 && f.bodies > 1)
            row(theme, "All bodies", fixed(f.all.cc_zero, 4),
                "about zero, " + fixed(f.all.cc_mean, 4) + " mean");
        const FitMetrics& m = f.body_id != 0 ? f.body : f.all;
        if (f.bodies > 1) row(theme, "Clashes", grouped(m.clashes), "atom pairs with other bodies");
        text_small(theme, colour::kDim,
                   format("Region: %s, %s voxels. Simulated at %.1f Å, Gaussians, weight Z.", kFitRegion,
                          grouped(m.region_voxels).c_str(), f.resolution_m / kAngstromM));
    }
    if (!f.status.empty()) text_small(theme, colour::kDim, f.status);
    end_card();
}

}  // namespace tact
