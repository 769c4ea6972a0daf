#include <gtest/gtest.h>

#include "tests/bench/bench_ipc.hpp"

namespace tact {
namespace {

TEST(BenchIpc, every_metric_is_measured_and_no_value_is_torn) {
    const IpcBench b = bench_ipc();
    for (const double ns : {b.publish_ns_p50, b.publish_contended_ns_p50, b.publish_tool_ns_p50,
                            b.read_ns_p50, b.read_contended_ns_p50, b.trace_push_ns_p50}) {
        EXPECT_GT(ns, 0.0);
    }
    EXPECT_GE(b.publish_ns_max, b.publish_ns_p50);
    EXPECT_EQ(b.torn, 0U);
    std::printf(
        "publish %.1f ns (tool alone %.1f), contended %.1f, max %.1f; read %.1f, contended %.1f; trace "
        "%.1f\n",
        b.publish_ns_p50, b.publish_tool_ns_p50, b.publish_contended_ns_p50, b.publish_ns_max, b.read_ns_p50,
        b.read_contended_ns_p50, b.trace_push_ns_p50);
}

}  // namespace
}  // namespace tact
