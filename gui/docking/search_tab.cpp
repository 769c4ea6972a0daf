// Search tab: places of the held body in the whole map, or nearby, and the list of what was found.
#include <algorithm>
#include <array>

#include "gui/dashboard/widgets.hpp"
#include "gui/docking/docking_panels.hpp"
#include "ipc/base/units.hpp"

namespace tact {
namespace {

constexpr std::array<const char*, 3> kObjectives{"Laplacian", "density", "mean density"};
constexpr std::array<const char*, 3> kObjectiveHelp{
    "correlation of the Laplacians of map and structure, about the mean: judges the shape",
    "correlation of the densities of map and structure, about the mean",
    "mean density at the atoms, which the hand feels: goes uphill only, finds nothing beyond the next "
    "maximum"};
constexpr int kMeanDensity = 2;
constexpr ImU32 kBar = IM_COL32(38, 84, 124, 255);  // the text on it must be legible

bool button(const char* name, bool enabled, const char* help) {
    ImGui::BeginDisabled(!enabled);
    const bool pressed = ImGui::Button(name);
    ImGui::EndDisabled();
    if (ImGui::IsItemHovered(ImGuiHoveredFlags_AllowWhenDisabled)) ImGui::SetTooltip("%s", help);
    return pressed;
}

void start_row(const Theme& theme, const DashboardState& state, FittingState& f) {
    const BodyState* const held = held_body(f);
    SearchState& s = f.search;
    const bool ready = state.commands() && held != nullptr && !s.running;
    const std::uint32_t id = held != nullptr ? held->id : 0;
    if (button("Search map", ready && s.objective != kMeanDensity,
               held == nullptr ? "take the body to look for into the hand first"
                               : "look for the held body in the whole map, less the density of fixed bodies; "
                                 "seconds to a minute"))
        f.requests.push_back({FitAction::search, id, {}});
    ImGui::SameLine();
    if (button("Refine", ready, "best place of the held body within 10 Å and 20°"))
        f.requests.push_back({FitAction::refine, id, {}});
    ImGui::SameLine(theme.px(152.0F));
    ImGui::Checkbox("Ghosts", &s.ghosts);
    if (ImGui::IsItemHovered()) ImGui::SetTooltip("draw the three places found that are nearest to the body");
    ImGui::SameLine();
    ImGui::BeginDisabled(!s.can_pull && !s.pull);
    ImGui::Checkbox("Pull", &s.pull);
    ImGui::EndDisabled();
    if (ImGui::IsItemHovered(ImGuiHoveredFlags_AllowWhenDisabled))
        ImGui::SetTooltip("%s", s.can_pull ? "draw the body gently, with at most 0.8 N, to the place that it "
                                             "leans to; with Laplacian on "
                                             "(tab Bodies) the hand feels the shape that the search judged by"
                                           : "take a body into the hand for which places were found");
    text_coloured(colour::kDim, "by");
    ImGui::SameLine();
    choose(theme, kObjectives, s.objective);
    if (ImGui::IsItemHovered())
        ImGui::SetTooltip("%s",
                          kObjectiveHelp[static_cast<std::size_t>(std::clamp(s.objective, 0, kMeanDensity))]);
    text_coloured(colour::kDim, "symmetry");
    ImGui::SameLine();
    ImGui::SetNextItemWidth(theme.px(110.0F));
    ImGui::InputTextWithHint("##symmetry", "none", s.symmetry.data(), s.symmetry.size());
    if (ImGui::IsItemHovered())
        ImGui::SetTooltip(
            "%s",
            "symmetry of copies to place, whose axis is found: C7, D3, helix:RISE,TWIST,COPIES in Å and "
            "degrees, or find, to try C2 to C12 and D2 to D7");
    if (!s.found_symmetry.empty() && !s.found.empty() && s.found_body == id) {
        ImGui::SameLine();
        if (button("Place copies", state.commands(),
                   "put the held body and copies of it at all these places; they move together then"))
            f.requests.push_back({FitAction::place_copies, id, {}});
    }
    if (s.subtracted > 0)
        text_small(theme, colour::kDim,
                   format("without the density of %zu other %s", s.subtracted,
                          s.subtracted == 1 ? "body" : "bodies"));
}

void found_list(const Theme& theme, const DashboardState& state, FittingState& f) {
    const SearchState& s = f.search;
    const bool exists = std::any_of(f.bodies.begin(), f.bodies.end(),
                                    [&](const BodyState& b) { return b.id == s.found_body; });
    text_small(
        theme, colour::kText,
        s.place > 0 ? format("Pull of %.2f N to place %u of body %u", s.pull_n, s.place, s.found_body)
        : !s.found_symmetry.empty()
            ? format("%zu copies of body %u by %s", s.found.size(), s.found_body, s.found_symmetry.c_str())
            : format("%zu places of body %u, %s", s.found.size(), s.found_body, s.found_name.c_str()),
        false);
    constexpr auto kFlags =
        ImGuiTableFlags_ScrollY | ImGuiTableFlags_RowBg | ImGuiTableFlags_SizingStretchProp;
    if (!ImGui::BeginTable("##places", 6, kFlags,
                           {0.0F, std::max(ImGui::GetContentRegionAvail().y, theme.px(64.0F))}))
        return;
    ImGui::TableSetupScrollFreeze(0, 1);
    for (const auto& [name, share] : {std::pair{"#", 0.7F},
                                      {"score", 1.2F},
                                      {"z", 0.9F},
                                      {"clashes", 1.4F},
                                      {"away", 1.4F},
                                      {"##keep", 1.0F}})
        ImGui::TableSetupColumn(name, ImGuiTableColumnFlags_WidthStretch, share);
    ImGui::TableHeadersRow();
    for (std::size_t i = 0; i < s.found.size(); ++i) {
        const FoundRow& r = s.found[i];
        ImGui::PushID(static_cast<int>(i));
        ImGui::TableNextRow();
        ImGui::TableNextColumn();
        ImGui::BeginDisabled(!state.commands() || !exists);
        if (ImGui::Selectable(format("%zu", i + 1).c_str(), false,
                              ImGuiSelectableFlags_SpanAllColumns | ImGuiSelectableFlags_AllowItemOverlap))
            f.requests.push_back({FitAction::take_place, s.found_body, {}, i});
        ImGui::EndDisabled();
        if (ImGui::IsItemHovered()) ImGui::SetTooltip("click: move the body there; Undo returns it");
        ImGui::TableNextColumn();
        ImGui::TextUnformatted(fixed(r.score, 3).c_str());
        ImGui::TableNextColumn();
        ImGui::TextUnformatted(fixed(r.z, 1).c_str());
        ImGui::TableNextColumn();
        ImGui::TextUnformatted(grouped(r.clashes).c_str());
        ImGui::TableNextColumn();
        ImGui::TextUnformatted(format("%.1f Å", r.away_m / kAngstromM).c_str());
        ImGui::TableNextColumn();
        ImGui::BeginDisabled(!exists);
        if (ImGui::SmallButton("keep")) f.requests.push_back({FitAction::keep_place, s.found_body, {}, i});
        ImGui::EndDisabled();
        if (ImGui::IsItemHovered())
            ImGui::SetTooltip("keep this place as a snapshot; the body stays where it is");
        ImGui::PopID();
    }
    ImGui::EndTable();
}

}  // namespace

void draw_search_progress(const Theme& theme, FittingState& f) {
    const SearchState& s = f.search;
    ImGui::PushStyleColor(ImGuiCol_PlotHistogram, kBar);
    ImGui::ProgressBar(
        static_cast<float>(s.progress), {ImGui::GetContentRegionAvail().x - theme.px(60.0F), 0.0F},
        format("%s body %u: %.0f %%", s.nearby ? "refining" : "searching", s.running_body, 100.0 * s.progress)
            .c_str());
    ImGui::PopStyleColor();
    ImGui::SameLine();
    if (ImGui::SmallButton("Cancel")) f.requests.push_back({FitAction::cancel, 0, {}});
}

void draw_search_tab(const Theme& theme, const DashboardState& state, FittingState& f) {
    start_row(theme, state, f);
    if (f.search.running) draw_search_progress(theme, f);
    if (!f.message.empty()) text_small(theme, grade_colour(f.message_grade), f.message);
    if (!f.search.found.empty()) found_list(theme, state, f);
}

}  // namespace tact
