#include "deploy/tact/igtl_messages.hpp"

#include <algorithm>
#include <cmath>
#include <exception>
#include <utility>

#include "ipc/base/printed.hpp"
#include "ipc/base/run_state.hpp"
#include "ipc/scene/file/scene_meta.hpp"
#include "ipc/topics/text.hpp"

namespace tact::launch {
namespace {

constexpr Duration kStatusEvery = std::chrono::seconds(1);
constexpr std::int64_t kAgeMostNs = 10'000'000'000;  // an older value is one of a recording
constexpr std::uint8_t kTrackerFresh = 2;            // TrackerState

const char* const kToolOf[kHandsMax] = {"Tool", "Tool2"};

Vec3 vector_of(const double (&v)[3]) { return Vec3(v[0], v[1], v[2]); }

// Finite and small enough for a float of millimetres.
bool sendable(const Vec3& v) { return v.allFinite() && v.cwiseAbs().maxCoeff() < 1e6; }

IgtlStatus code_of(RunState state, RunReason reason) {
    switch (state) {
        case RunState::off:
            return IgtlStatus::shut_down;
        case RunState::ready:
            return IgtlStatus::disabled;
        case RunState::armed:
        case RunState::active:
            return IgtlStatus::ok;
        case RunState::fault:
            return reason == RunReason::emergency_stop ? IgtlStatus::emergency : IgtlStatus::unknown_error;
    }
    return IgtlStatus::unknown_error;
}

}  // namespace

IgtlScene read_igtl_scene(const std::string& path) {
    IgtlScene found;
    try {
        const SceneFile file = SceneFile::open(path);
        found.world_per_model = read_meta(file).world_per_model;
        found.patient = read_patient_frame(file);
    } catch (const std::exception& e) {
        found.problem = e.what();
    }
    return found;
}

void IgtlMessages::scene(IgtlScene scene) {
    scene_ = std::move(scene);
    state_shown_ = 0;
}

// The time of day of a measurement.
std::int64_t IgtlMessages::time_of(std::int64_t taken_at_ns) const {
    const std::int64_t now_ns = to_ns(now_);
    if (taken_at_ns > now_ns || taken_at_ns < now_ns - kAgeMostNs) return utc_ns_;
    return utc_ns_ - (now_ns - taken_at_ns);
}

bool IgtlMessages::transform(IgtlBytes& out, const std::string& name, const Vec3& p_m,
                             const double (&quat_xyzw)[4], std::int64_t taken_at_ns) const {
    const Quat q(quat_xyzw[3], quat_xyzw[0], quat_xyzw[1], quat_xyzw[2]);
    if (!sendable(p_m) || !(std::abs(q.norm() - 1.0) < 0.01)) return false;
    append_transform(out, name, {p_m, q.normalized()}, time_of(taken_at_ns));
    return true;
}

void IgtlMessages::hand(const RtRegion& region, std::size_t hand, IgtlBytes& out) {
    const auto t = newest(region.tool[hand]);
    if (!t || !hand_[hand].renewed(t->cycle)) return;
    const std::string tool = kToolOf[hand];
    const bool sent =
        transform(out, tool + "ToWorld", vector_of(t->pos_world_m), t->quat_world_tool_xyzw, t->taken_at_ns);
    if (sent && hand == 0) ++poses_;
    if (sendable(vector_of(t->force_world_n)))
        append_sensor(out, tool + "Force", t->force_world_n, IgtlUnit::newton, time_of(t->taken_at_ns));
    if (sendable(vector_of(t->torque_world_n_m)))
        append_sensor(out, tool + "Torque", t->torque_world_n_m, IgtlUnit::newton_metre,
                      time_of(t->taken_at_ns));
}

void IgtlMessages::depths(const RtRegion& region, IgtlBytes& out) {
    const auto depth = [&](std::size_t hand, double depth_world_m, std::int64_t taken_at_ns) {
        const double mm[] = {1e3 * depth_world_m};
        if (std::isfinite(mm[0]))
            append_sensor(out, std::string(kToolOf[hand]) + "Depth", mm, IgtlUnit::millimetre,
                          time_of(taken_at_ns));
    };
    const auto touch = newest(region.touch);
    if (touch && touch_.renewed(touch->cycle) && scene_.world_per_model > 0.0)
        depth(0,
              scene_.world_per_model *
                  (vector_of(touch->probe_model_m) - vector_of(touch->proxy_model_m)).norm(),
              touch->taken_at_ns);
    const auto drill = newest(region.drill);
    if (!drill || !drill_.renewed(drill->cycle)) return;
    for (std::size_t i = 0; i < kHandsMax; ++i) {
        const DrillHand& h = drill->hand[i];
        if (h.kind != DrillKind::burr && h.kind != DrillKind::suction_tube) continue;
        depth(i, static_cast<double>(h.depth) * static_cast<double>(h.radius_m), drill->taken_at_ns);
        if (!scene_.patient) continue;
        // The patient's frame of a scene is LPS; that of OpenIGTLink's receivers is RAS.
        const Eigen::Matrix3d R_ras_model = Vec3(-1.0, -1.0, 1.0).asDiagonal() * scene_.patient->axes;
        const Vec3 p_lps_mm = scene_.patient->patient_mm(vector_of(h.pos_model_m));
        const Quat q_model_tool(h.quat_model_tool_xyzw);
        const Quat q = Quat(R_ras_model) * q_model_tool;
        transform(out, std::string(kToolOf[i]) + "ToPatient",
                  1e-3 * Vec3(-p_lps_mm.x(), -p_lps_mm.y(), p_lps_mm.z()), {q.x(), q.y(), q.z(), q.w()},
                  drill->taken_at_ns);
    }
}

void IgtlMessages::head(const RtRegion& region, IgtlBytes& out) {
    const auto h = newest(region.head);
    if (!h || h->state != kTrackerFresh || !head_.renewed(h->sequence)) return;
    transform(out, "HeadToScreen", vector_of(h->pos_screen_m), h->quat_screen_head_xyzw, h->taken_at_ns);
}

void IgtlMessages::status(const RtRegion* region, IgtlBytes& out) {
    const auto h = region != nullptr ? newest(region->health) : std::nullopt;
    const auto state = h ? static_cast<RunState>(std::min<std::uint8_t>(h->state, 4)) : RunState::off;
    const auto reason = h ? static_cast<RunReason>(h->reason) : RunReason::none;
    const std::uint64_t shown =
        h ? 2 + static_cast<std::uint64_t>(state) * 256 + static_cast<std::uint64_t>(reason) : 1;
    if (shown == state_shown_ && now_ - status_at_ < kStatusEvery) return;
    state_shown_ = shown;
    status_at_ = now_;
    const auto number = static_cast<std::int64_t>(poses_);
    if (!h) {
        append_status(out, "TactStatus", IgtlStatus::not_present, number, "no controller",
                      "no controller runs", utc_ns_);
        append_string(out, "TactState", "no controller runs", utc_ns_);
        return;
    }
    const std::string text = std::string(run_state_text(state)) + ": " + run_reason_text(reason);
    append_status(out, "TactStatus", code_of(state, reason), number, run_reason_name(reason), text, utc_ns_);
    append_string(
        out, "TactState",
        text + printed("; force rate %.0f Hz", std::isfinite(h->force_rate_hz) ? h->force_rate_hz : 0.0),
        utc_ns_);
}

IgtlBytes IgtlMessages::batch(const RtRegion* region, Instant now, std::int64_t utc_ns) {
    IgtlBytes out;
    ++batches_;
    now_ = now;
    utc_ns_ = utc_ns;
    status(region, out);
    if (region == nullptr) return out;
    for (std::size_t i = 0; i < kHandsMax; ++i) hand(*region, i, out);
    depths(*region, out);
    head(*region, out);
    return out;
}

}  // namespace tact::launch
