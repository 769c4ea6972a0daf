#include "ipc/recorder/watched.hpp"

#include <poll.h>
#include <sys/statvfs.h>

#include <cstring>
#include <ctime>

#include "ipc/base/clock.hpp"
#include "ipc/base/error.hpp"

namespace tact::record {
namespace {

std::int64_t utc_ns() {
    timespec ts{};
    clock_gettime(CLOCK_REALTIME, &ts);
    return std::int64_t{ts.tv_sec} * 1'000'000'000 + ts.tv_nsec;
}

}  // namespace

bool Watched::look() {
    LinkClient::News news = link_.poll();
    if (region_.empty() && news.arrived) {
        region_ = MappedRegion<RtRegion>::map(std::move(news.rt_fd), refusal_);
        if (news.bone_fd.valid()) bone_ = MappedBoneRegion::map(std::move(news.bone_fd), bone_refusal_);
    } else if (!region_.empty() && (news.left || news.arrived)) {
        ended_ = true;  // the region of another controller does not belong to this recording
    }
    return !region_.empty() && region_->start.count() > 0;
}
std::string Watched::waiting_for() const {
    if (!refusal_.empty()) return refusal_;
    return region_.empty() ? link_.status_text() : "waiting for the controller's loop to start";
}

RecordingHead head_of(const Watched& watched, const std::string& session, const std::string& program,
                      std::uint64_t first_step) {
    const RtRegion& region = watched.region();
    RecordingHead head;
    static_cast<void>(region.start.read(head.start));
    static_cast<void>(region.levels.read(head.levels));
    head.text = region.run_text;
    head.scene_path.assign(region.scene_path, strnlen(region.scene_path, sizeof region.scene_path));
    head.scene_checksum = region.scene_checksum;
    head.session = session;
    head.program = program;
    head.generation = watched.generation();
    head.first_step = first_step;
    head.created_ns = to_ns(Monotonic::now());
    head.created_utc_ns = utc_ns();
    return head;
}

void add(RecordingWriter& writer, const Batch& batch) {
    for (const auto& row : batch.mailbox) writer.add(row);
    for (const auto& row : batch.reports) writer.add(row);
    for (std::size_t h = 0; h < kHandsMax; ++h)
        for (const auto& row : batch.hand[h]) writer.add(h, row);
    for (const auto& row : batch.cycles) writer.add(row);
    for (const auto& row : batch.events) writer.add(row);
    for (const auto& row : batch.levels) writer.add(row);
    for (const auto& row : batch.health) writer.add(row);
    for (const auto& row : batch.bodies) writer.add(row);
    for (const auto& row : batch.drops) writer.add(row);
}

bool disk_nearly_full(const std::filesystem::path& file, std::uint64_t least) {
    struct statvfs fs {};
    if (statvfs(file.c_str(), &fs) != 0) return false;
    return std::uint64_t{fs.f_bavail} * fs.f_frsize < least;
}

bool await(Watched& watched, const AwaitSettings& settings,
           const std::function<void(const std::string&)>& say) {
    const Instant begin = Monotonic::now();
    std::string said;
    while (!watched.look() || watched.region().cycles.pushed() == 0) {
        if (settings.stop()) return false;
        if (std::string now = watched.waiting_for(); now != said) say(said = std::move(now));
        if (settings.wait_s > 0.0 && to_s(Monotonic::now() - begin) > settings.wait_s)
            throw StartupError("recording session '" + settings.session + "'", watched.waiting_for(),
                               "start a run in this session, e.g. tact demo dock");
        sleep_a_turn();
    }
    return true;
}

void sleep_a_turn() { ::poll(nullptr, 0, 5); }

}  // namespace tact::record
