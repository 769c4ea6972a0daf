// Clock, shared memory, mailbox and lines that the stages use besides the CycleState. Borrowed; outlives the loop.
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
    Lines* lines = nullptr;               // null: no safety inputs
    const CycleScript* script = nullptr;  // replay only; read in every cycle
};

}  // namespace tact
