#include "tests/bench/bench_ipc.hpp"

#include <fcntl.h>

#include <algorithm>
#include <atomic>
#include <cstddef>
#include <string>
#include <thread>
#include <vector>

#include "ipc/base/clock.hpp"
#include "ipc/base/error.hpp"
#include "ipc/shm/region.hpp"
#include "ipc/topics/regions.hpp"

namespace tact {
namespace {

constexpr std::size_t kRepeats = 50'000;

template <class Work>
Percentiles measure(Work&& work) {
    std::vector<double> times_ns(kRepeats);
    for (double& ns : times_ns) {
        const Instant start = Monotonic::now();
        work();
        ns = static_cast<double>((Monotonic::now() - start).count());
    }
    return percentiles(times_ns);
}

// Writes values whose first and last numbers agree, so that a reader detects a torn value.
struct ServoSide {
    RtRegion& region;
    ToolTopic tool{};
    BodiesTopic bodies{};
    TraceTopic trace{};

    void publish_tool() noexcept {
        ++tool.cycle;
        tool.velocity_world_m_s[2] = static_cast<double>(tool.cycle);
        region.tool[0].publish(tool);
    }
    void publish_state() noexcept {
        publish_tool();
        bodies.cycle = tool.cycle;
        bodies.body[kBodiesMax - 1].quat_model_body_xyzw[3] = static_cast<double>(bodies.cycle);
        region.bodies.publish(bodies);
    }
    void push_trace() noexcept {
        ++trace.cycle;
        region.trace.push(trace);
    }
};

struct VisualSide {
    const RtRegion& region;
    ToolTopic tool{};
    BodiesTopic bodies{};
    std::uint64_t torn = 0;

    void read_state() noexcept {
        if (region.tool[0].read(tool) && tool.velocity_world_m_s[2] != static_cast<double>(tool.cycle))
            ++torn;
        if (region.bodies.read(bodies) &&
            bodies.body[kBodiesMax - 1].quat_model_body_xyzw[3] != static_cast<double>(bodies.cycle))
            ++torn;
    }
};

MappedRegion<RtRegion> map_again(const OwnedRegion<RtRegion>& region) {
    std::string refusal;
    auto mapped =
        MappedRegion<RtRegion>::map(FileDescriptor(fcntl(region.fd(), F_DUPFD_CLOEXEC, 0)), refusal);
    if (mapped.empty()) throw StartupError("measure shared memory", refusal, "free memory, or close files");
    return mapped;
}

}  // namespace

IpcBench bench_ipc() {
    OwnedRegion<RtRegion> region;
    region.mark_ready();
    const MappedRegion<RtRegion> mapped = map_again(region);
    ServoSide writer{*region};
    VisualSide reader{*mapped};
    IpcBench bench;

    measure([&] { writer.publish_state(); });  // warms up the caches and the clock
    bench.clock_ns = measure([] {});
    bench.publish_ns = measure([&] { writer.publish_state(); });
    bench.publish_tool_ns = measure([&] { writer.publish_tool(); });
    writer.publish_state();
    bench.read_ns = measure([&] { reader.read_state(); });
    bench.trace_push_ns = measure([&] { writer.push_trace(); });

    std::atomic<int> step{0};  // 0: the other thread reads; 1: it writes; 2: it exits
    std::thread other([&] {
        VisualSide other_reader{*mapped};
        while (step.load(std::memory_order_acquire) == 0) other_reader.read_state();
        bench.torn += other_reader.torn;  // read after join()
        while (step.load(std::memory_order_acquire) == 1) writer.publish_state();
    });
    bench.publish_contended_ns = measure([&] { writer.publish_state(); });
    step.store(1, std::memory_order_release);
    bench.read_contended_ns = measure([&] { reader.read_state(); });
    step.store(2, std::memory_order_release);
    other.join();
    bench.torn += reader.torn;
    return bench;
}

}  // namespace tact
