// Regions: acceptance by a reader, and all reasons for refusal.
#include <fcntl.h>
#include <gtest/gtest.h>
#include <sys/mman.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <functional>
#include <set>
#include <string>
#include <vector>

#include "ipc/shm/region_header.hpp"
#include "ipc/topics/regions.hpp"

namespace tact::ipc_region_test {
namespace {

FileDescriptor again(int fd) { return FileDescriptor(fcntl(fd, F_DUPFD_CLOEXEC, 0)); }

// The seals of a valid region, spelled out so that a change breaks this test.
constexpr int kAllSeals = F_SEAL_SHRINK | F_SEAL_GROW | F_SEAL_FUTURE_WRITE | F_SEAL_SEAL;
constexpr std::uint64_t kBytes = kRegionHeaderBytes + sizeof(GuiRegion);

struct Forged {
    std::uint64_t bytes = kBytes;
    int seals = kAllSeals;
    std::uint64_t ready = kRegionReady;
    RegionHeader header = make_region_header(region_identity<GuiRegion>(), 99);
};

FileDescriptor forge(const Forged& f) {
    FileDescriptor fd(memfd_create("forged", MFD_CLOEXEC | MFD_ALLOW_SEALING));
    EXPECT_EQ(ftruncate(fd.get(), static_cast<off_t>(f.bytes)), 0);
    std::vector<char> start(sizeof f.header + sizeof f.ready);
    std::memcpy(start.data(), &f.header, sizeof f.header);
    std::memcpy(start.data() + sizeof f.header, &f.ready, sizeof f.ready);
    EXPECT_GE(pwrite(fd.get(), start.data(), std::min<std::size_t>(start.size(), f.bytes), 0), 0);
    EXPECT_EQ(fcntl(fd.get(), F_ADD_SEALS, f.seals), 0);
    EXPECT_EQ(ftruncate(fd.get(), static_cast<off_t>(f.bytes)), 0);
    return fd;
}

std::string refusal_of(FileDescriptor fd) {
    std::string refusal = "not set";
    const auto region = MappedRegion<GuiRegion>::map(std::move(fd), refusal);
    EXPECT_EQ(region.empty(), !refusal.empty());
    return refusal;
}

TEST(Region, a_valid_region_is_accepted) { EXPECT_EQ(refusal_of(forge({})), ""); }

TEST(Region, each_header_field_is_checked_and_both_values_are_reported) {
    struct Case {
        const char* what;
        std::function<void(Forged&)> spoil;
        std::vector<std::string> words;
    };
    const std::string size = std::to_string(kBytes);
    const std::vector<Case> cases = {
        {"magic",
         [](Forged& f) { f.header.magic = 0x1F; },
         {"magic", "0x000000000000001f", "0x31304d4853544341"}},
        {"version", [](Forged& f) { f.header.version = 7; }, {"version", "7", "1", "build"}},
        {"layout",
         [](Forged& f) { f.header.layout_hash = 0xABC; },
         {"layout", "0x0000000000000abc", "build"}},
        {"content",
         [](Forged& f) { f.header.content_bytes = 12; },
         {"content size", "12", std::to_string(sizeof(GuiRegion))}},
        {"generation", [](Forged& f) { f.header.generation = 0; }, {"generation", "0"}},
        {"ready", [](Forged& f) { f.ready = 0; }, {"ready mark", "0x0000000000000000"}},
        {"name",
         [](Forged& f) { std::memcpy(f.header.name, "tact.rt\0", 8); },
         {"\"tact.rt", "\"tact.gui\""}},
        {"name without end",
         [](Forged& f) { std::memset(f.header.name, 'x', 32); },
         {"xxxx", "\"tact.gui\""}},
        {"file too small",
         [](Forged& f) { f.bytes = kBytes - 1; },
         {"file size", std::to_string(kBytes - 1), size}},
        {"file too large",
         [](Forged& f) { f.bytes = kBytes + 4096; },
         {"file size", std::to_string(kBytes + 4096), size}},
        {"file of a header only",
         [](Forged& f) { f.bytes = kRegionHeaderBytes; },
         {"file size", "256", size}},
        {"file below a header", [](Forged& f) { f.bytes = 100; }, {"file size", "100", size}},
        {"empty file", [](Forged& f) { f.bytes = 0; }, {"file size", "0", size}},
    };
    for (const Case& c : cases) {
        Forged f;
        c.spoil(f);
        const std::string refusal = refusal_of(forge(f));
        EXPECT_NE(refusal.find("region tact.gui"), std::string::npos) << c.what << ": " << refusal;
        for (const std::string& word : c.words) {
            EXPECT_NE(refusal.find(word), std::string::npos) << c.what << ": " << refusal;
        }
    }
}

TEST(Region, every_seal_is_required) {
    for (const int missing : {F_SEAL_SHRINK, F_SEAL_GROW, F_SEAL_FUTURE_WRITE, F_SEAL_SEAL}) {
        Forged f;
        f.seals = kAllSeals & ~missing;
        const std::string refusal = refusal_of(forge(f));
        EXPECT_NE(refusal.find("seals are " + std::to_string(f.seals)), std::string::npos) << refusal;
        EXPECT_NE(refusal.find("expected at least " + std::to_string(kAllSeals)), std::string::npos)
            << refusal;
    }
}

TEST(Region, other_files_than_sealed_memory_are_refused) {
    EXPECT_NE(refusal_of(FileDescriptor()), "");
    EXPECT_NE(refusal_of(FileDescriptor(12345)), "");
    EXPECT_NE(refusal_of(FileDescriptor(open("/dev/zero", O_RDWR | O_CLOEXEC))), "");
    EXPECT_NE(refusal_of(FileDescriptor(open("/proc/self/exe", O_RDONLY | O_CLOEXEC))), "");
    int ends[2];
    ASSERT_EQ(pipe(ends), 0);
    EXPECT_NE(refusal_of(FileDescriptor(ends[0])), "");
    EXPECT_NE(refusal_of(FileDescriptor(ends[1])), "");
}

TEST(Region, a_region_of_the_other_kind_is_refused_by_name) {
    OwnedRegion<RtRegion> rt;
    rt.mark_ready();
    EXPECT_NE(refusal_of(again(rt.fd())).find("\"tact.rt\""), std::string::npos);
}

TEST(Region, is_refused_until_it_is_marked_ready) {
    OwnedRegion<GuiRegion> gui;
    EXPECT_NE(refusal_of(again(gui.fd())).find("ready mark"), std::string::npos);
    gui.mark_ready();
    EXPECT_EQ(refusal_of(again(gui.fd())), "");
}

TEST(Region, a_shared_descriptor_cannot_be_written_truncated_or_made_writable) {
    OwnedRegion<GuiRegion> gui;
    gui.mark_ready();
    const FileDescriptor fd = again(gui.fd());
    EXPECT_EQ(mmap(nullptr, kBytes, PROT_READ | PROT_WRITE, MAP_SHARED, fd.get(), 0), MAP_FAILED);
    EXPECT_EQ(errno, EPERM);
    void* const map = mmap(nullptr, kBytes, PROT_READ, MAP_SHARED, fd.get(), 0);
    ASSERT_NE(map, MAP_FAILED);
    EXPECT_NE(mprotect(map, kBytes, PROT_READ | PROT_WRITE), 0);
    munmap(map, kBytes);
    const char byte = 1;
    EXPECT_EQ(pwrite(fd.get(), &byte, 1, 300), -1);
    EXPECT_NE(ftruncate(fd.get(), 0), 0);
    EXPECT_NE(ftruncate(fd.get(), 1 << 20), 0);
    EXPECT_NE(fallocate(fd.get(), FALLOC_FL_PUNCH_HOLE | FALLOC_FL_KEEP_SIZE, 0, 4096), 0);
    EXPECT_NE(fcntl(fd.get(), F_ADD_SEALS, F_SEAL_WRITE), 0);
    EXPECT_EQ(refusal_of(again(gui.fd())), "") << "still valid after the attempts";
}

TEST(Region, a_reader_gets_later_writes_and_keeps_them_after_the_writer_has_ended) {
    std::string refusal;
    MappedRegion<GuiRegion> mapped;
    std::uint64_t generation = 0;
    {
        OwnedRegion<GuiRegion> gui;
        gui.mark_ready();
        generation = gui.generation();
        mapped = MappedRegion<GuiRegion>::map(again(gui.fd()), refusal);
        ASSERT_FALSE(mapped.empty()) << refusal;
        LoadTopic load{};
        load.frame = 41;
        gui->load.publish(load);
    }
    LoadTopic load{};
    ASSERT_TRUE(mapped->load.read(load));
    EXPECT_EQ(load.frame, 41U);
    EXPECT_EQ(mapped.generation(), generation);
}

TEST(Region, generations_differ) {
    std::set<std::uint64_t> seen;
    for (int i = 0; i < 50; ++i) seen.insert(OwnedRegion<GuiRegion>().generation());
    EXPECT_EQ(seen.size(), 50U);
    EXPECT_FALSE(seen.contains(0));
}

struct Base {
    static constexpr TopicInfo kInfo{.name = "t", .version = 1, .writer = Writer::rt};
    std::uint64_t a[2];
};
struct Renamed {
    static constexpr TopicInfo kInfo{.name = "u", .version = 1, .writer = Writer::rt};
    std::uint64_t a[2];
};
struct Newer {
    static constexpr TopicInfo kInfo{.name = "t", .version = 2, .writer = Writer::rt};
    std::uint64_t a[2];
};
struct Longer {
    static constexpr TopicInfo kInfo{.name = "t", .version = 1, .writer = Writer::rt};
    std::uint64_t a[3];
};
struct alignas(64) Aligned {
    static constexpr TopicInfo kInfo{.name = "t", .version = 1, .writer = Writer::rt};
    std::uint64_t a[2];
};

TEST(Region, layout_hash_changes_with_any_topic) {
    EXPECT_NE(region_identity<RtRegion>().layout_hash, region_identity<GuiRegion>().layout_hash);
    const std::set<std::uint64_t> hashes = {TopicList<Base>::hash(),       TopicList<Renamed>::hash(),
                                            TopicList<Newer>::hash(),      TopicList<Longer>::hash(),
                                            TopicList<Aligned>::hash(),    TopicList<Base, Newer>::hash(),
                                            TopicList<Newer, Base>::hash()};
    EXPECT_EQ(hashes.size(), 7U);
}

}  // namespace
}  // namespace tact::ipc_region_test
