// The topics of a scene with bone: what the tools are, what drives them and what they took; what the first one touches.
//
// Use      one for all tools of a bone. Each attaches at the start and adds itself each cycle; the last one publishes.
// Thread   servo; TACT_RT. No allocation.
#pragma once

#include "ipc/base/rt.hpp"
#include "ipc/shm/latest.hpp"
#include "ipc/topics/drill.hpp"
#include "ipc/topics/touch.hpp"
#include "rt/force/force_model.hpp"

namespace tact {

class DrillModel;

// What the drives give; shown, and felt by nobody.
struct DrillRates {
    double irrigation_m3_s = 0.0;    // of water on the burr while it turns
    bool irrigation_always = false;  // also while it stands
    double suction_m3_s = 0.0;
};

class DrillPublisher {
public:
    DrillPublisher(Latest<DrillTopic>& drill, Latest<TouchTopic>& touch, const DrillRates& rates)
        : drill_(drill), touch_(touch), rates_(rates) {}

    void attach() { ++tools_; }
    [[nodiscard]] DrillRates& rates() noexcept TACT_RT { return rates_; }
    void add(const DrillModel& tool, const ModelCycle& cycle) noexcept TACT_RT;

private:
    Latest<DrillTopic>& drill_;
    Latest<TouchTopic>& touch_;
    DrillRates rates_;
    DrillTopic next_{};
    std::int64_t removed_ = 0;  // levels, by all tools
    std::uint32_t tools_ = 0, added_ = 0;
};

}  // namespace tact
