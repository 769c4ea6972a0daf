#include "ipc/record/recording_reader.hpp"

#include <cstring>

#include "ipc/base/error.hpp"

namespace tact {
namespace {

constexpr std::size_t kPathMax = 4096;

}  // namespace

RecordingReader::RecordingReader(const std::filesystem::path& path) {
    about_.repair = repair_recording(path);
    file_ = hdf5::open_file(path, false);
    try {
        read_about(path);
    } catch (const RecordError& e) {
        throw StartupError("reading '" + path.string() + "'", e.what(),
                           "choose a file recorded by tact record");
    }
}

void RecordingReader::read_about(const std::filesystem::path& path) {
    const Hdf5Id f = file_.get();
    if (hdf5::text(f, "/", "format", 64) != kRecordingFormat)
        throw RecordError("the file is not marked as a recording");
    const std::uint64_t version = hdf5::number(f, "/", "version");
    if (version != kRecordingVersion ||
        hdf5::number(f, "/start", "loop_version") != StartTopic::kInfo.version)
        throw StartupError("reading '" + path.string() + "'",
                           "the file has version " + std::to_string(version) +
                               ", this program reads version " + std::to_string(kRecordingVersion),
                           "use the program named in the file's attribute 'program'");
    const std::string start = hdf5::bytes(f, "/start/loop", sizeof(StartTopic));
    if (start.size() != sizeof(StartTopic)) throw RecordError("its start data is incomplete");
    std::memcpy(&about_.start, start.data(), start.size());
    if (about_.start.hands < 1 || about_.start.hands > kHandsMax)
        throw RecordError("it has " + std::to_string(about_.start.hands) + " hands");
    for (StartDevice& d : about_.start.device) d.name[sizeof d.name - 1] = 0;
    about_.known = hdf5::number(f, "/start", "known") == 1;
    if (hdf5::has(f, "/start", "program")) about_.controller = hdf5::text(f, "/start", "program", kPathMax);
    const std::string arguments = hdf5::bytes(f, "/start/arguments", RunText::kArgumentsMax);
    for (std::size_t at = 0; at < arguments.size();) {
        about_.arguments.emplace_back(arguments.c_str() + at);
        at += about_.arguments.back().size() + 1;
    }
    about_.config = hdf5::bytes(f, "/start/config", RunText::kConfigMax);
    about_.poses = hdf5::bytes(f, "/start/poses", RunText::kPosesMax);
    about_.scene_path = hdf5::text(f, "/", "scene_path", kPathMax);
    about_.program = hdf5::text(f, "/", "program", kPathMax);
    about_.scene_checksum = hdf5::number(f, "/", "scene_checksum");
    about_.first_step = hdf5::number(f, "/", "first_step");

    cycles_ = RowStream<CycleTopic>(Hdf5Table::open(f, kCyclesGroup, cycle_columns(), sizeof(CycleTopic)));
    about_.cycles = cycles_.rows();
    if (CycleTopic last{}; cycles_.last(last)) {
        about_.begin_ns = cycles_.peek()->now_ns;
        about_.end_ns = last.now_ns;
    }
    for (std::uint32_t i = 0; i < about_.start.hands; ++i) {
        hand_[i] = RowStream<HandRow>(Hdf5Table::open(f, kHandGroups[i], hand_columns(), sizeof(HandRow)));
        if (hand_[i].rows() != about_.cycles)
            throw RecordError("the numbers of rows of its hands and cycles differ");
    }
    mailbox_ = RowStream<MailboxTopic>(
        Hdf5Table::open(f, mailbox_group(f), mailbox_columns(), sizeof(MailboxTopic)));
    reports_ =
        RowStream<ReportTopic>(Hdf5Table::open(f, kReportsGroup, report_columns(), sizeof(ReportTopic)));
    events_ = RowStream<EventTopic>(Hdf5Table::open(f, kEventsGroup, event_columns(), sizeof(EventTopic)));
    RowStream<DropRow> drops(Hdf5Table::open(f, kDropsGroup, drop_columns(), sizeof(DropRow)));
    for (const DropRow* d = drops.peek(); d != nullptr; drops.next(), d = drops.peek())
        about_.dropped += d->records;
}

bool RecordingReader::next(RecordedStep& step) {
    const CycleTopic* const cycle = cycles_.peek();
    if (cycle == nullptr) return false;
    step.cycle = *cycle;
    cycles_.next();
    for (std::uint32_t i = 0; i < about_.start.hands; ++i) {
        const HandRow* const hand = hand_[i].peek();
        if (hand == nullptr || hand->t.step != step.cycle.step)
            throw RecordError("step " + std::to_string(step.cycle.step) + " lacks hand " + std::to_string(i));
        step.hand[i] = *hand;
        hand_[i].next();
    }
    step.mailbox.clear();
    for (const MailboxTopic* m = mailbox_.peek(); m != nullptr && m->step <= step.cycle.step;
         m = mailbox_.peek()) {
        step.mailbox.push_back(*m);
        mailbox_.next();
    }
    step.report.reset();
    for (const ReportTopic* r = reports_.peek(); r != nullptr && r->step <= step.cycle.step;
         r = reports_.peek()) {
        step.report = *r;
        reports_.next();
    }
    return true;
}

}  // namespace tact
