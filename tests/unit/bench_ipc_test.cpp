#include <gtest/gtest.h>

#include "tests/bench/bench_ipc.hpp"

namespace tact::bench_ipc_test {
namespace {

TEST(BenchIpc, every_metric_is_measured_and_no_value_is_torn) {
    const IpcBench b = bench_ipc();
    for (const Percentiles& ns : {b.publish_ns, b.publish_contended_ns, b.publish_tool_ns, b.read_ns,
                                  b.read_contended_ns, b.trace_push_ns, b.clock_ns}) {
        EXPECT_GT(ns.p50, 0.0);
        EXPECT_LE(ns.p50, ns.p99);
        EXPECT_LE(ns.p99, ns.p999);
        EXPECT_LE(ns.p999, ns.max);
    }
    EXPECT_EQ(b.torn, 0U);
    std::printf("publish %.0f ns (tool alone %.0f), contended %.0f; read %.0f, contended %.0f; trace %.0f\n",
                b.publish_ns.p50, b.publish_tool_ns.p50, b.publish_contended_ns.p50, b.read_ns.p50,
                b.read_contended_ns.p50, b.trace_push_ns.p50);
}

}  // namespace
}  // namespace tact::bench_ipc_test
