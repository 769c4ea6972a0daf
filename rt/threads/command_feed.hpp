// Takes the commands of the visual process from its ring, checks them and passes them on to the servo.
//
// Order     arm and disarm first: each turn looks for them through the whole ring. Of the others a turn takes so many that
//           a flood costs bounded work and is counted as missed.
// Answers   are the servo's: a refused command goes to it as kind none.
// Hostile   what the ring holds is checked field by field.
// Thread    housekeeping
#pragma once

#include <cstdint>
#include <span>
#include <string>

#include "ipc/shm/ring.hpp"
#include "ipc/topics/command.hpp"
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
    using Commands = Ring<CommandTopic, 64>;
    static constexpr int kOthersPerTurn = 16;

    // Begins with what comes next.
    void restart(const Commands& commands) { all_ = first_ = commands.tail(); }
    // One turn. Returns how many commands were refused or missed in it.
    std::uint64_t pass_on(const Commands& commands, std::span<const std::string> path_names,
                          ServoOrders& orders);

private:
    RingCursor first_;  // of arm and disarm; never behind all_ after a turn
    RingCursor all_;
};

}  // namespace tact
