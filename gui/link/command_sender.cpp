#include "gui/link/command_sender.hpp"

#include <algorithm>
#include <cstring>

#include "ipc/topics/text.hpp"

namespace tact {

bool CommandSender::send(const Command& wanted, std::int64_t now_ns) {
    CommandTopic command{};
    if (wanted.text.size() >= sizeof command.text) return false;
    if (*closed_ != '\0') {
        stage_ = Stage::refused;
        text_ = std::string(command_kind_text(wanted.kind)) + ": " + closed_;
        return true;
    }
    command.sequence = ++sequence_;
    command.taken_at_ns = now_ns;
    command.value = wanted.value;
    command.kind = static_cast<std::uint16_t>(wanted.kind);
    command.body = wanted.body;
    const Eigen::Vector4d q = wanted.T_model_body.q.coeffs();  // x, y, z, w
    std::copy_n(wanted.T_model_body.p_m.data(), 3, command.pos_model_m);
    std::copy_n(q.data(), 4, command.quat_model_body_xyzw);
    std::memcpy(command.text, wanted.text.data(), wanted.text.size());
    queue_.push(command);
    kind_ = wanted.kind;
    sent_at_ns_ = now_ns;
    stage_ = Stage::sent;
    text_ = std::string(command_kind_text(wanted.kind)) + ": sent";
    return true;
}

void CommandSender::update(const HealthTopic& health, std::int64_t now_ns) {
    if (stage_ != Stage::sent && stage_ != Stage::unanswered) return;
    // Arm and disarm overtake others, whose answers follow theirs.
    const bool of_state =
        health.state_sequence == sequence_ && (kind_ == CommandKind::arm || kind_ == CommandKind::disarm);
    if (of_state || health.command_sequence == sequence_) {
        const auto result =
            static_cast<CommandResult>(of_state ? health.state_result : health.command_result & 0xFFFFU);
        stage_ = result == CommandResult::done ? Stage::done : Stage::refused;
        text_ = std::string(command_kind_text(kind_)) + ": " + command_result_text(result);
    } else if (now_ns - sent_at_ns_ > kPatience_ns) {
        stage_ = Stage::unanswered;
        text_ = std::string(command_kind_text(kind_)) + ": the controller has not answered";
    }
}

void CommandSender::forget() {
    if (stage_ == Stage::sent || stage_ == Stage::unanswered) {
        stage_ = Stage::unanswered;
        text_ = std::string(command_kind_text(kind_)) + ": the controller ended before it answered";
    }
    if (stage_ == Stage::unanswered) return;
    // An answer of the controller before says nothing about the next one.
    stage_ = Stage::none;
    text_.clear();
}

}  // namespace tact
