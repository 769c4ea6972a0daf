// Commands of the visual process to the controller: the newest arm, the newest disarm, and a ring of all others.
//
// Writer   push(): never waits. No number of other commands can overwrite an arm or a disarm
// Reader   owns a cursor; next() returns the newest arm and disarm that it has not returned yet, older sequence first,
//          then the others in order
#pragma once

#include <cstdint>

#include "ipc/shm/latest.hpp"
#include "ipc/shm/ring.hpp"
#include "ipc/topics/command.hpp"

namespace tact {

class CommandQueue {
public:
    static constexpr std::uint64_t kOthers = 64;
    struct Cursor {
        std::uint64_t arms = 0, disarms = 0;
        RingCursor others;
    };

    void push(const CommandTopic& command) noexcept {
        const auto kind = static_cast<CommandKind>(command.kind);
        if (kind == CommandKind::arm)
            arm_.publish(command);
        else if (kind == CommandKind::disarm)
            disarm_.publish(command);
        else
            others_.push(command);
    }
    // A cursor at the next command to come.
    [[nodiscard]] Cursor tail() const noexcept { return {arm_.count(), disarm_.count(), others_.tail()}; }

    [[nodiscard]] bool next_arm_or_disarm(Cursor& cursor, CommandTopic& command) const noexcept {
        CommandTopic arm{}, disarm{};
        std::uint64_t arms = 0, disarms = 0;
        const bool armed = arm_.read(arm, &arms) && arms != cursor.arms,
                   disarmed = disarm_.read(disarm, &disarms) && disarms != cursor.disarms;
        if (!armed && !disarmed) return false;
        if (armed && (!disarmed || arm.sequence < disarm.sequence)) {
            cursor.arms = arms;
            command = arm;
        } else {
            cursor.disarms = disarms;
            command = disarm;
        }
        return true;
    }
    [[nodiscard]] bool next_other(Cursor& cursor, CommandTopic& command) const noexcept {
        return others_.next(cursor.others, command);
    }
    [[nodiscard]] bool next(Cursor& cursor, CommandTopic& command) const noexcept {
        return next_arm_or_disarm(cursor, command) || next_other(cursor, command);
    }

private:
    Latest<CommandTopic> arm_, disarm_;
    Ring<CommandTopic, kOthers> others_;
};

}  // namespace tact
