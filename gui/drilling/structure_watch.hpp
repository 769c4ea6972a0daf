// Distance of a tool's surface from each labelled structure, and its closing speed.
//
// Distance   from the head of the tool (of a suction tube: its tip) to the structure's surface; negative inside.
//            Accurate to the field's error (ipc/scene/bone/distance_field.hpp). Metres of the hand's space.
// Closing    rate of decrease over the last 0.2 s
// Thread     one
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "ipc/scene/bone/distance_field.hpp"
#include "ipc/scene/file/scene_meta.hpp"
#include "ipc/topics/drill.hpp"

namespace tact {

// Balls along a tool's axis that represent its head's surface. Model metres.
struct HeadBalls {
    static constexpr std::size_t kMax = 5;
    std::array<Vec3, kMax> centre_m;
    std::array<double, kMax> radius_m{};
    std::size_t count = 0;
};
[[nodiscard]] HeadBalls head_balls(const DrillHand& hand, double world_per_model);
// The same head, translated.
[[nodiscard]] HeadBalls moved(const HeadBalls& head, const Vec3& way_m);
[[nodiscard]] double distance_m(const DistanceField& field, const HeadBalls& head, double world_per_model);
// Unit vector from the head to the structure, model frame; zero where the field is flat.
[[nodiscard]] Vec3 towards_structure(const DistanceField& field, const HeadBalls& head);

class StructureWatch {
public:
    static constexpr double kSmoothS = 0.2;

    struct Reading {
        std::uint32_t label = 0;
        double distance_m = 0.0, closing_m_s = 0.0;
        Vec3 towards_model = Vec3::Zero();  // unit vector from the head to the structure; zero: unknown
    };

    // The fields must outlive this object.
    StructureWatch(std::span<const DistanceField> fields, double world_per_model)
        : fields_(fields), world_per_model_(world_per_model) {}

    // Readings of one hand, in the order of the fields; empty if the hand holds no tool. Valid until the next call
    // for it.
    std::span<const Reading> look(const DrillTopic& drill, std::size_t hand);

private:
    struct Hand {
        std::vector<Reading> reading;
        std::int64_t at_ns = 0;
        bool known = false;
    };
    std::span<const DistanceField> fields_;
    double world_per_model_;
    std::array<Hand, kDrillHands> hand_;
};

}  // namespace tact
