// Common parts of both kinds of recording: the watched controller, and the transfer of its data into a
// file.
//
// Thread  one
// Errors  StartupError
#pragma once

#include <functional>
#include <string>

#include "ipc/record/recording_writer.hpp"
#include "ipc/recorder/drain.hpp"
#include "ipc/shm/link.hpp"
#include "ipc/topics/bone_region.hpp"

namespace tact::record {

// A controller's region; stays mapped after the controller ended.
class Watched {
public:
    Watched(const std::string& session, LinkRole as) : link_(session, -1, as) {}

    // True: a controller is present, and its loop has started.
    bool look();
    [[nodiscard]] bool ended() const { return ended_; }
    [[nodiscard]] const RtRegion& region() const { return *region_; }
    [[nodiscard]] const MappedBoneRegion& bone() const { return bone_; }  // empty(): none, or refused
    [[nodiscard]] const std::string& bone_refusal() const { return bone_refusal_; }
    [[nodiscard]] std::uint64_t generation() const { return region_.generation(); }
    [[nodiscard]] std::string waiting_for() const;

private:
    LinkClient link_;
    MappedRegion<RtRegion> region_;
    MappedBoneRegion bone_;
    std::string refusal_, bone_refusal_;
    bool ended_ = false;
};

struct AwaitSettings {
    std::string session;
    double wait_s = 0.0;  // 0: no limit
    std::function<bool()> stop;
};

// Waits for a controller whose loop has started, and for its first steps. False: stopped before.
bool await(Watched& watched, const AwaitSettings& settings,
           const std::function<void(const std::string&)>& say);

// first_step: of the first rows to come; 0: unknown.
[[nodiscard]] RecordingHead head_of(const Watched& watched, const std::string& session,
                                    const std::string& program, std::uint64_t first_step);
void add(RecordingWriter& writer, const Batch& batch);
[[nodiscard]] bool disk_nearly_full(const std::filesystem::path& file, std::uint64_t least);
void sleep_a_turn();  // 5 ms

}  // namespace tact::record
