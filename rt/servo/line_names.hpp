// Maps causes and states of the safety inputs to those of the state machine and of the topics.
#pragma once

#include "hal/api/lines.hpp"
#include "ipc/base/run_state.hpp"
#include "ipc/topics/health.hpp"

namespace tact {

[[nodiscard]] constexpr RunReason reason_of(LinesCause cause) noexcept {
    switch (cause) {
        case LinesCause::none:
            return RunReason::none;
        case LinesCause::lost:
            return RunReason::lines_lost;
        case LinesCause::channels_disagree:
            return RunReason::stop_channels;
        case LinesCause::emergency_stop:
            return RunReason::emergency_stop;
        case LinesCause::amplifier:
            return RunReason::amplifier_readback;
        case LinesCause::dead_man:
            return RunReason::dead_man;
        case LinesCause::dropped:
            return RunReason::supervisor;
    }
    return RunReason::lines_lost;
}

[[nodiscard]] constexpr LinesShown shown(LinesState state) noexcept {
    switch (state) {
        case LinesState::waiting:
            return LinesShown::waiting;
        case LinesState::permitted:
            return LinesShown::permitted;
        case LinesState::stopped:
            break;
    }
    return LinesShown::stopped;
}

}  // namespace tact
