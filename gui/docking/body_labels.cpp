#include "gui/docking/body_labels.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "gui/docking/docking_content.hpp"
#include "gui/render/scene_frame.hpp"

namespace tact {
namespace {

constexpr std::size_t kLabelsMax = 160;
constexpr float kLetterWide = 8.0F, kLineHigh = 17.0F;

struct Anchor {
    std::size_t atom = 0;
    std::uint16_t chain = 0;
};

Eigen::Vector3f backbone_place_a(const Structure& s, std::size_t atom) {
    return kSceneAPerM * Eigen::Vector3f(s.x_m[atom], s.y_m[atom], s.z_m[atom]);
}

// The backbone atom of each chain that is nearest to the mean of all of them.
std::vector<Anchor> chain_anchors(const Structure& s) {
    std::vector<Eigen::Vector3f> sum(s.chain_names.size(), Eigen::Vector3f::Zero());
    std::vector<std::size_t> count(sum.size(), 0);
    for (std::size_t i = 0; i < s.size(); ++i) {
        if (s.trace[i] == 0 || s.chain[i] >= sum.size()) continue;
        sum[s.chain[i]] += backbone_place_a(s, i);
        ++count[s.chain[i]];
    }
    std::vector<float> least(sum.size(), std::numeric_limits<float>::max());
    std::vector<Anchor> of_chain(sum.size());
    for (std::size_t i = 0; i < s.size(); ++i) {
        if (s.trace[i] == 0 || s.chain[i] >= sum.size()) continue;
        const std::uint16_t c = s.chain[i];
        const float away = (backbone_place_a(s, i) - sum[c] / static_cast<float>(count[c])).squaredNorm();
        if (away >= least[c]) continue;
        least[c] = away;
        of_chain[c] = {i, c};
    }
    std::vector<Anchor> anchors;
    for (std::size_t c = 0; c < of_chain.size(); ++c)
        if (count[c] > 0) anchors.push_back(of_chain[c]);
    return anchors;
}

std::vector<Anchor> residue_anchors(const Structure& s) {
    std::vector<Anchor> anchors;
    for (std::size_t i = 0; i < s.size(); ++i)
        if (s.trace[i] != 0 && s.chain[i] < s.chain_names.size()) anchors.push_back({i, s.chain[i]});
    return anchors;
}

struct Placed {
    ViewLabel label;
    float distance_a = 0.0F;
};

void add_labels(const SceneContent& content, const DrawnBody& body, LabelKind kind, const LabelView& view,
                std::vector<Placed>& out) {
    const DockingContent& docking = docking_of(content);
    const Structure& straight = docking.bodies[body.structure];
    const NormalModes& modes = docking.modes_of(body.structure);
    const bool bends = !body.amplitude_m.empty() && modes.count() >= body.amplitude_m.size();
    const Structure bent = bends ? bent_structure(straight, modes, body.amplitude_m) : Structure{};
    const Structure& s = bends ? bent : straight;
    const Eigen::Matrix4f eye_from_body =
        view.eye.eye_from_scene * scene_from_body(body.T_model_body, content.centre_model_m);
    const float middle_a = -eye_from_body(2, 3);
    const bool residues = kind == LabelKind::residues;
    for (const Anchor& a : residues ? residue_anchors(s) : chain_anchors(s)) {
        const Eigen::Vector4f at = eye_from_body * backbone_place_a(s, a.atom).homogeneous();
        const float away = -at.z();
        if (!(away > 0.0F) || away < view.nearest_a || (residues && away > middle_a)) continue;
        const Eigen::Vector4f clip = view.eye.projection * at;
        const Eigen::Vector2f ndc = clip.head<2>() / clip.w();
        if (!(ndc.cwiseAbs().maxCoeff() < 1.0F)) continue;
        std::string text = s.chain_names[a.chain];
        if (residues) text += (text.empty() ? "" : " ") + std::to_string(s.residue[a.atom]);
        if (text.empty()) continue;
        const Rgb8 c = chain_colour(a.chain);
        const auto paler = [](std::uint8_t channel) {
            return static_cast<std::uint8_t>(140 + channel * 9 / 20);
        };
        out.push_back({{0.5F + 0.5F * ndc.x(),
                        0.5F - 0.5F * ndc.y(),
                        {paler(c[0]), paler(c[1]), paler(c[2])},
                        std::move(text)},
                       away});
    }
}

}  // namespace

std::vector<ViewLabel> body_labels(const SceneContent& content, std::span<const DrawnBody> bodies,
                                   LabelKind kind, const LabelView& view) {
    std::vector<Placed> all;
    if (kind == LabelKind::none) return {};
    for (const DrawnBody& body : bodies)
        if (!body.hidden && !body.ghost && body.structure < docking_of(content).bodies.size())
            add_labels(content, body, kind, view, all);
    std::stable_sort(all.begin(), all.end(),
                     [](const Placed& a, const Placed& b) { return a.distance_a < b.distance_a; });
    std::vector<ViewLabel> labels;
    for (Placed& p : all) {
        if (labels.size() >= kLabelsMax) break;
        const bool covers = std::any_of(labels.begin(), labels.end(), [&](const ViewLabel& other) {
            const auto letters = static_cast<float>(p.label.text.size() + other.text.size());
            return std::abs(p.label.x - other.x) * view.width < 0.5F * kLetterWide * letters &&
                   std::abs(p.label.y - other.y) * view.height < kLineHigh;
        });
        if (!covers) labels.push_back(std::move(p.label));
    }
    return labels;
}

}  // namespace tact
