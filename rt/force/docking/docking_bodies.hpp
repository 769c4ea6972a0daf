// The bodies of a docking scene and the orders that change them.
//
// Runs on   servo thread, between steps; constant time, no allocation
// Owns      ids: ascending from 1, never reused
#pragma once

#include <cstdint>
#include <vector>

#include "ipc/base/rt.hpp"
#include "rt/force/force_model.hpp"

namespace tact {

// Start state of a body.
struct StartBody {
    std::uint32_t structure = 0;
    Pose T_model_body;
    bool fixed = false;
    bool in_hand = false;  // the first marked body starts in the hand; without one, the first of all
};

// With kDockingTogether: the body is a copy of the one in the hand, and not fixed.
[[nodiscard]] bool moves_along_with_active(const ModelBodies& list, std::uint32_t index) noexcept TACT_RT;

class DockingBodies {
public:
    enum class Change : std::uint8_t {
        refused,
        none,    // applied without effect on the force
        others,  // bodies other than the one in the hand changed
        moved,   // the body in the hand was placed elsewhere
        taken,   // another body, or none, is in the hand
    };

    // At most ModelBodies::kMax bodies; the caller checks poses and structures.
    DockingBodies(const std::vector<StartBody>& start, std::uint32_t structures) noexcept;

    // Applies every kind except setting. The caller checks the poses of place and add.
    Change order(const ModelOrder& order) noexcept TACT_RT;

    [[nodiscard]] const ModelBodies& list() const noexcept { return list_; }
    ModelBodies& list() noexcept { return list_; }
    [[nodiscard]] bool in_hand() const noexcept { return list_.active < list_.count; }
    [[nodiscard]] std::uint32_t active_id() const noexcept { return in_hand() ? list_.id[list_.active] : 0; }
    [[nodiscard]] bool active_fixed() const noexcept {
        return in_hand() && (list_.flags[list_.active] & ModelBodies::kFixed) != 0;
    }
    // Structure of the body in the hand; 0 if the hand is empty.
    [[nodiscard]] std::size_t structure() const noexcept {
        return in_hand() ? list_.structure[list_.active] : 0;
    }

    // The body in the hand has moved from `before`: the bodies that move along follow.
    void follow(const Pose& T_model_before) noexcept TACT_RT;

private:
    [[nodiscard]] std::uint32_t index_of(std::uint32_t id) const noexcept;  // list().count: unknown id
    bool add(std::uint32_t structure, const Pose& T_model_body, bool fixed) noexcept;
    Change remove(std::uint32_t index) noexcept;

    ModelBodies list_;
    std::uint32_t structures_;
    std::uint32_t next_id_ = 1;
};

}  // namespace tact
