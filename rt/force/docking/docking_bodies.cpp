#include "rt/force/docking/docking_bodies.hpp"

#include <algorithm>

#include "ipc/topics/bodies.hpp"

namespace tact {

DockingBodies::DockingBodies(const std::vector<StartBody>& start, std::uint32_t structures) noexcept
    : structures_(structures) {
    for (const StartBody& body : start) add(body.structure, body.T_model_body, body.fixed);
    const auto in_hand =
        std::find_if(start.begin(), start.end(), [](const StartBody& b) { return b.in_hand; });
    if (in_hand != start.end()) list_.active = static_cast<std::uint32_t>(in_hand - start.begin());
}

std::uint32_t DockingBodies::index_of(std::uint32_t id) const noexcept {
    std::uint32_t i = 0;
    while (i < list_.count && list_.id[i] != id) ++i;
    return i;
}

bool DockingBodies::add(std::uint32_t structure, const Pose& T_model_body, bool fixed) noexcept {
    if (list_.count == ModelBodies::kMax || structure >= structures_ || next_id_ == ModelBodies::kNone)
        return false;
    const std::uint32_t i = list_.count++;
    list_.T_model_body[i] = T_model_body;
    list_.id[i] = next_id_++;
    list_.structure[i] = static_cast<std::uint16_t>(structure);
    list_.flags[i] = fixed ? ModelBodies::kFixed : std::uint16_t{0};
    return true;
}

DockingBodies::Change DockingBodies::remove(std::uint32_t index) noexcept {
    const bool held = index == list_.active;
    for (std::uint32_t i = index; i + 1 < list_.count; ++i) {
        list_.T_model_body[i] = list_.T_model_body[i + 1];
        list_.id[i] = list_.id[i + 1];
        list_.structure[i] = list_.structure[i + 1];
        list_.flags[i] = list_.flags[i + 1];
    }
    --list_.count;
    if (held) {
        list_.active = ModelBodies::kNone;
    } else if (list_.active != ModelBodies::kNone && index < list_.active) {
        --list_.active;
    }
    return held ? Change::taken : Change::others;
}

bool moves_along_with_active(const ModelBodies& list, std::uint32_t index) noexcept {
    return (list.options_asked & kDockingTogether) != 0 && list.active < list.count && index != list.active &&
           list.structure[index] == list.structure[list.active] &&
           (list.flags[index] & ModelBodies::kFixed) == 0;
}

void DockingBodies::follow(const Pose& T_model_before) noexcept {
    const Pose step = T_model_before.inverse() * list_.T_model_body[list_.active];
    for (std::uint32_t i = 0; i < list_.count; ++i)
        if (moves_along_with_active(list_, i)) list_.T_model_body[i] = list_.T_model_body[i] * step;
}

DockingBodies::Change DockingBodies::order(const ModelOrder& order) noexcept {
    using Kind = ModelOrder::Kind;
    if (order.kind == Kind::add) {
        if (!add(order.body, order.T_model_body, false)) return Change::refused;
        ++list_.placements;
        ++list_.others;
        return Change::others;
    }
    if (order.kind == Kind::select && order.body == ModelBodies::kNone) {
        if (!in_hand()) return Change::none;
        list_.active = ModelBodies::kNone;
        ++list_.others;
        return Change::taken;
    }
    const std::uint32_t i = index_of(order.body);
    if (i == list_.count) return Change::refused;
    switch (order.kind) {
        case Kind::select:
            if (i == list_.active) return Change::none;
            list_.active = i;
            ++list_.others;
            return Change::taken;
        case Kind::fix:
            list_.flags[i] = order.on ? ModelBodies::kFixed : std::uint16_t{0};
            // Another body is subtracted now, or one less.
            if ((list_.options_asked & kDockingTogether) != 0) ++list_.others;
            return Change::none;
        case Kind::place:
            list_.T_model_body[i] = order.T_model_body;
            ++list_.placements;
            if (i == list_.active) return Change::moved;
            ++list_.others;
            return Change::others;
        case Kind::remove:
            if (list_.count == 1) return Change::refused;
            ++list_.placements;
            ++list_.others;
            return remove(i);
        default:
            return Change::refused;
    }
}

}  // namespace tact
