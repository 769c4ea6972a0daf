// Searches for torn reads for SECONDS: a child process writes at full speed and this one reads, then the other way round,
// through two regions at once, with records from 64 bytes to 4 KiB. Exits with 1 on the first torn, repeated or
// backward value, and prints the number of values read.
//
// usage: two_process_stress [SECONDS]
#include <fcntl.h>
#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <string>

#include "ipc/base/parent_death.hpp"
#include "ipc/shm/latest.hpp"
#include "ipc/shm/region.hpp"
#include "ipc/shm/ring.hpp"
#include "ipc/shm/topic_list.hpp"
#include "tests/stress/pattern.hpp"

namespace tact::stress {
namespace {

struct StressRegion {
    static constexpr char kName[] = "tact.stress";
    Latest<Pattern<8>> small;
    Latest<Pattern<512>> large;
    Ring<Pattern<9>, 64> ring;
    struct Topic {
        static constexpr TopicInfo kInfo{.name = "stress", .version = 1, .writer = Writer::rt};
        Pattern<512> p;
    };
    using Topics = TopicList<Topic>;
};

void write_until_killed(StressRegion& region) {
    for (std::uint64_t n = 1;; ++n) {
        region.small.publish(pattern<8>(n));
        region.ring.push(pattern<9>(n));
        if (n % 4 == 0) region.large.publish(pattern<512>(n));
    }
}

struct Tally {
    std::uint64_t reads = 0, misses = 0, torn = 0, backward = 0;
    std::uint64_t last_small = 0, last_large = 0, last_ring = 0;
    RingCursor cursor;

    template <class P>
    void judge(const P& value, std::uint64_t& last, bool may_repeat) {
        ++reads;
        torn += value.whole() ? 0 : 1;
        backward += value.number() < last || (!may_repeat && value.number() == last) ? 1 : 0;
        last = value.number();
    }
    void look(const StressRegion& region) {
        Pattern<8> small;
        Pattern<512> large;
        Pattern<9> record;
        if (region.small.read(small))
            judge(small, last_small, true);
        else
            ++misses;
        if (region.large.read(large))
            judge(large, last_large, true);
        else
            ++misses;
        for (int i = 0; i < 8 && region.ring.next(cursor, record); ++i) judge(record, last_ring, false);
    }
};

MappedRegion<StressRegion> map_again(const OwnedRegion<StressRegion>& region) {
    std::string refusal;
    auto mapped =
        MappedRegion<StressRegion>::map(FileDescriptor(fcntl(region.fd(), F_DUPFD_CLOEXEC, 0)), refusal);
    if (mapped.empty()) std::fprintf(stderr, "%s\n", refusal.c_str());
    return mapped;
}

pid_t start_writer(OwnedRegion<StressRegion>& region) {
    const pid_t parent = getpid();
    const pid_t pid = fork();
    if (pid != 0) return pid;
    if (end_with_parent(parent, SIGKILL)) write_until_killed(*region);
    _exit(0);
}

// Two writers in two other processes, and a reader of both here.
bool hunt(double seconds) {
    OwnedRegion<StressRegion> one, two;
    one.mark_ready();
    two.mark_ready();
    const auto first = map_again(one);
    const auto second = map_again(two);
    if (first.empty() || second.empty()) return false;
    const pid_t writers[] = {start_writer(one), start_writer(two)};
    Tally a, b;
    const auto end = std::chrono::steady_clock::now() + std::chrono::duration<double>(seconds);
    while (std::chrono::steady_clock::now() < end || a.reads < 1000 || b.reads < 1000) {
        for (int i = 0; i < 100; ++i) {
            a.look(*first);
            b.look(*second);
        }
    }
    for (const pid_t pid : writers) {
        kill(pid, SIGKILL);
        waitpid(pid, nullptr, 0);
    }
    const std::uint64_t written = first->small.count() + second->small.count();
    std::printf("%llu written, %llu read, %llu missed, %llu torn, %llu backward\n",
                static_cast<unsigned long long>(written), static_cast<unsigned long long>(a.reads + b.reads),
                static_cast<unsigned long long>(a.misses + b.misses),
                static_cast<unsigned long long>(a.torn + b.torn),
                static_cast<unsigned long long>(a.backward + b.backward));
    return a.torn + b.torn + a.backward + b.backward == 0;
}

}  // namespace
}  // namespace tact::stress

int main(int argc, char** argv) { return tact::stress::hunt(argc > 1 ? std::atof(argv[1]) : 2.0) ? 0 : 1; }
