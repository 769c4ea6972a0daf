// Sends numbered commands to the controller and tracks their results.
//
// Thread   frame thread.
#pragma once

#include <cstdint>
#include <string>

#include "ipc/base/pose.hpp"
#include "ipc/topics/command_queue.hpp"
#include "ipc/topics/health.hpp"

namespace tact {

struct Command {
    CommandKind kind = CommandKind::none;
    double value = 0.0;
    std::string text{};
    std::uint32_t body = 0;  // id; for add_body the index of a structure
    Pose T_model_body{};     // place_body, add_body
};

class CommandSender {
public:
    static constexpr std::int64_t kPatience_ns = 2'000'000'000;
    enum class Stage : std::uint8_t { none, sent, done, refused, unanswered };

    explicit CommandSender(CommandQueue& queue) : queue_(queue) {}

    // Returns false and sends nothing if the text is longer than the topic allows.
    bool send(const Command& wanted, std::int64_t now_ns);
    // Not empty: nothing is sent, and the text says why.
    void close(const char* why) { closed_ = why; }
    // Takes the newest result that the controller published.
    void update(const HealthTopic& health, std::int64_t now_ns);
    // Drops the pending command: a new controller never received it.
    void forget();

    [[nodiscard]] Stage stage() const { return stage_; }
    [[nodiscard]] const std::string& text() const { return text_; }
    [[nodiscard]] std::uint64_t sequence() const { return sequence_; }

private:
    CommandQueue& queue_;
    std::uint64_t sequence_ = 0;
    std::int64_t sent_at_ns_ = 0;
    CommandKind kind_ = CommandKind::none;
    Stage stage_ = Stage::none;
    const char* closed_ = "";
    std::string text_;
};

}  // namespace tact
