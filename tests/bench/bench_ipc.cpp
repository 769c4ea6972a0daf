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

constexpr std::size_t kBatches = 400;
constexpr std::size_t kPerBatch = 200;

struct Times {
    double p50_ns = 0.0, max_ns = 0.0;
};

template <class Work>
Times measure(Work&& work) {
    std::vector<double> batch_ns(kBatches);
    for (double& ns : batch_ns) {
        const Instant start = Monotonic::now();
        for (std::size_t i = 0; i < kPerBatch; ++i) work();
        ns = static_cast<double>((Monotonic::now() - start).count()) / static_cast<double>(kPerBatch);
    }
    std::sort(batch_ns.begin(), batch_ns.end());
    return {batch_ns[kBatches / 2], batch_ns.back()};
}

// Values whose first and last numbers agree, so that a reader detects a torn one.
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

    measure([&] { writer.publish_state(); });  // warms up caches and clocks
    const Times publish = measure([&] { writer.publish_state(); });
    bench.publish_ns_p50 = publish.p50_ns;
    bench.publish_ns_max = publish.max_ns;
    bench.publish_tool_ns_p50 = measure([&] { writer.publish_tool(); }).p50_ns;
    writer.publish_state();
    bench.read_ns_p50 = measure([&] { reader.read_state(); }).p50_ns;
    bench.trace_push_ns_p50 = measure([&] { writer.push_trace(); }).p50_ns;

    std::atomic<int> step{0};  // 0: the other thread reads; 1: it writes; 2: it ends
    std::thread other([&] {
        VisualSide other_reader{*mapped};
        while (step.load(std::memory_order_acquire) == 0) other_reader.read_state();
        bench.torn += other_reader.torn;  // read after join()
        while (step.load(std::memory_order_acquire) == 1) writer.publish_state();
    });
    bench.publish_contended_ns_p50 = measure([&] { writer.publish_state(); }).p50_ns;
    step.store(1, std::memory_order_release);
    bench.read_contended_ns_p50 = measure([&] { reader.read_state(); }).p50_ns;
    step.store(2, std::memory_order_release);
    other.join();
    bench.torn += reader.torn;
    return bench;
}

}  // namespace tact
