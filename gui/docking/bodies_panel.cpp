// Bodies tab: list of bodies (held, fixed, hidden), force options, undo, refine, snapshots, saving.
#include "gui/dashboard/letters.hpp"
#include "gui/dashboard/widgets.hpp"
#include "gui/docking/docking_panels.hpp"
#include "ipc/base/units.hpp"

namespace tact {
namespace {

void list(const Theme& theme, DashboardState& state, FittingState& fitting) {
    const bool live = state.commands();
    const float right = ImGui::GetContentRegionAvail().x;
    for (const BodyState& b : fitting.bodies) {
        ImGui::PushID(static_cast<int>(b.id));
        const ImVec2 at = ImGui::GetCursorScreenPos();
        const float h = ImGui::GetTextLineHeight(), r = theme.px(4.5F);
        ImGui::GetWindowDrawList()->AddCircleFilled({at.x + r, at.y + 0.55F * h}, r, b.colour, 16);
        ImGui::SetCursorScreenPos({at.x + theme.px(14.0F), at.y});
        ImGui::BeginDisabled(!live);
        ImGui::PushStyleColor(ImGuiCol_Text, b.in_hand ? colour::kAccent : colour::kText);
        const float wide = right - theme.px(146.0F);
        const std::string held = b.in_hand ? " (held)" : "", number = format("%u  ", b.id);
        const std::string name =
            number +
            cut_text(ImGui::GetFont(), b.name, wide - ImGui::CalcTextSize((number + held).c_str()).x) + held;
        if (ImGui::Selectable(name.c_str(), b.in_hand, 0, {wide, 0.0F}))
            state.requests.push_back({CommandKind::select_body, 0.0, {}, b.in_hand ? kNoBody : b.id});
        ImGui::PopStyleColor();
        if (ImGui::IsItemHovered())
            ImGui::SetTooltip(
                "%s: %s atoms. Click to hold or release. A click on it in the view holds it too.",
                noted(b.name), grouped(b.atoms).c_str());
        ImGui::SameLine(right - theme.px(106.0F));
        bool fixed = b.fixed, shown = !b.hidden;
        if (ImGui::Checkbox("fixed", &fixed))
            state.requests.push_back({CommandKind::fix_body, fixed ? 1.0 : 0.0, {}, b.id});
        ImGui::EndDisabled();
        ImGui::SameLine(right - theme.px(46.0F));
        if (ImGui::Checkbox("show", &shown)) fitting.hide_requests.emplace_back(b.id, !shown);
        ImGui::PopID();
    }
}

void actions(DashboardState& state, FittingState& f) {
    std::vector<Request>& requests = state.requests;
    AddedStructure& added = state.added;
    const BodyState* const held = held_body(f);
    const std::uint32_t id = held != nullptr ? held->id : 0;
    const float gap = ImGui::GetStyle().ItemSpacing.x;
    const float width = (ImGui::GetContentRegionAvail().x - 3.0F * gap) / 4.0F;
    int column = 0;
    const auto button = [&](const char* name, bool enabled, const char* help) {
        if (column++ % 4 != 0) ImGui::SameLine();
        ImGui::BeginDisabled(!enabled || !state.commands());
        const bool pressed = ImGui::Button(name, {width, 0.0F});
        ImGui::EndDisabled();
        if (ImGui::IsItemHovered(ImGuiHoveredFlags_AllowWhenDisabled)) ImGui::SetTooltip("%s", help);
        return pressed;
    };
    const auto request = [&](FitAction action, const std::string& text = {}) {
        f.requests.push_back({action, id, text});
    };
    const bool takes_back = !f.can_undo && added.can_take_back, adds = !f.can_redo && added.can_add_again;
    if (button("Undo", f.can_undo || takes_back,
               takes_back ? "take back the structure that was added" : "undo the last gesture"))
        takes_back ? static_cast<void>(added.take_back_wanted = true) : request(FitAction::undo);
    if (button("Redo", f.can_redo || adds,
               adds ? "add the structure again that was taken back" : "redo the last gesture"))
        adds ? static_cast<void>(added.add_again_wanted = true) : request(FitAction::redo);
    if (button("Accept", f.can_undo, "accept the current poses; Revert returns to them")) {
        request(FitAction::accept);
        added = {};
    }
    if (button("Revert", f.can_undo, "return to the accepted poses (Esc)")) request(FitAction::revert);
    if (button("Refine", held != nullptr && !f.search.running,
               "best place of the held body nearby, within 10 Å and 20°; the Search tab says by which "
               "objective"))
        request(FitAction::refine);
    if (button("Copy", held != nullptr && f.bodies.size() < kBodiesMax, "copy the held body"))
        request(FitAction::copy);
    if (button("Remove", held != nullptr && f.bodies.size() > 1, "remove the held body from the scene"))
        requests.push_back({CommandKind::remove_body, 0.0, {}, id});
    if (button("Save", !f.saving, "save PDB or mmCIF, matrix and CSV of every body in a new folder"))
        request(FitAction::save);
    ImGui::BeginDisabled(!state.commands());
    if (ImGui::Button("Snapshot", {width, 0.0F}))
        request(FitAction::snapshot, format("snapshot %zu", f.snapshots.size() + 1));
    ImGui::SameLine();
    ImGui::SetNextItemWidth(3.0F * width + 2.0F * gap);
    if (ImGui::BeginCombo("##snapshots", f.snapshots.empty() ? "none yet" : "return to ...")) {
        for (const std::string& name : f.snapshots)
            if (ImGui::Selectable(noted(name))) request(FitAction::restore, name);
        ImGui::EndCombo();
    }
    ImGui::EndDisabled();
}

void options(const Theme& theme, DashboardState& state, const FittingState& f) {
    ImGui::BeginDisabled(!state.commands() || f.building);
    const auto box = [&](const char* name, std::uint32_t bit, CommandKind kind, const char* help) {
        bool on = (f.options & bit) != 0;
        if (ImGui::Checkbox(name, &on)) state.requests.push_back({kind, on ? 1.0 : 0.0, {}});
        if (ImGui::IsItemHovered(ImGuiHoveredFlags_AllowWhenDisabled)) ImGui::SetTooltip("%s", help);
    };
    box("Clash", kDockingClash, CommandKind::set_clash, "bodies repel each other");
    ImGui::SameLine(theme.px(84.0F));
    box("Subtract", kDockingSubtraction, CommandKind::set_subtraction,
        "subtract the density that the other bodies explain");
    ImGui::SameLine(theme.px(178.0F));
    box("Laplacian", kDockingLaplacian, CommandKind::set_laplacian,
        "force from the Laplacian of the map: shape counts more than density");
    ImGui::BeginDisabled(!f.can_bend);
    box("Flexible", kDockingFlexible, CommandKind::set_flexible,
        f.can_bend
            ? "the held body bends along its normal modes into the density; off: it returns to its own shape"
            : "the held body has no normal modes: bake the scene with --modes 12");
    ImGui::EndDisabled();
    ImGui::SameLine(theme.px(84.0F));
    ImGui::BeginDisabled(f.copies == 0);
    box("Together", kDockingTogether, CommandKind::set_together,
        f.copies > 0 ? "copies of the held body that are not fixed move as it does, each in its own axes: "
                       "copies related by a "
                       "symmetry stay so"
                     : "the held body has no copy that is not fixed");
    ImGui::EndDisabled();
    if (f.bent_rmsd_m > 0.0) {
        const double bent_a = f.bent_rmsd_m / kAngstromM;
        ImGui::TextDisabled("%s", f.bends ? format("bent %.1f Å, strain %.0f of %.0f %%", bent_a,
                                                   100.0 * f.strain, 100.0 * f.strain_most)
                                                .c_str()
                                          : format("returns, still bent %.1f Å", bent_a).c_str());
    }
    ImGui::EndDisabled();
    if (f.building) text_small(theme, colour::kWatch, "preparing the density ...");
}

}  // namespace

const BodyState* held_body(const FittingState& f) {
    for (const BodyState& b : f.bodies)
        if (b.in_hand) return &b;
    return nullptr;
}

void draw_bodies_tab(const Theme& theme, DashboardState& state, FittingState& f) {
    list(theme, state, f);
    ImGui::Spacing();
    options(theme, state, f);
    actions(state, f);
    if (f.search.running) draw_search_progress(theme, f);
    if (f.saving) text_small(theme, colour::kDim, "saving ...");
    if (!f.message.empty()) text_small(theme, grade_colour(f.message_grade), f.message);
}

}  // namespace tact
