// Reads a complete recording step by step in blocks: memory does not depend on its length.
//
// Repairs   first, if its recorder was killed; about().repair has the result
// Input     untrusted: every number may have any value; counts are bounded, and the user of a text makes it
//           printable. A file that is not a recording is refused.
// Thread    one
// Errors    StartupError (opening), RecordError (further reading)
#pragma once

#include <filesystem>
#include <optional>
#include <vector>

#include "ipc/record/repair.hpp"
#include "ipc/record/rows.hpp"
#include "ipc/topics/regions.hpp"

namespace tact {

// Rows of one table in order, read in blocks.
template <class Row>
class RowStream {
public:
    static constexpr std::size_t kBlock = 4096;

    RowStream() = default;
    explicit RowStream(Hdf5Table table) : table_(std::move(table)) {}
    [[nodiscard]] std::uint64_t rows() const { return table_.rows(); }
    // Null: no more rows. Valid until next() enters another block.
    const Row* peek() {
        if (at_ < block_.size()) return &block_[at_];
        const std::uint64_t left = table_.rows() - done_;
        if (left == 0) return nullptr;
        block_.resize(static_cast<std::size_t>(left < kBlock ? left : kBlock));
        table_.read(done_, block_.size(), block_.data());
        done_ += block_.size();
        at_ = 0;
        return &block_[0];
    }
    void next() { ++at_; }
    // False: there are no rows.
    bool last(Row& row) const {
        if (table_.rows() == 0) return false;
        table_.read(table_.rows() - 1, 1, &row);
        return true;
    }

private:
    Hdf5Table table_;
    std::vector<Row> block_;
    std::size_t at_ = 0;
    std::uint64_t done_ = 0;
};

// All inputs of one step, and its results.
struct RecordedStep {
    CycleTopic cycle{};
    HandRow hand[kHandsMax]{};
    std::vector<MailboxTopic> mailbox;
    std::optional<ReportTopic> report;
};

class RecordingReader {
public:
    explicit RecordingReader(const std::filesystem::path& path);

    struct About {
        StartTopic start{};
        std::vector<std::string> arguments;  // of the controller
        std::string config, poses, scene_path, program;
        std::string controller;  // the program that computed the forces; "" in files from before 2026-11-24
        bool known = false;      // all of those are present
        std::uint64_t scene_checksum = 0, first_step = 0, cycles = 0, dropped = 0;
        std::int64_t begin_ns = 0, end_ns = 0;  // times of the first and the last cycle
        RepairReport repair;
    };
    [[nodiscard]] const About& about() const { return about_; }
    // False: no more steps. Mailbox entries of missing steps come with the next existing step.
    bool next(RecordedStep& step);

    [[nodiscard]] RowStream<EventTopic>& events() { return events_; }

private:
    void read_about(const std::filesystem::path& path);

    Hdf5Handle file_;
    About about_;
    RowStream<CycleTopic> cycles_;
    RowStream<HandRow> hand_[kHandsMax];
    RowStream<MailboxTopic> mailbox_;
    RowStream<ReportTopic> reports_;
    RowStream<EventTopic> events_;
};

}  // namespace tact
