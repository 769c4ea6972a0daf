#include "ipc/record/repair.hpp"

#include <fcntl.h>
#include <sys/file.h>

#include <algorithm>
#include <vector>

#include "ipc/base/error.hpp"
#include "ipc/record/recording_writer.hpp"

namespace tact {
namespace {

// A running recorder holds a shared lock; readers do too, but a file that needs no repair is not checked.
void refuse_a_living_writers(const std::filesystem::path& path) {
    const FileDescriptor file(open(path.c_str(), O_RDONLY | O_CLOEXEC));
    if (file.valid() && flock(file.get(), LOCK_EX | LOCK_NB) != 0)
        throw StartupError("repairing '" + path.string() + "'", "a recorder is still writing the file",
                           "end the recording first (Ctrl-C in its terminal)");
}

struct Cut {
    Hdf5Table table;
    bool of_a_step = false;  // has as many rows as cycles
};

}  // namespace

RepairReport repair_recording(const std::filesystem::path& path) {
    hdf5::quiet();
    RepairReport report;
    if (!std::filesystem::is_regular_file(path))
        throw StartupError("opening '" + path.string() + "'", "the file does not exist",
                           "choose a file recorded by tact record");
    try {
        const bool marked = hdf5::marked_open(path);
        if (marked) refuse_a_living_writers(path);
        Hdf5Handle file = marked ? hdf5::open_abandoned(path) : hdf5::open_file(path, false);
        const auto end = static_cast<RecordingEnd>(hdf5::number(file.get(), "/", "end"));
        if (!marked && end == RecordingEnd::open) {  // closed, but not by RecordingWriter
            file.reset();
            file = hdf5::open_file(path, true);
        }
        report.needed = marked || end == RecordingEnd::open;
        const Hdf5Id f = file.get();
        std::vector<Cut> tables;
        const auto take = [&](const char* group, std::span<const Column> columns, std::size_t bytes,
                              bool of_a_step = false) {
            tables.push_back({Hdf5Table::open(f, group, columns, bytes), of_a_step});
        };
        take(kCyclesGroup, cycle_columns(), sizeof(CycleTopic), true);
        for (const char* const group : kHandGroups)
            if (Hdf5Table::exists(f, group)) take(group, hand_columns(), sizeof(HandRow), true);
        take(mailbox_group(f), mailbox_columns(), sizeof(MailboxTopic));
        take(kReportsGroup, report_columns(), sizeof(ReportTopic));
        take(kEventsGroup, event_columns(), sizeof(EventTopic));
        take(kLevelsGroup, levels_columns(), sizeof(LevelsRow));
        take(kHealthGroup, health_columns(), sizeof(HealthRow));
        take(kBodiesGroup, body_columns(), sizeof(BodyRow));
        take(kDropsGroup, drop_columns(), sizeof(DropRow));
        report.cycles = tables.front().table.rows();
        for (const Cut& c : tables)
            if (c.of_a_step) report.cycles = std::min(report.cycles, c.table.rows());
        if (report.needed) {
            for (Cut& c : tables) {
                const std::uint64_t rows = c.of_a_step ? report.cycles : c.table.rows();
                report.rows_cut += c.table.rows_most() - rows;
                if (c.table.rows_most() != rows) c.table.cut(rows);
            }
            hdf5::put_number(f, "/", "end", static_cast<std::uint64_t>(RecordingEnd::repaired));
            hdf5::put_number(f, "/", "repaired_rows_cut", report.rows_cut);
        }
        if (report.cycles > 0) {
            CycleTopic last{};
            tables.front().table.read(report.cycles - 1, 1, &last);
            report.last_ns = last.now_ns;
        }
    } catch (const RecordError& e) {
        throw StartupError(
            "repairing '" + path.string() + "'", e.what(),
            "choose a file recorded by tact record; a file that cannot be repaired stays unchanged");
    }
    return report;
}

std::string repair_text(const std::filesystem::path& path, const RepairReport& r) {
    std::string text = path.string();
    text.append(r.needed ? ": its recorder ended unexpectedly; repaired, " : ": complete, ");
    text.append(std::to_string(r.cycles)).append(" cycles");
    if (r.rows_cut > 0)
        text.append("; ").append(std::to_string(r.rows_cut)).append(" incomplete rows removed");
    return text;
}

}  // namespace tact
