// What `tact igtl` sends: the state of the controller as OpenIGTLink messages, one batch per period.
//
//   ToolToWorld, Tool2ToWorld     TRANSFORM  pose of each hand in the frame `world`, mm: x right, y up, z to the user
//   ToolForce, ToolTorque, ...    SENSOR     as sent to the device, in the axes of `world`; N and N m
//   ToolDepth, ...                SENSOR     depth of the tool in surface or bone, mm of the hand's space; 0: free
//   ToolToPatient, ...            TRANSFORM  drilling a scan that states its orientation: the tool in the patient, RAS, mm
//   HeadToScreen                  TRANSFORM  the tracked head in the frame of the screen, mm
//   TactStatus                    STATUS     state and reason; the sub-code is the number of ToolToWorld sent before it,
//                                            so that a receiver can count losses
//   TactState                     STRING     the same for people, with rates
// Both last ones at every change, for every new client and once per second.
//
// Repeats   a value that the controller did not renew is not sent again
// Time      UTC of the measurement; in a replay the time of sending
// Hostile   region values may be anything: a message with a number that is not finite is omitted
// Thread    one
#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "deploy/tact/observer.hpp"
#include "ipc/igtl/encode.hpp"
#include "ipc/scene/bone/patient_frame.hpp"

namespace tact::launch {

// Of the scene that the controller runs.
struct IgtlScene {
    double world_per_model = 0.0;  // 0: unknown
    std::optional<PatientFrame> patient;
    std::string problem;  // why the scene could not be read; "": it was
};
[[nodiscard]] IgtlScene read_igtl_scene(const std::string& path);

class IgtlMessages {
public:
    // For a new controller.
    void scene(IgtlScene scene);
    // The next batch contains the status: a client is new.
    void greet() { state_shown_ = 0; }
    // The batch of one period. region: null without a controller. utc_ns: the time of day at `now`.
    [[nodiscard]] IgtlBytes batch(const RtRegion* region, Instant now, std::int64_t utc_ns);
    [[nodiscard]] std::uint64_t batches() const { return batches_; }

private:
    struct Stamp {  // of the last value sent
        bool sent = false;
        std::uint64_t number = 0;
        bool renewed(std::uint64_t n) {
            const bool fresh = !sent || number != n;
            sent = true;
            number = n;
            return fresh;
        }
    };

    void hand(const RtRegion& region, std::size_t hand, IgtlBytes& out);
    void depths(const RtRegion& region, IgtlBytes& out);
    void head(const RtRegion& region, IgtlBytes& out);
    void status(const RtRegion* region, IgtlBytes& out);
    // False: not sent, because it is no pose.
    bool transform(IgtlBytes& out, const std::string& name, const Vec3& p_m, const double (&quat_xyzw)[4],
                   std::int64_t taken_at_ns) const;
    [[nodiscard]] std::int64_t time_of(std::int64_t taken_at_ns) const;

    IgtlScene scene_;
    std::uint64_t batches_ = 0, poses_ = 0;  // the latter: ToolToWorld
    Instant now_{}, status_at_{};
    std::int64_t utc_ns_ = 0;
    Stamp hand_[kHandsMax], touch_, drill_, head_;
    std::uint64_t state_shown_ = 0;  // code of the state that the last status showed; 0: none yet
};

}  // namespace tact::launch
