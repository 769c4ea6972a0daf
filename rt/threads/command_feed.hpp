// Takes the commands of the visual process from its queue, checks them and passes them on to the servo.
//
// Order     arm and disarm first. Of the others a turn takes so many that a flood costs bounded work and is counted as
//           missed.
// Answers   are the servo's: a refused command goes to it as kind none.
// Hostile   what the queue holds is checked field by field.
// Thread    housekeeping
#pragma once

#include <cstdint>
#include <span>
#include <string>

#include "ipc/topics/command_queue.hpp"
#include "rt/servo/servo_orders.hpp"

namespace tact {

// A command in the servo's terms, or why not. path_names in the order of the governor's paths.
struct CheckedCommand {
    ServoOrder order{};
    CommandResult result = CommandResult::none;  // none: fit to pass on
};
[[nodiscard]] CheckedCommand check_command(const CommandTopic& command,
                                           std::span<const std::string> path_names);

class CommandFeed {
public:
    static constexpr int kOthersPerTurn = 16;

    // Begins with what comes next.
    void restart(const CommandQueue& commands) { cursor_ = commands.tail(); }
    // One turn. Returns how many commands were refused or missed in it.
    std::uint64_t pass_on(const CommandQueue& commands, std::span<const std::string> path_names,
                          ServoOrders& orders);

private:
    CommandQueue::Cursor cursor_;
};

}  // namespace tact
