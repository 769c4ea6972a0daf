// A stream of an OpenIGTLink server, and the tracker's reader behind it. The first byte: size of the portions in which the
// bytes arrive, and whether checksums are fixed, so that the later code is reached.
#include <igtl_util.h>

#include <algorithm>
#include <cmath>

#include "hal/tracker/igtl_reader.hpp"
#include "ipc/igtl/encode.hpp"
#include "tests/fuzz/fuzz.hpp"

namespace tact::fuzz {
namespace {

constexpr std::uint8_t kFix = 1;

class FuzzSource final : public IgtlSource {
public:
    FuzzSource(std::span<const std::byte> bytes, std::size_t portion) : rest_(bytes), portion_(portion) {}
    void open() override {}
    bool reopen() noexcept override { return true; }
    void close() noexcept override {}
    IgtlBatch receive(std::span<std::byte> into, Duration) noexcept override {
        const std::size_t n = std::min({into.size(), rest_.size(), portion_});
        std::copy_n(rest_.begin(), n, into.begin());
        rest_ = rest_.subspan(n);
        return {.bytes = n, .gone = false};
    }
    [[nodiscard]] bool empty() const { return rest_.empty(); }

private:
    std::span<const std::byte> rest_;
    std::size_t portion_;
};

// Writes the checksum of every body that is complete.
void fix_checksums(std::vector<std::byte>& bytes) {
    for (std::size_t at = 0; at + kIgtlHeaderBytes <= bytes.size();) {
        IgtlHeader header;
        if (decode_header(std::span(bytes).subspan(at).first<kIgtlHeaderBytes>(), header) !=
            IgtlHeaderFault::none)
            return;
        const std::size_t rest = bytes.size() - at - kIgtlHeaderBytes;
        if (header.body_bytes > rest) return;
        const std::uint64_t crc = crc64(
            reinterpret_cast<unsigned char*>(bytes.data() + at + kIgtlHeaderBytes), header.body_bytes, 0);
        for (std::size_t i = 0; i < 8; ++i)
            bytes[at + 50 + i] = static_cast<std::byte>(crc >> (56U - 8U * i));
        at += kIgtlHeaderBytes + static_cast<std::size_t>(header.body_bytes);
    }
}

}  // namespace

bool run(std::span<const std::byte> input) {
    if (input.empty()) return false;
    const auto how = std::to_integer<unsigned>(input[0]);
    std::vector<std::byte> bytes(input.begin() + 1, input.end());
    if ((how & kFix) != 0) fix_checksums(bytes);
    FuzzSource source(bytes, how < 2 ? SIZE_MAX : how);
    ManualClock clock;
    clock.advance(std::chrono::seconds(10));
    IgtlReader reader({.names = {"Head", "Stylus"}}, source, clock);
    reader.opened();
    std::size_t rounds = 0;
    for (; !source.empty(); ++rounds) {
        require(rounds <= bytes.size());
        reader.round(Duration{0});
        clock.advance(std::chrono::milliseconds(10));
        for (unsigned sensor = 0; sensor < 3; ++sensor) {
            TrackerSample s;
            static_cast<void>(reader.read(sensor, s, clock.now()));
            require(s.T_tracker_sensor.finite() && std::abs(s.T_tracker_sensor.q.norm() - 1.0) < 1e-9);
            require(s.T_tracker_sensor.p_m.norm() <= 1.6 && s.taken_at <= clock.now());
        }
        if (reader.health().link == TrackerLink::gone) clock.advance(IgtlReader::kReopenEvery);
    }
    const TrackerHealth h = reader.health();
    require(h.frames <= bytes.size() / kIgtlHeaderBytes);
    require(h.samples + h.refused <= h.frames * kIgtlPosesMax);
    require(h.missed <= h.samples * 100);  // the periods of IgtlReader::kGapMost
    return h.samples > 0;
}

std::vector<Input> seeds() {
    const Pose T{Vec3(0.1, -0.2, 0.3), quat_from_rotation_vector(Vec3(0.1, 0.2, 0.3))};
    const IgtlNamedPose poses[] = {{"Head", T}, {"Stylus", T}, {"Reference", T}};
    std::vector<Input> all;
    for (const std::uint8_t how : {std::uint8_t{0}, kFix, std::uint8_t{40}}) {
        Input transforms{static_cast<std::byte>(how)}, tdata = transforms, mixed = transforms;
        for (int n = 1; n < 4; ++n) {
            append_transform(transforms, "Head", T, n * 16'000'000);
            append_tdata(tdata, "Tracker", poses, n * 16'000'000);
            append_string(mixed, "Text", "of no use", 0);
            append_transform(mixed, "Head", T, 0);
        }
        all.insert(all.end(), {transforms, tdata, mixed});
    }
    // Protocol 3: an extended header of 12 bytes and metadata of 4.
    Input three{static_cast<std::byte>(kFix)};
    append_transform(three, "Head", T, 0);
    three[2] = std::byte{2};
    three[50] = std::byte{48 + 12 + 4};
    const Input extended = {std::byte{0}, std::byte{12}, std::byte{0}, std::byte{0},
                            std::byte{0}, std::byte{0},  std::byte{0}, std::byte{4},
                            std::byte{0}, std::byte{0},  std::byte{0}, std::byte{1}};
    three.insert(three.begin() + 1 + static_cast<std::ptrdiff_t>(kIgtlHeaderBytes), extended.begin(),
                 extended.end());
    three.resize(three.size() + 4);
    all.push_back(three);
    return all;
}

}  // namespace tact::fuzz
