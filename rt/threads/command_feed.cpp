#include "rt/threads/command_feed.hpp"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <iterator>

#include "ipc/topics/bodies.hpp"
#include "ipc/topics/drill.hpp"
#include "rt/govern/law.hpp"

namespace tact {

namespace {

// A place that some scene may have: no model is kilometres wide. What a scene really has the model says.
bool read_pose(const CommandTopic& command, ServoOrder& order) {
    double square = 0.0;
    for (const double p : command.pos_model_m)
        if (!(std::abs(p) <= 1e3)) return false;
    for (const double q : command.quat_model_body_xyzw) square += q * q;
    if (!(square > 0.98 && square < 1.02)) return false;
    std::copy(std::begin(command.pos_model_m), std::end(command.pos_model_m), order.pos_model_m);
    for (int i = 0; i < 4; ++i)
        order.quat_model_body_xyzw[i] = command.quat_model_body_xyzw[i] / std::sqrt(square);
    return true;
}

// False: also for what is not a number.
bool within(double value, double least, double most) { return value >= least && value <= most; }

// Which bodies there are only the servo knows.
bool read_body_order(const CommandTopic& command, ServoOrder& order) {
    order.body = command.body;
    const bool id = command.body != 0 && command.body != kNoBody;
    const bool yes_or_no = command.value == 0.0 || command.value == 1.0;
    switch (static_cast<CommandKind>(command.kind)) {
        case CommandKind::select_body:
            return command.body != 0;
        case CommandKind::fix_body:
            return id && yes_or_no;
        case CommandKind::place_body:
            return id && read_pose(command, order);
        case CommandKind::add_found_place:
            return id && command.value >= 0.0 && command.value <= 1.0 && read_pose(command, order);
        case CommandKind::add_body:
            return command.body <= 0xFFFFU && read_pose(command, order);
        case CommandKind::remove_body:
            return id;
        case CommandKind::set_detail_filter:  // how wide a filter may be the model knows
            order.pos_model_m[0] = command.pos_model_m[0];
            return command.body <= 0xFFU && std::isfinite(command.pos_model_m[0]);
        case CommandKind::set_burr:  // whether the bone's voxels allow it the model knows
            order.pos_model_m[0] = command.pos_model_m[0];
            return (command.body & 0xFFU) <= static_cast<std::uint32_t>(DrillShape::cone) &&
                   (command.body >> 8U) <= static_cast<std::uint32_t>(DrillGrit::diamond) &&
                   within(command.value, kBurrDiameterLeastM, kBurrDiameterMostM) &&
                   within(command.pos_model_m[0], 0.0, kBurrLengthMostM);
        case CommandKind::set_burr_speed:
            return within(command.value, 0.0, kBurrRadSMost);
        case CommandKind::set_irrigation:
            return within(command.value, 0.0, kIrrigationM3SMost);
        case CommandKind::set_suction:
            return within(command.value, 0.0, kSuctionM3SMost);
        default:  // options
            return yes_or_no;
    }
}

}  // namespace

CheckedCommand check_command(const CommandTopic& command, std::span<const std::string> path_names) {
    CheckedCommand checked;
    checked.order = {.sequence = command.sequence, .value = command.value, .kind = command.kind, .index = 0};
    if (command.kind == 0 || command.kind > static_cast<std::uint16_t>(kLastCommand)) {
        checked.result = CommandResult::unknown;
        return checked;
    }
    const bool ends = std::memchr(command.text, 0, sizeof command.text) != nullptr;
    if (!std::isfinite(command.value) || !ends || command.sequence == 0) {
        checked.result = CommandResult::refused_value;
        return checked;
    }
    const std::string_view text(command.text);
    const auto kind = static_cast<CommandKind>(command.kind);
    if (kind == CommandKind::set_law) {
        const auto law = law_named(text);
        if (!law) checked.result = CommandResult::refused_value;
        checked.order.index = law ? static_cast<std::uint32_t>(*law) : 0;
    } else if (kind == CommandKind::set_level) {
        const auto found = std::find(path_names.begin(), path_names.end(), text);
        const bool good = found != path_names.end() && command.value >= 0.0 && command.value <= 1.0;
        if (!good) checked.result = CommandResult::refused_value;
        checked.order.index = good ? static_cast<std::uint32_t>(found - path_names.begin()) : 0;
    } else if (kind == CommandKind::set_goal_hz) {
        if (!(command.value >= 1.0 && command.value <= 1e7)) checked.result = CommandResult::refused_value;
    } else if (command.kind >= static_cast<std::uint16_t>(CommandKind::select_body)) {
        if (!read_body_order(command, checked.order)) checked.result = CommandResult::refused_value;
    }
    return checked;
}

namespace {

// False: refused. The servo answers all commands, so that the answers come in order: a refused one goes as kind none.
bool pass(const CommandTopic& command, std::span<const std::string> path_names, ServoOrders& orders) {
    const CheckedCommand checked = check_command(command, path_names);
    if (checked.result == CommandResult::none) {
        orders.push(checked.order);
        return true;
    }
    orders.push({.sequence = command.sequence,
                 .value = 0.0,
                 .kind = static_cast<std::uint32_t>(CommandKind::none),
                 .index = static_cast<std::uint32_t>(checked.result)});
    return false;
}

}  // namespace

std::uint64_t CommandFeed::pass_on(const CommandQueue& commands, std::span<const std::string> path_names,
                                   ServoOrders& orders) {
    std::uint64_t bad = 0;
    CommandTopic command{};
    for (int i = 0; i < 2 && commands.next_arm_or_disarm(cursor_, command); ++i)
        bad += pass(command, path_names, orders) ? 0 : 1;
    const std::uint64_t missed = cursor_.others.missed;
    for (int i = 0; i < kOthersPerTurn && commands.next_other(cursor_, command); ++i)
        bad += pass(command, path_names, orders) ? 0 : 1;
    return bad + cursor_.others.missed - missed;
}

}  // namespace tact
