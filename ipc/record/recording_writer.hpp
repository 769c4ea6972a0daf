// Writes a recording: keeps rows in memory until flush(), which writes them so that a kill loses none of
// them.
//
// Killed   the data of the last flush() stays complete; repair.hpp clears the writer's mark
// Rows     of /cycles and of the hands correspond, one each per step; the caller ensures it
// Lock     held for the object's lifetime, so that no other process repairs the file of a running writer
// Thread   one
// Errors   StartupError if the file cannot be created, RecordError if a write fails (full disk); then call
//          abandon(): flushed data stays
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "ipc/record/rows.hpp"
#include "ipc/shm/region.hpp"
#include "ipc/topics/regions.hpp"

namespace tact {

// Data known at the start of a recording.
struct RecordingHead {
    StartTopic start{};
    RunText text{};
    LevelsTopic levels{};          // names of the paths
    std::string scene_path;        // only its file name is stored, as for paths in the arguments
    std::string session, program;  // program: with its version
    std::string cause;             // of a flight recording; empty for any other
    std::uint64_t scene_checksum = 0, generation = 0, first_step = 1;
    std::int64_t created_utc_ns = 0, created_ns = 0;  // the same instant on both clocks
};

// State of the end of a recording.
enum class RecordingEnd : std::uint64_t { open, whole, repaired };

template <class Row>
struct RowStore {
    Hdf5Table table;
    std::vector<Row> kept;
    void flush() {
        table.append(kept.data(), kept.size());
        kept.clear();
    }
};

class RecordingWriter {
public:
    RecordingWriter(const std::filesystem::path& path, const RecordingHead& head);
    ~RecordingWriter();  // closes as far as possible
    RecordingWriter(const RecordingWriter&) = delete;
    RecordingWriter& operator=(const RecordingWriter&) = delete;

    void add(const CycleTopic& row) { cycles_.kept.push_back(row); }
    void add(std::size_t hand, const HandTopic& row);
    void add(const MailboxTopic& row) { mailbox_.kept.push_back(row); }
    void add(const ReportTopic& row) { reports_.kept.push_back(row); }
    void add(const EventTopic& row) { events_.kept.push_back(row); }
    void add(const LevelsTopic& topic);
    void add(const HealthTopic& topic);
    void add(const BodiesTopic& topic);
    void add(const DropRow& row) { drops_.kept.push_back(row); }
    [[nodiscard]] std::size_t kept_rows() const { return cycles_.kept.size(); }

    void flush();
    // Regular end: writes everything and marks the file as complete.
    void close();
    void abandon() noexcept;
    [[nodiscard]] std::uint64_t cycles() const { return cycles_.table.rows(); }

private:
    void make(const RecordingHead& head);

    Hdf5Handle file_;
    FileDescriptor lock_;
    std::filesystem::path path_;
    std::uint32_t hands_;
    Pose T_world_dev_;
    RowStore<CycleTopic> cycles_;
    RowStore<HandRow> hand_[kHandsMax];
    RowStore<MailboxTopic> mailbox_;
    RowStore<ReportTopic> reports_;
    RowStore<EventTopic> events_;
    RowStore<LevelsRow> levels_;
    RowStore<HealthRow> health_;
    RowStore<BodyRow> bodies_;
    RowStore<DropRow> drops_;
};

}  // namespace tact
