// What the stages of a cycle reach besides the CycleState. Borrowed; outlives the loop.
#pragma once

#include "hal/api/lines.hpp"
#include "ipc/base/clock.hpp"
#include "ipc/topics/regions.hpp"
#include "rt/servo/mailbox.hpp"
#include "rt/servo/servo_settings.hpp"

namespace tact {

struct ServoIo {
    Clock& clock;
    RtRegion& region;
    ServoMailbox& mailbox;
    Lines* lines = nullptr;               // null: none are fitted
    const CycleScript* script = nullptr;  // of a replay, read in every cycle
};

}  // namespace tact
