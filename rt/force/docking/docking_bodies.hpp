// The bodies of a docking scene and the orders that change them.
//
// Runs on   servo thread, between steps; constant time, no allocation
// Owns      ids: from 1, rising, never used again
#pragma once

#include <cstdint>
#include <vector>

#include "ipc/base/rt.hpp"
#include "rt/force/force_model.hpp"

namespace tact {

// Where a body starts.
struct StartBody {
    std::uint32_t structure = 0;
    Pose T_model_body;
    bool fixed = false;
    bool in_hand = false;  // the first that is; the first of all where none is
};

class DockingBodies {
public:
    enum class Change : std::uint8_t {
        refused,
        none,    // applied, and the force does not care
        others,  // bodies besides the one in the hand
        moved,   // the one in the hand is elsewhere
        taken,   // another one is in the hand, or none
    };

    // At most ModelBodies::kMax; poses and structures are the caller's care.
    DockingBodies(const std::vector<StartBody>& start, std::uint32_t structures) noexcept;

    // All kinds but option. The pose of place and add has to be checked by the caller.
    Change order(const ModelOrder& order) noexcept TACT_RT;

    [[nodiscard]] const ModelBodies& list() const noexcept { return list_; }
    ModelBodies& list() noexcept { return list_; }
    [[nodiscard]] bool in_hand() const noexcept { return list_.active < list_.count; }
    [[nodiscard]] std::uint32_t active_id() const noexcept { return in_hand() ? list_.id[list_.active] : 0; }
    [[nodiscard]] bool active_fixed() const noexcept {
        return in_hand() && (list_.flags[list_.active] & ModelBodies::kFixed) != 0;
    }
    // Of the body in the hand; where there is none, the first of all.
    [[nodiscard]] std::size_t structure() const noexcept {
        return in_hand() ? list_.structure[list_.active] : 0;
    }

private:
    [[nodiscard]] std::uint32_t index_of(std::uint32_t id) const noexcept;  // list().count: not there
    bool add(std::uint32_t structure, const Pose& T_model_body, bool fixed) noexcept;
    Change remove(std::uint32_t index) noexcept;

    ModelBodies list_;
    std::uint32_t structures_;
    std::uint32_t next_id_ = 1;
};

}  // namespace tact
