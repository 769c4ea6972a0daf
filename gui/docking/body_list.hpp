// The displayed bodies, with their poses predicted for display time.
//
// Follows   BodiesTopic by id, so that a body keeps its velocity and its visibility while others come and go.
//           Before the first record: one body per structure, at home.
// Hostile   a body of a structure that the scene does not have is not shown.
// Thread    frame thread.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "gui/link/pose_predictor.hpp"
#include "ipc/topics/bodies.hpp"
#include "ipc/topics/shapes.hpp"

namespace tact {

struct ShownBody {
    std::uint32_t id = 0;
    std::uint16_t structure = 0;
    std::uint16_t flags = 0;           // BodyFlag
    bool hidden = false;               // in this window only; its force remains
    Pose newest;                       // as published
    Pose T_model_body;                 // predicted
    std::vector<float> amplitude_m{};  // bent along the modes of its structure; empty: straight
    PosePredictor predictor;
};

class BodyList {
public:
    // The scene's structures at their home poses, with the ids that a controller assigns at its start.
    void start(std::span<const Pose> homes);
    void follow(const BodiesTopic& topic);
    void follow(const ShapesTopic& topic);
    void forget_motion();  // for another controller
    void predict(std::int64_t now_ns);
    void set_hidden(std::uint32_t id, bool hidden);

    [[nodiscard]] std::span<const ShownBody> bodies() const { return bodies_; }
    [[nodiscard]] std::optional<std::size_t> active() const { return active_; }  // index in bodies()
    [[nodiscard]] const ShownBody* find(std::uint32_t id) const;

private:
    std::size_t structures_ = 0;
    std::vector<ShownBody> bodies_, before_;
    std::optional<std::size_t> active_;
};

}  // namespace tact
