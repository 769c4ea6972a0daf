// Names over the view: where they stand, which are left out.
#include <gtest/gtest.h>

#include <cmath>
#include <set>

#include "gui/docking/body_labels.hpp"
#include "gui/docking/docking_content.hpp"
#include "gui/render/camera.hpp"
#include "gui/window/load_scene.hpp"
#include "tests/unit/gui_fake.hpp"

namespace tact::gui_labels_test {
namespace {

class BodyLabels : public testing::Test {
protected:
    void SetUp() override {
        path_ = testing::TempDir() + "/labels-" + std::to_string(getpid()) + ".tact";
        fake::write_helix_scene(path_, 16);
        content_ = load_scene(path_);
        std::filesystem::remove(path_);
        camera_.frame(static_cast<float>(content_->radius_m / kAngstromM));
        body_ = {.T_model_body = docking_of(*content_).bodies[0].home(), .id = 1};
    }
    [[nodiscard]] LabelView view() const { return {camera_.eye(kWide / kHigh), kWide, kHigh, 0.0F}; }
    [[nodiscard]] std::vector<ViewLabel> labels(LabelKind kind, const LabelView& view) const {
        return body_labels(*content_, std::array{body_}, kind, view);
    }
    // Place of an atom in the picture, in double precision, and its distance along the view.
    [[nodiscard]] Eigen::Vector3d seen(std::size_t atom) const {
        const Structure& s = docking_of(*content_).bodies[0];
        const Vec3 p = body_.T_model_body * Vec3(s.x_m[atom], s.y_m[atom], s.z_m[atom]);
        const Vec3 scene_a = (p - content_->centre_model_m) / kAngstromM;
        const Eigen::Vector4d eye = camera_.view().cast<double>() * scene_a.homogeneous();
        const Eigen::Vector4d clip = camera_.projection(kWide / kHigh).cast<double>() * eye;
        return {0.5 + 0.5 * clip.x() / clip.w(), 0.5 - 0.5 * clip.y() / clip.w(), -eye.z()};
    }

    static constexpr float kWide = 1200.0F, kHigh = 700.0F;
    std::string path_;
    std::shared_ptr<const SceneContent> content_;
    Camera camera_;
    DrawnBody body_;
};

TEST_F(BodyLabels, each_chain_is_named_at_the_atom_nearest_to_its_middle) {
    const auto named = labels(LabelKind::chains, view());
    ASSERT_EQ(named.size(), 2U);
    const Structure& s = docking_of(*content_).bodies[0];
    for (const ViewLabel& label : named) {
        const std::uint16_t chain = label.text == "A" ? 0 : 1;
        EXPECT_EQ(label.text, s.chain_names[chain]);
        Vec3 middle = Vec3::Zero();
        double count = 0.0;
        for (std::size_t i = 0; i < s.size(); ++i)
            if (s.chain[i] == chain) {
                middle += Vec3(s.x_m[i], s.y_m[i], s.z_m[i]);
                count += 1.0;
            }
        middle /= count;
        std::size_t best = s.size();
        double least = 1e9;
        for (std::size_t i = 0; i < s.size(); ++i) {
            const double away = (Vec3(s.x_m[i], s.y_m[i], s.z_m[i]) - middle).norm();
            if (s.chain[i] == chain && away < least) {
                least = away;
                best = i;
            }
        }
        EXPECT_NEAR(static_cast<double>(label.x), seen(best).x(), 1e-4);
        EXPECT_NEAR(static_cast<double>(label.y), seen(best).y(), 1e-4);
    }
    EXPECT_TRUE(labels(LabelKind::none, view()).empty());
}

TEST_F(BodyLabels, residues_are_named_in_front_of_the_middle_and_never_cover_each_other) {
    camera_.rotate(200.0F, 30.0F, 700.0F);
    const auto named = labels(LabelKind::residues, view());
    ASSERT_GT(named.size(), 4U);
    // From far away, so that many stand in one place.
    LabelView far_away = view();
    far_away.width = kWide / 8.0F;
    far_away.height = kHigh / 8.0F;
    const auto few = labels(LabelKind::residues, far_away);
    ASSERT_GT(few.size(), 0U);
    EXPECT_LT(few.size(), named.size());
    for (const ViewLabel& a : few)
        for (const ViewLabel& b : few)
            if (&a != &b) {
                EXPECT_TRUE(std::abs(a.y - b.y) * far_away.height >= 17.0F ||
                            std::abs(a.x - b.x) * far_away.width >= 4.0F * static_cast<float>(a.text.size()))
                    << a.text << " and " << b.text;
            }
    const Structure& s = docking_of(*content_).bodies[0];
    const double middle = -(camera_.view().cast<double>() *
                            ((body_.T_model_body.p_m - content_->centre_model_m) / kAngstromM).homogeneous())
                               .z();
    std::set<std::string> texts;
    for (const ViewLabel& label : named) {
        texts.insert(label.text);
        const int residue = std::stoi(label.text.substr(2));
        const auto atom = static_cast<std::size_t>(residue - 1);
        ASSERT_LT(atom, s.size());
        EXPECT_EQ(label.text.substr(0, 1), s.chain_names[s.chain[atom]]);
        EXPECT_NEAR(static_cast<double>(label.x), seen(atom).x(), 1e-4);
        EXPECT_LE(seen(atom).z(), middle + 1e-3);
        for (const ViewLabel& other : named)
            if (&other != &label) {
                EXPECT_TRUE(std::abs(label.y - other.y) * kHigh >= 17.0F ||
                            std::abs(label.x - other.x) * kWide >=
                                4.0F * static_cast<float>(label.text.size()))
                    << label.text << " and " << other.text;
            }
    }
    EXPECT_EQ(texts.size(), named.size());
    // The nearest of all is named.
    std::size_t nearest = 0;
    for (std::size_t i = 0; i < s.size(); ++i)
        if (seen(i).z() < seen(nearest).z()) nearest = i;
    EXPECT_TRUE(texts.contains(s.chain_names[s.chain[nearest]] + " " + std::to_string(nearest + 1)));
}

TEST_F(BodyLabels, what_is_hidden_cut_off_or_outside_has_no_name) {
    LabelView cut = view();
    cut.nearest_a = 2.0F * camera_.distance_a();
    EXPECT_TRUE(labels(LabelKind::chains, cut).empty());
    LabelView away = view();
    away.eye.eye_from_scene(0, 3) += 1000.0F;
    EXPECT_TRUE(labels(LabelKind::chains, away).empty());
    LabelView behind = view();
    behind.eye.eye_from_scene(2, 3) = 10.0F;
    EXPECT_TRUE(labels(LabelKind::chains, behind).empty());
    body_.hidden = true;
    EXPECT_TRUE(labels(LabelKind::chains, view()).empty());
    body_.hidden = false;
    body_.ghost = true;
    EXPECT_TRUE(labels(LabelKind::chains, view()).empty());
    body_.ghost = false;
    body_.structure = 7;
    EXPECT_TRUE(labels(LabelKind::chains, view()).empty());
}

}  // namespace
}  // namespace tact::gui_labels_test
