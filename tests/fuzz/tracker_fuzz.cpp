// Frames of the tracker's bus. The first byte: format, sensors, and whether checksums are fixed, so that the later code
// is reached; then frames of 4 bytes (identifier, kind, length) and their payload.
#include <cmath>

#include "hal/tracker/can_crc.hpp"
#include "hal/tracker/fix_assembler.hpp"
#include "tests/fuzz/fuzz.hpp"

namespace tact::fuzz {
namespace {

constexpr std::uint8_t kFd = 1, kFix = 2;

void fix(CanFrame& f) {
    if (f.kind == CanKind::classic && f.length == kClassicBytes) {
        f.data[7] = crc_of<Crc8>(can_data_id(f.id), f.payload().first(7));
    } else if (f.kind == CanKind::fd && f.length == kPoseBytes) {
        const auto crc = crc_of<Crc16>(can_data_id(f.id), f.payload().subspan(2));
        f.data[0] = static_cast<std::uint8_t>(crc & 0xFFU);
        f.data[1] = static_cast<std::uint8_t>(crc >> 8);
    }
}

void append(Input& input, const CanFrame& f) {
    const std::size_t at = input.size();
    input.resize(at + 4 + f.length);
    input[at] = static_cast<std::byte>(f.id & 0xFFU);
    input[at + 1] = static_cast<std::byte>(f.id >> 8);
    input[at + 2] = static_cast<std::byte>(f.kind);
    input[at + 3] = static_cast<std::byte>(f.length);
    for (std::size_t i = 0; i < f.length; ++i) input[at + 4 + i] = static_cast<std::byte>(f.data[i]);
}

}  // namespace

bool run(std::span<const std::byte> input) {
    if (input.empty()) return false;
    const auto how = static_cast<unsigned>(input[0]);
    FixSettings settings;
    settings.format = (how & kFd) != 0 ? CanFormat::fd : CanFormat::classic;
    settings.sensors = 1 + (how >> 2) % kTrackerSensorsMax;
    FixAssembler assembler(settings);
    std::uint64_t frames = 0, fixes = 0;
    for (std::size_t at = 1; at + 4 <= input.size();) {
        CanFrame f;
        f.id = static_cast<std::uint32_t>(input[at]) | static_cast<std::uint32_t>(input[at + 1]) << 8;
        f.kind = static_cast<CanKind>(static_cast<unsigned>(input[at + 2]) % 4);
        f.length = static_cast<std::uint8_t>(input[at + 3]);
        at += 4;
        for (std::size_t i = 0; i < f.payload().size() && at < input.size(); ++i, ++at)
            f.data[i] = static_cast<std::uint8_t>(input[at]);
        if ((how & kFix) != 0) fix(f);
        ++frames;
        TrackerFix fix;
        if (!assembler.take(f, fix)) continue;
        ++fixes;
        require(fix.sensor < settings.sensors);
        require(fix.T_tracker_sensor.finite());
        require(std::abs(fix.T_tracker_sensor.q.norm() - 1.0) < 1e-9);
        require(fix.T_tracker_sensor.p_m.norm() <= settings.reach_m);
        require(fix.quality >= 0.0 && fix.quality <= 1.0 && fix.distortion >= 0.0 && fix.distortion <= 1.0);
    }
    // A frame is refused at most once, except that a SYNC discards the half frames of all sensors.
    require(fixes + assembler.refused().total() <= (1 + kTrackerSensorsMax) * frames);
    return fixes > 0;
}

std::vector<Input> seeds() {
    const Pose T{Vec3(0.1, -0.2, 0.3), quat_from_rotation_vector(Vec3(0.1, 0.2, 0.3))};
    std::vector<Input> all;
    for (const std::uint8_t fixed : {std::uint8_t{0}, kFix}) {
        Input classic{static_cast<std::byte>(fixed | 1U << 2)};
        Input fd{static_cast<std::byte>(kFd | fixed | 1U << 2)};
        for (std::uint8_t n = 0; n < 3; ++n) {
            append(classic, encode(SyncFrame{n, n * 4167U, TrackerStatus::ok}));
            for (std::uint8_t sensor = 0; sensor < 2; ++sensor) {
                append(classic, encode(PosFrame{sensor, n, kSensorValid, T.p_m}));
                append(classic, encode(QuatFrame{sensor, n, T.q}));
                append(fd, encode(PoseFrame{sensor, n, kSensorValid, n * 4167U, T, 1.0, 0.0}));
            }
        }
        all.push_back(classic);
        all.push_back(fd);
    }
    return all;
}

}  // namespace tact::fuzz
