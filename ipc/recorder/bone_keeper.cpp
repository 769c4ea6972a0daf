#include "ipc/recorder/bone_keeper.hpp"

#include <algorithm>
#include <array>
#include <optional>
#include <unordered_map>
#include <vector>

#include "ipc/base/error.hpp"
#include "ipc/recorder/watched.hpp"
#include "ipc/scene/bone/drilled_bone.hpp"
#include "ipc/scene/file/scene_file.hpp"

namespace tact::record {
namespace {

constexpr Duration kLookEvery = std::chrono::milliseconds(50);
constexpr Duration kTryAgain = std::chrono::seconds(5);
using Brick = std::array<std::uint8_t, BoneBricks::kVoxels>;

// Bricks that changed and are not in the file yet.
class Waiting {
public:
    std::span<std::uint8_t> add(std::uint32_t brick) {
        const auto [at, fresh] = place_.try_emplace(brick, bricks_.size());
        if (fresh) {
            bricks_.push_back(brick);
            densities_.resize(densities_.size() + BoneBricks::kVoxels);
        }
        return std::span(densities_).subspan(at->second * BoneBricks::kVoxels, BoneBricks::kVoxels);
    }
    void clear() {
        place_.clear();
        bricks_.clear();
        densities_.clear();
    }
    [[nodiscard]] bool empty() const { return bricks_.empty(); }
    [[nodiscard]] const std::vector<std::uint32_t>& bricks() const { return bricks_; }
    [[nodiscard]] const std::vector<std::uint8_t>& densities() const { return densities_; }

private:
    std::unordered_map<std::uint32_t, std::size_t> place_;
    std::vector<std::uint32_t> bricks_;
    std::vector<std::uint8_t> densities_;
};

class BoneKeeper {
public:
    BoneKeeper(const BoneKeeperSettings& settings, const Watched& watched,
               const std::function<void(const std::string&)>& say)
        : settings_(settings), watched_(watched), say_(say), seen_(watched.bone().head().bricks) {
        if (!settings.resumed.empty()) read_resumed();
    }

    // Copies the bricks that changed; writes those of a stroke that ended, and others after a while.
    void look() {
        DrillTopic before{};
        if (watched_.region().drill.read(before) && before.exchanging != 0 && !watched_.ended()) return;
        if (before.strokes != stroke_) write();
        stroke_ = before.strokes;
        scan();
        DrillTopic after{};
        if (watched_.region().drill.read(after)) stroke_ = after.strokes;
        known_.clear();
        if (Monotonic::now() - written_ >= kBoneWriteEvery) write();
    }
    void write() {
        written_ = Monotonic::now();
        if (waiting_.empty() || written_ < again_) return;
        try {
            if (!file_) make_file();
            file_->write(stroke_, waiting_.bricks(), waiting_.densities());
        } catch (const StartupError& e) {
            if (again_ == Instant{}) say_(e.what());
            again_ = Monotonic::now() + kTryAgain;
            return;
        }
        again_ = {};
        ++frames_;
        waiting_.clear();
    }
    [[nodiscard]] BoneKept end() {
        again_ = {};
        look();
        write();
        return {.drilled = file_.has_value(),
                .complete = waiting_.empty(),
                .strokes = stroke_,
                .frames = frames_,
                .bytes = file_ ? file_->bytes() : 0};
    }

private:
    // Whole with what it continues, or not at all.
    void make_file() {
        file_.emplace(settings_.file, head());
        if (settings_.resumed.empty()) return;
        try {
            file_->copy_frames(settings_.resumed, resumed_bytes_);
        } catch (const StartupError&) {
            file_.reset();
            std::filesystem::remove(settings_.file);
            throw;
        }
    }
    [[nodiscard]] DrilledBoneHead head() const {
        const BoneRegionHead& h = watched_.bone().head();
        BoneBricks bricks;
        std::copy(std::begin(h.size), std::end(h.size), bricks.size.begin());
        bricks.voxel_m = h.voxel_m;
        return drilled_bone_head(bricks, h.scene_checksum);
    }
    void read_resumed() {
        const SceneFile scene = SceneFile::open(watched_.region().scene_path);
        const DrilledBoneSummary sum =
            read_drilled_bone(settings_.resumed, read_bone_volume(scene),
                              watched_.bone().head().scene_checksum, [&](const DrilledBrick& b) {
                                  std::copy(b.voxels.begin(), b.voxels.end(), known_[b.brick].begin());
                              });
        resumed_bytes_ = sum.bytes;
        stroke_ = sum.strokes;
    }
    void scan() {
        const MappedBoneRegion& bone = watched_.bone();
        for (std::uint32_t i = 0; i < seen_.size(); ++i) {
            const std::uint32_t revision = bone.revision(i);
            if (revision == seen_[i]) continue;
            seen_[i] = revision;  // loaded before the copy: a later change is copied again
            Brick now;
            bone.copy_brick(i, now);
            const auto known = known_.find(i);
            if (known != known_.end() && known->second == now) continue;
            const auto to = waiting_.add(i);
            std::copy(now.begin(), now.end(), to.begin());
        }
    }

    const BoneKeeperSettings& settings_;
    const Watched& watched_;
    const std::function<void(const std::string&)>& say_;
    std::vector<std::uint32_t> seen_;
    std::unordered_map<std::uint32_t, Brick> known_;  // of the resumed file, until the first look
    std::uint64_t resumed_bytes_ = 0;
    Waiting waiting_;
    std::uint32_t stroke_ = 0;  // of what waits
    std::optional<DrilledBoneWriter> file_;
    std::uint64_t frames_ = 0;
    Instant written_{}, again_{};
};

}  // namespace

BoneKept keep_bone(const BoneKeeperSettings& settings, const std::function<void(const std::string&)>& say) {
    if (std::filesystem::exists(settings.file))
        throw StartupError("keeping drilled bone in " + settings.file.string(), "the file exists already",
                           "give another name, or remove the file");
    Watched watched(settings.session, LinkRole::observer);
    if (!await(watched, {settings.session, settings.wait_s, settings.stop}, say)) return {};
    if (watched.bone().empty())
        throw StartupError(
            "keeping drilled bone in " + settings.file.string(),
            watched.bone_refusal().empty() ? "the controller's scene has no bone" : watched.bone_refusal(),
            "start a drilling run, e.g. tact demo drill");
    BoneKeeper keeper(settings, watched, say);
    const Instant begin = Monotonic::now();
    const auto over = [&] {
        return settings.stop() ||
               (settings.seconds > 0.0 && to_s(Monotonic::now() - begin) >= settings.seconds);
    };
    while (watched.look(), !watched.ended() && !over()) {
        keeper.look();
        const Instant next = Monotonic::now() + kLookEvery;
        while (Monotonic::now() < next && !over() && (watched.look(), !watched.ended())) sleep_a_turn();
    }
    return keeper.end();
}

}  // namespace tact::record
