// The parts of MeshCut: kernels, marks of changes, triangle order.
#include <gtest/gtest.h>
#include <rapidcheck.h>

#include <algorithm>
#include <array>
#include <numeric>
#include <vector>

#include "ipc/base/random.hpp"
#include "ipc/scene/mesh/changed_blocks.hpp"
#include "ipc/scene/mesh/mesh_kernels.hpp"
#include "ipc/scene/mesh/vertex_cache.hpp"

namespace tact::test::scene_mesh_parts_test {
namespace {

TEST(MeshKernels, all_instruction_sets_give_the_same) {
    const MeshKernels& slow = kMeshKernels[kMeshKernelCount - 1];
    ASSERT_STREQ(slow.name, "generic");
    SeededRandom random(3);
    for (std::size_t kernel = 0; kernel + 1 < kMeshKernelCount; ++kernel) {
        const MeshKernels& fast = kMeshKernels[kernel];
        if (!fast.runs_here()) continue;
        for (std::uint32_t size = 0; size < 100; ++size) {
            std::vector<std::uint32_t> level;
            for (std::uint32_t i = 0; i <= size; ++i)
                level.push_back(random.below(3) == 0 ? UINT32_MAX
                                                     : static_cast<std::uint32_t>(random.below(9)));
            std::vector<std::uint32_t> a(size + 1 + kListSlack), b(a);
            const std::uint32_t count = slow.list_versions(level.data(), size, 5, a.data());
            ASSERT_EQ(fast.list_versions(level.data(), size, 5, b.data()), count);
            ASSERT_TRUE(std::equal(a.begin(), a.begin() + count, b.begin()));

            const std::vector<std::uint32_t> vertex{7, 8, 9, 7, 8, 1};
            std::vector<std::uint16_t> corner;
            for (std::uint32_t i = 0; i < 3 * size; ++i)
                corner.push_back(static_cast<std::uint16_t>(random.below(vertex.size())));
            std::vector<std::uint32_t> to(3 * size), other(3 * size);
            slow.look_up(corner.data(), size, vertex.data(), to.data(), false);
            fast.look_up(corner.data(), size, vertex.data(), other.data(), false);
            ASSERT_EQ(to, other);
            alignas(64) std::array<std::uint32_t, 301> past{};
            for (const std::size_t first : {0U, 1U}) {  // aligned to a cache line and not
                fast.look_up(corner.data(), size, vertex.data(), &past[first], true);
                ASSERT_TRUE(std::equal(to.begin(), to.end(), &past[first]));
            }

            std::vector<std::uint32_t> parent;
            const std::uint32_t first = 1 + static_cast<std::uint32_t>(random.below(50));
            for (std::uint32_t i = 0; i < 3 * size; ++i)
                parent.push_back(static_cast<std::uint32_t>(random.below(first + i)));
            slow.follow(parent.data(), first, 3 * size, to.data());
            fast.follow(parent.data(), first, 3 * size, other.data());
            ASSERT_EQ(to, other);
            for (const std::uint32_t v : to) ASSERT_LT(v, first);
        }
    }
}

TEST(ChangedBlocks, report_marked_blocks_and_join_small_gaps) {
    rc::check([] {
        const auto elements = *rc::gen::inRange<std::size_t>(1, 3000);
        ChangedBlocks changed(elements, 2, 3);
        for (int round = 0; round < 2; ++round) {
            std::vector<bool> block(elements / 4 + 1);
            const auto marks = *rc::gen::inRange(0, 20);
            for (int i = 0; i < marks; ++i) {
                const auto a = *rc::gen::inRange<std::size_t>(0, elements);
                const auto b = *rc::gen::inRange<std::size_t>(a, std::min(elements, a + 600) + 1);
                changed.mark(a, b);
                for (std::size_t k = a; k < b; ++k) block[k / 4] = true;
                changed.mark(a);
                block[a / 4] = true;
                if (a + 2 < elements) {
                    changed.mark_triangle(a);
                    block[(a + 2) / 4] = true;
                }
            }
            std::vector<bool> reported(block.size());
            std::size_t end = 0;
            for (const MeshRange r : changed.take()) {
                RC_ASSERT(r.first % 4 == 0U && r.count > 0U && r.first + r.count <= elements);
                RC_ASSERT(end == 0 || r.first > end + 3 * 4);  // otherwise they would be joined
                end = r.first + r.count;
                RC_ASSERT(block[r.first / 4] && block[(end - 1) / 4]);
                for (std::size_t k = r.first / 4; 4 * k < end; ++k) reported[k] = true;
            }
            std::size_t gap = 0;
            for (std::size_t k = 0; k < block.size(); ++k) {
                RC_ASSERT(!block[k] || reported[k]);
                gap = block[k] || !reported[k] ? 0 : gap + 1;
                RC_ASSERT(gap <= 3U);
            }
        }
    });
}

TEST(ChangedBlocks, are_unsettled_from_their_mark_until_they_are_settled_without_one) {
    ChangedBlocks changed(1000, 2, 3);  // 250 blocks
    EXPECT_EQ(changed.unsettled_blocks(), 0U);
    changed.mark(8);
    changed.mark(4 * 70, 4 * 72);
    EXPECT_EQ(changed.unsettled(0), std::uint64_t{1} << 2);
    EXPECT_EQ(changed.unsettled(1), std::uint64_t{3} << 6);
    changed.settle();  // these marks still have to be sent, so they stay
    EXPECT_EQ(changed.unsettled_blocks(), 3U);
    EXPECT_EQ(changed.take().size(), 2U);
    EXPECT_EQ(changed.unsettled_blocks(), 3U);
    changed.settle();
    EXPECT_EQ(changed.unsettled_blocks(), 0U);
    EXPECT_TRUE(changed.take().empty());
    changed.send_all();
    const auto all = changed.take();
    ASSERT_EQ(all.size(), 1U);
    EXPECT_EQ(all[0], (MeshRange{0, 1000}));
    EXPECT_EQ(changed.unsettled_blocks(), 0U);
    EXPECT_EQ(changed.unsettled(1000), 0U);  // past the end
}

TEST(CacheOrder, holds_every_triangle_once) {
    CacheOrder order;
    rc::check([&] {
        const auto vertices = *rc::gen::inRange<std::size_t>(1, 60);
        const auto corner = *rc::gen::container<std::vector<std::uint16_t>>(
            rc::gen::inRange<std::uint16_t>(0, static_cast<std::uint16_t>(vertices)));
        const std::size_t count = corner.size() / 3;
        const auto got = order.run(std::span(corner).first(3 * count), vertices);
        std::vector<std::uint16_t> sorted(got.begin(), got.end()), all(count);
        std::sort(sorted.begin(), sorted.end());
        std::iota(all.begin(), all.end(), std::uint16_t{0});
        RC_ASSERT(sorted == all);
    });
}

}  // namespace
}  // namespace tact::test::scene_mesh_parts_test
