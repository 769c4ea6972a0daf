// Names of chains and residues over the 3D view.
//
// Chains    at the backbone atom nearest to the middle of the chain
// Residues  at their backbone atom: those in front of the middle of their body, the nearest first; one that would cover another is left out
// Thread    frame thread
#pragma once

#include <array>
#include <span>
#include <string>
#include <vector>

#include "gui/docking/molecules.hpp"
#include "gui/render/eye_view.hpp"

namespace tact {

enum class LabelKind : std::uint8_t { none, chains, residues };

struct ViewLabel {
    float x = 0.0F, y = 0.0F;  // fraction of the view, from its upper left corner
    Rgb8 colour{};
    std::string text;
};

struct LabelView {
    EyeView eye;
    float width = 1.0F, height = 1.0F;  // of the view, in units of the text
    float nearest_a = 0.0F;             // what is nearer is cut off
};

[[nodiscard]] std::vector<ViewLabel> body_labels(const SceneContent& content,
                                                 std::span<const DrawnBody> bodies, LabelKind kind,
                                                 const LabelView& view);

}  // namespace tact
