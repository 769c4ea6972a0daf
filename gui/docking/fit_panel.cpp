// Fit card: how well the structures, at their current poses, explain the map. Every value states its definition.
#include <array>
#include <string>

#include "gui/dashboard/widgets.hpp"
#include "gui/docking/docking_panels.hpp"
#include "ipc/base/units.hpp"

namespace tact {

namespace {

// About zero and about the mean.
void correlations(const Theme& theme, const char* what, const FitMetrics& m) {
    const std::array<std::string, 2> notes{"about zero, " + fixed(m.cc_mean, 4) + " mean",
                                           "zero, " + fixed(m.cc_mean, 4) + " mean"};
    row(theme, what, fixed(m.cc_zero, 4), notes);
    if (ImGui::IsItemHovered())
        ImGui::SetTooltip("correlation of map and simulated map about zero %.4f, about the mean %.4f",
                          m.cc_zero, m.cc_mean);
}

void metrics(const Theme& theme, const FitMetrics& m, double contour) {
    correlations(theme, "Correlation", m);
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
    begin_card(theme, "Fit", card, true);
    if (f.known) {
        ImGui::SameLine(0.0F, theme.px(10.0F));
        text_coloured(colour::kText, f.body_id != 0 ? format("body %u, in the hand", f.body_id)
                                                    : format("all %zu bodies", f.bodies));
        if (!f.status.empty()) {
            ImGui::SameLine(0.0F, theme.px(8.0F));
            text_coloured(colour::kDim,
                          cut_text(ImGui::GetFont(), f.status, ImGui::GetContentRegionAvail().x));
        }
    }
    if (f.pose_known) {
        static const std::array<std::string, 3> kFrom{"from file position", "from file", ""};
        row(theme, "Distance",
            format("%.2f Å, %.1f°", f.from_file_m / kAngstromM, f.from_file_rad / kDegreeRad), kFrom);
    }
    if (f.known) {
        metrics(theme, f.body_id != 0 ? f.body : f.all, f.contour);
        if (f.body_id != 0 && f.bodies > 1) correlations(theme, "All bodies", f.all);
        const FitMetrics& m = f.body_id != 0 ? f.body : f.all;
        if (f.bodies > 1) row(theme, "Clashes", grouped(m.clashes), "atom pairs with other bodies");
        text_small(theme, colour::kDim,
                   format("Region: %s voxels. Simulated at %.1f Å.", grouped(m.region_voxels).c_str(),
                          f.resolution_m / kAngstromM));
        if (ImGui::IsItemHovered())
            ImGui::SetTooltip("Region: %s. Simulated with Gaussians of weight Z.", kFitRegion);
    } else if (!f.status.empty()) {
        text_small(theme, colour::kDim, f.status);
    }
    end_card();
}

}  // namespace tact
