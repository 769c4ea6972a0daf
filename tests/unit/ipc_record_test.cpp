// The file of a recording: data read back unchanged, the file of a killed writer can be repaired, and other files are
// refused.
#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <random>

#include "ipc/base/error.hpp"
#include "ipc/record/recording_writer.hpp"
#include "ipc/record/repair.hpp"
#include "ipc/record/without_folders.hpp"
#include "tests/support/library_leaks.hpp"

namespace tact::ipc_record_test {
namespace {

class RecordFile : public ::testing::Test {
protected:
    void SetUp() override {
        path_ = std::filesystem::temp_directory_path() /
                ("tact_record_" + std::to_string(getpid()) + "_" +
                 ::testing::UnitTest::GetInstance()->current_test_info()->name() + ".h5");
        std::filesystem::remove(path_);
    }
    void TearDown() override { std::filesystem::remove(path_); }

    static RecordingHead head() {
        RecordingHead h;
        h.start.hands = 1;
        h.start.dry_steps = 3;
        h.start.pos_world_dev_m[0] = 1.0;  // the device stands 1 m to the right
        h.start.quat_world_dev_xyzw[3] = 1.0;
        h.scene_path = "/somewhere/rod.tact";
        h.scene_checksum = 0xFEDCBA9876543210ULL;
        h.session = "test";
        h.program = "test 1";
        h.text.arguments_bytes = 4;
        std::memcpy(h.text.arguments, "abc", 4);
        std::memcpy(h.text.program, "tact-rt 1.2", 12);
        return h;
    }
    static CycleTopic cycle(std::uint64_t step) {
        CycleTopic c{};
        c.step = step;
        c.now_ns = static_cast<std::int64_t>(step) * 1'000'000;
        c.clock_ns[4] = 44;
        c.level = 0.25F;
        c.run_state = 3;
        return c;
    }
    static HandTopic hand(std::uint64_t step) {
        HandTopic h{};
        h.step = step;
        h.pos_dev_m[1] = 0.1 / 3.0;
        h.quat_dev_tool_xyzw[3] = 1.0;
        h.force_world_n[2] = 1.0 / 7.0;
        h.torque_world_n_m[0] = -2.0;
        h.deadline_check = 9;
        h.at_wall = 1;
        return h;
    }
    static void add(RecordingWriter& w, std::uint64_t from, std::uint64_t to) {
        for (std::uint64_t i = from; i <= to; ++i) {
            w.add(cycle(i));
            w.add(0, hand(i));
        }
    }
    [[nodiscard]] std::string refusal() const {
        try {
            static_cast<void>(repair_recording(path_));
        } catch (const StartupError& e) {
            return e.what();
        }
        return {};
    }

    std::filesystem::path path_;
};

TEST(RecordedPaths, keep_their_file_name_and_lose_their_folders) {
    EXPECT_EQ(without_folders("/home/anna/rod.tact"), "rod.tact");
    EXPECT_EQ(without_folders("rod.tact"), "rod.tact");
    EXPECT_EQ(without_folders("../rod.tact/"), "rod.tact");
    EXPECT_EQ(without_folders("//"), ".");
    EXPECT_EQ(without_folders(""), "");
    using namespace std::string_literals;
    EXPECT_EQ(arguments_without_folders(
                  "/home/anna/rod.tact\0--config\0/home/anna/t.toml\0--level\0docking.force=1\0"
                  "--poses=/home/anna/p.json\0--seed=3\0"s),
              "rod.tact\0--config\0t.toml\0--level\0docking.force=1\0--poses=p.json\0--seed=3\0"s);
    // Malformed arguments keep their number and lose all folders.
    EXPECT_EQ(arguments_without_folders("\0\0a/b=c/d"s), "\0\0d"s);
    EXPECT_EQ(arguments_without_folders("--a/b=c\0-=/\0--=/"s), "b=c\0-=\0--=."s);
    EXPECT_EQ(arguments_without_folders(""), "");
}

TEST_F(RecordFile, data_reads_back_exactly) {
    {
        RecordingWriter w(path_, head());
        add(w, 1, 2000);
        w.flush();
        add(w, 2001, 3000);
        MailboxTopic mailbox{};
        mailbox.step = 7;
        mailbox.kind = 1;
        mailbox.order = {.sequence = 5, .value = 0.5, .kind = 8, .index = 2, .body = 3};
        mailbox.order.pos_model_m[2] = 1e-10 / 3.0;
        w.add(mailbox);
        w.close();
    }
    const RepairReport report = repair_recording(path_);
    EXPECT_FALSE(report.needed);
    EXPECT_EQ(report.cycles, 3000U);
    EXPECT_EQ(report.last_ns, 3000'000'000);
    const Hdf5Handle file = hdf5::open_file(path_, false);
    EXPECT_EQ(hdf5::number(file.get(), "/", "scene_checksum"), 0xFEDCBA9876543210ULL);
    EXPECT_EQ(hdf5::text(file.get(), "/", "scene_path", 4096), "rod.tact");
    EXPECT_EQ(hdf5::bytes(file.get(), "/start/arguments", 100), std::string("abc\0", 4));
    EXPECT_EQ(hdf5::text(file.get(), "/", "program", 100), "test 1");
    EXPECT_EQ(hdf5::text(file.get(), "/start", "program", 100), "tact-rt 1.2");
    const auto cycles = Hdf5Table::open(file.get(), kCyclesGroup, cycle_columns(), sizeof(CycleTopic));
    ASSERT_EQ(cycles.rows(), 3000U);
    std::vector<CycleTopic> c(3);
    cycles.read(1998, 3, c.data());
    EXPECT_EQ(c[0].step, 1999U);
    EXPECT_EQ(c[2].step, 2001U);
    EXPECT_EQ(c[2].clock_ns[4], 44);
    EXPECT_EQ(c[2].level, 0.25F);
    EXPECT_EQ(c[2].run_state, 3);
    const auto hands = Hdf5Table::open(file.get(), kHandGroups[0], hand_columns(), sizeof(HandRow));
    HandRow h{};
    hands.read(2999, 1, &h);
    const HandTopic wanted = hand(3000);
    EXPECT_EQ(std::memcmp(&h.t, &wanted, sizeof wanted), 0);
    EXPECT_EQ(h.pos_world_m[0], 1.0);
    EXPECT_EQ(h.pos_world_m[1], 0.1 / 3.0);
    const auto mailboxes =
        Hdf5Table::open(file.get(), kMailboxGroup, mailbox_columns(), sizeof(MailboxTopic));
    MailboxTopic m{};
    mailboxes.read(0, 1, &m);
    EXPECT_EQ(m.order.body, 3U);
    EXPECT_EQ(m.order.pos_model_m[2], 1e-10 / 3.0);
    EXPECT_EQ(m.order.quat_model_body_xyzw[3], 1.0);
}

// Columns and groups renamed on 2026-11-25 are found in older files.
TEST_F(RecordFile, columns_and_groups_are_found_under_their_former_names) {
    const Hdf5Handle file = hdf5::create_file(path_);
    std::vector<Column> former(cycle_columns().begin(), cycle_columns().end());
    std::size_t renamed = 0;
    for (Column& c : former) {
        if (*c.former == 0) continue;
        c.name = c.former;
        ++renamed;
    }
    ASSERT_EQ(renamed, 2U);
    CycleTopic written = cycle(1);
    written.work_fraction = 0.125F;
    written.timestamps = 4;
    Hdf5Table::create(file.get(), kCyclesGroup, former, sizeof(CycleTopic)).append(&written, 1);
    MailboxTopic order{};
    order.kind = 3;
    Hdf5Table::create(file.get(), kFormerMailboxGroup, mailbox_columns(), sizeof(MailboxTopic))
        .append(&order, 1);

    CycleTopic c{};
    Hdf5Table::open(file.get(), kCyclesGroup, cycle_columns(), sizeof c).read(0, 1, &c);
    EXPECT_EQ(c.work_fraction, 0.125F);
    EXPECT_EQ(c.timestamps, 4);
    MailboxTopic m{};
    Hdf5Table::open(file.get(), mailbox_group(file.get()), mailbox_columns(), sizeof m).read(0, 1, &m);
    EXPECT_EQ(m.kind, 3U);
}

TEST_F(RecordFile, flushed_data_survives_a_killed_writer) {
    const pid_t child = fork();
    ASSERT_GE(child, 0);
    if (child == 0) {
        RecordingWriter w(path_, head());
        add(w, 1, 1500);
        w.flush();
        add(w, 1501, 1600);
        _exit(0);  // like kill -9: nothing is closed
    }
    int status = 0;
    ASSERT_EQ(waitpid(child, &status, 0), child);
    ASSERT_EQ(status, 0);
    EXPECT_TRUE(hdf5::marked_open(path_));
    const RepairReport first = repair_recording(path_);
    EXPECT_TRUE(first.needed);
    EXPECT_EQ(first.cycles, 1500U);
    EXPECT_NE(repair_text(path_, first).find("repaired, 1500 cycles"), std::string::npos);
    const RepairReport again = repair_recording(path_);
    EXPECT_FALSE(again.needed);
    EXPECT_EQ(again.cycles, 1500U);
}

TEST_F(RecordFile, columns_of_different_lengths_are_cut_to_the_shortest) {
    {
        RecordingWriter w(path_, head());
        add(w, 1, 100);
        w.close();
    }
    {
        Hdf5Handle file = hdf5::open_file(path_, true);
        hdf5::put_number(file.get(), "/", "end", 0);
        auto hands = Hdf5Table::open(file.get(), kHandGroups[0], hand_columns(), sizeof(HandRow));
        hands.cut(60);
    }
    const RepairReport report = repair_recording(path_);
    EXPECT_TRUE(report.needed);
    EXPECT_EQ(report.cycles, 60U);
    EXPECT_EQ(report.rows_cut, 40U);
    EXPECT_EQ(report.last_ns, 60'000'000);
}

TEST_F(RecordFile, the_file_of_a_running_writer_is_not_repaired) {
    RecordingWriter w(path_, head());
    add(w, 1, 10);
    w.flush();
    EXPECT_NE(refusal().find("still writing"), std::string::npos);
    add(w, 11, 20);
    w.close();
    EXPECT_EQ(repair_recording(path_).cycles, 20U);
}

TEST_F(RecordFile, an_existing_file_is_not_overwritten) {
    std::ofstream(path_) << "mine";
    EXPECT_THROW(RecordingWriter(path_, head()), StartupError);
    EXPECT_EQ(std::filesystem::file_size(path_), 4U);
}

TEST_F(RecordFile, other_files_are_refused) {
    EXPECT_NE(refusal().find("opening"), std::string::npos);
    std::ofstream(path_) << "no such thing";
    EXPECT_NE(refusal().find("is not an HDF5 file"), std::string::npos);
    std::filesystem::remove(path_);
    { const Hdf5Handle other = hdf5::create_file(path_); }
    EXPECT_NE(refusal().find("end"), std::string::npos);
}

TEST_F(RecordFile, a_truncated_or_corrupt_file_is_read_or_refused) {
    {
        RecordingWriter w(path_, head());
        add(w, 1, 50);
        w.close();
    }
    std::ifstream in(path_, std::ios::binary);
    const std::string whole((std::istreambuf_iterator<char>(in)), std::istreambuf_iterator<char>());
    std::mt19937 random(20261123);
    for (int i = 0; i < 60; ++i) {
        std::string bad = whole;
        if (i % 2 == 0)
            bad.resize(random() % whole.size());
        else
            for (int n = 0; n < 8; ++n)
                bad[(n == 0 ? random() % 64 : random()) % bad.size()] = static_cast<char>(random() & 0xFFU);
        std::ofstream(path_, std::ios::binary | std::ios::trunc) << bad;
        static_cast<void>(refusal());  // must neither crash nor hang
    }
}

}  // namespace
}  // namespace tact::ipc_record_test
