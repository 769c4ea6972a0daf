#include "ipc/scene/mesh/mesh_cut.hpp"

#include <gtest/gtest.h>
#include <rapidcheck.h>

#include <cstdlib>
#include <cstring>
#include <deque>
#include <new>
#include <utility>

#include "ipc/base/random.hpp"
#include "ipc/scene/density/isosurface.hpp"
#include "prep/mesh/progressive.hpp"
#include "tests/unit/prep_mesh_fixtures.hpp"

namespace {
std::size_t allocations = 0;
}
// Counts every allocation of this program. Not inlined: otherwise the compiler pairs new with free and warns.
[[gnu::noinline]] void* operator new(std::size_t size) {
    ++allocations;
    if (void* p = std::malloc(size == 0 ? 1 : size)) return p;
    throw std::bad_alloc();
}
[[gnu::noinline]] void* operator new(std::size_t size, const std::nothrow_t&) noexcept {
    ++allocations;
    return std::malloc(size == 0 ? 1 : size);
}
[[gnu::noinline]] void operator delete(void* p) noexcept { std::free(p); }
[[gnu::noinline]] void operator delete(void* p, std::size_t) noexcept { std::free(p); }

namespace tact::test {
namespace {

const ProgressiveMeshData& torus_data() {
    static const ProgressiveMeshData data = make_progressive(isosurface(sampled(33, torus), -0.25));
    return data;
}
const ProgressiveMesh& torus_mesh() {
    static const ProgressiveMesh mesh(torus_data());
    return mesh;
}

// The slow reference: contracts one vertex at a time from the original, by definition.
struct Reference {
    std::vector<PackedVertex> vertex;
    std::vector<std::uint32_t> index;
};
Reference reference(const ProgressiveMeshData& data, std::uint32_t level) {
    Reference r{{}, data.triangle};
    for (const MeshVertex& v : data.vertex) r.vertex.push_back(pack(v));
    for (std::uint32_t v = static_cast<std::uint32_t>(data.vertex.size()); v-- > level;) {
        const std::size_t k = v - data.base_vertices;
        r.vertex[data.parent[k]] = pack(data.merged[k]);
        for (std::uint32_t& corner : r.index) corner = corner == v ? data.parent[k] : corner;
    }
    r.vertex.resize(level);
    r.index.resize(std::size_t{3} * data.triangle_count[level - data.base_vertices]);
    return r;
}

// Walks one contraction or split at a time, from a list of the corners at each vertex and a record of what each
// contraction replaced.
class Walker {
public:
    explicit Walker(const ProgressiveMeshData& data)
        : data_(&data),
          level_(static_cast<std::uint32_t>(data.vertex.size())),
          corners_(data.vertex.size()),
          replaced_(data.parent.size()),
          now_{{}, data.triangle} {
        for (const MeshVertex& v : data.vertex) now_.vertex.push_back(pack(v));
        for (std::size_t c = 0; c < data.triangle.size(); ++c) corners_[data.triangle[c]].push_back(c);
    }
    const Reference& walk_to(std::uint32_t level) {
        while (level_ > level) contract();
        while (level_ < level) split();
        shown_.vertex.assign(now_.vertex.begin(), now_.vertex.begin() + level);
        shown_.index.assign(now_.index.begin(),
                            now_.index.begin() + 3 * data_->triangle_count[level - data_->base_vertices]);
        return shown_;
    }

private:
    void contract() {
        const std::uint32_t v = --level_, k = v - data_->base_vertices, parent = data_->parent[k];
        replaced_[k] = {now_.vertex[parent], corners_[parent].size()};
        now_.vertex[parent] = pack(data_->merged[k]);
        for (const std::size_t c : corners_[v]) now_.index[c] = parent;
        corners_[parent].insert(corners_[parent].end(), corners_[v].begin(), corners_[v].end());
    }
    void split() {
        const std::uint32_t v = level_++, k = v - data_->base_vertices, parent = data_->parent[k];
        now_.vertex[parent] = replaced_[k].first;
        corners_[parent].resize(replaced_[k].second);
        for (const std::size_t c : corners_[v]) now_.index[c] = v;
    }

    const ProgressiveMeshData* data_;
    std::uint32_t level_;
    std::vector<std::vector<std::size_t>> corners_;
    std::vector<std::pair<PackedVertex, std::size_t>> replaced_;  // vertex and corners of the parent
    Reference now_, shown_;
};

using Triangle = std::array<std::uint32_t, 3>;
std::vector<Triangle> triangles(std::span<const std::uint32_t> index) {
    std::vector<Triangle> all;
    for (std::size_t c = 0; c + 2 < index.size(); c += 3) {
        const Triangle t{index[c], index[c + 1], index[c + 2]};
        if (t[0] != t[1] || t[1] != t[2]) all.push_back(t);
    }
    std::sort(all.begin(), all.end());
    return all;
}
std::vector<std::uint32_t> drawn(const MeshCut& cut) {
    std::vector<std::uint32_t> index;
    for (const MeshRange r : cut.draws()) {
        const auto part = cut.index().subspan(r.first, r.count);
        index.insert(index.end(), part.begin(), part.end());
    }
    return index;
}
std::span<const PackedVertex> shown(const MeshCut& cut) { return cut.vertex().first(cut.vertices()); }

bool same(const MeshCut& cut, const Reference& r) {
    const auto vertex = shown(cut);
    return std::equal(vertex.begin(), vertex.end(), r.vertex.begin(), r.vertex.end()) &&
           triangles(drawn(cut)) == triangles(r.index);
}
bool same(const MeshCut& a, const MeshCut& b) {
    return a.vertices() == b.vertices() &&
           std::equal(a.draws().begin(), a.draws().end(), b.draws().begin()) &&
           std::memcmp(a.vertex().data(), b.vertex().data(), shown(a).size_bytes()) == 0 &&
           drawn(a) == drawn(b);
}

// Buffers of a viewer that uploads only the changes.
struct Mirror {
    explicit Mirror(const MeshCut& cut)
        : vertex(cut.vertex().size()), index(cut.index().size(), UINT32_MAX) {}
    // Returns the bytes sent.
    std::size_t upload(MeshCut& cut) {
        const MeshChanges changes = cut.changes();
        std::size_t sent = 0;
        for (const MeshRange r : changes.vertex) {
            std::copy_n(cut.vertex().begin() + r.first, r.count, vertex.begin() + r.first);
            sent += sizeof(PackedVertex) * r.count;
        }
        for (const MeshRange r : changes.index) {
            std::copy_n(cut.index().begin() + r.first, r.count, index.begin() + r.first);
            sent += sizeof(std::uint32_t) * r.count;
        }
        return sent;
    }
    [[nodiscard]] bool shows(const MeshCut& cut) const {
        for (const MeshRange r : cut.draws()) {
            if (!std::equal(cut.index().begin() + r.first, cut.index().begin() + r.first + r.count,
                            index.begin() + r.first))
                return false;
        }
        return std::equal(shown(cut).begin(), shown(cut).end(), vertex.begin());
    }
    std::vector<PackedVertex> vertex;
    std::vector<std::uint32_t> index;
};

// Random triangles and contractions of any two vertices: no surface, and contracted vertices need no edge.
ProgressiveMeshData soup(std::uint32_t vertices, std::uint32_t base, std::uint32_t triangle_count,
                         std::uint64_t seed) {
    SeededRandom random(seed);
    ProgressiveMeshData d;
    d.base_vertices = base;
    const auto vertex = [&] {
        MeshVertex v{{}, {0, 0, 32767, 0}};
        for (float& x : v.position_m) x = static_cast<float>(random.uniform());
        return v;
    };
    for (std::uint32_t v = 0; v < vertices; ++v) d.vertex.push_back(vertex());
    for (std::uint32_t v = base; v < vertices; ++v) {
        d.parent.push_back(static_cast<std::uint32_t>(random.below(v)));
        d.merged.push_back(vertex());
        d.error_m.push_back(static_cast<float>(vertices - v));
    }
    d.error_m.push_back(0.0F);
    std::vector<std::pair<std::uint32_t, Triangle>> born;
    while (born.size() < triangle_count) {
        Triangle t;
        for (std::uint32_t& v : t) v = static_cast<std::uint32_t>(random.below(vertices));
        if (t[0] == t[1] || t[1] == t[2] || t[2] == t[0]) continue;
        std::uint32_t level = vertices;
        for (Triangle now = t; level > base; --level) {
            for (std::uint32_t& v : now) v = v == level - 1 ? d.parent[level - 1 - base] : v;
            if (now[0] == now[1] || now[1] == now[2] || now[2] == now[0]) break;
        }
        born.emplace_back(level, t);
    }
    std::sort(born.begin(), born.end());
    for (const auto& [level, t] : born) d.triangle.insert(d.triangle.end(), t.begin(), t.end());
    for (std::uint32_t level = base; level <= vertices; ++level)
        d.triangle_count.push_back(static_cast<std::uint32_t>(
            std::count_if(born.begin(), born.end(), [&](const auto& b) { return b.first <= level; })));
    return d;
}

TEST(MeshCut, any_sequence_of_levels_ends_in_the_state_of_the_reference) {
    const ProgressiveMeshData torus_15 = make_progressive(isosurface(sampled(15, torus), -0.25));
    const ProgressiveMeshData any = soup(300, 7, 500, 1);
    for (const ProgressiveMeshData& data : {torus_15, any}) {
        const ProgressiveMesh mesh(data);
        rc::check([&] {
            MeshCut cut(mesh);
            Mirror mirror(cut);
            auto levels = *rc::gen::container<std::vector<std::uint32_t>>(
                rc::gen::inRange(mesh.vertices_min(), mesh.vertices() + 1));
            levels.resize(std::min<std::size_t>(levels.size(), 12));  // the reference is slow
            for (const std::uint32_t level : levels) {
                RC_ASSERT(cut.set_vertices(level) == level);
                // A near level as well, so that single steps are used.
                RC_ASSERT(cut.set_vertices(std::max(level, mesh.vertices_min() + 5) - 5) <= level);
                RC_ASSERT(same(cut, reference(data, cut.vertices())));
                mirror.upload(cut);
                RC_ASSERT(mirror.shows(cut));
            }
        });
    }
}

TEST(MeshCut, single_steps_and_rebuilds_agree_exactly) {
    // Ten thousand triangles form three patches; the second mesh is not a surface.
    for (const ProgressiveMesh& mesh :
         {ProgressiveMesh(torus_data()), ProgressiveMesh(soup(2500, 3, 10000, 2))}) {
        MeshCut up(mesh), down(mesh), jumps(mesh);
        for (std::uint32_t level = mesh.vertices_min(); level <= mesh.vertices(); ++level) {
            up.set_vertices(level);
            if (level % 5 != 0) continue;
            jumps.set_vertices((level * 7919U) % mesh.vertices());
            jumps.set_vertices(level);
            ASSERT_TRUE(same(up, jumps)) << level;
        }
        down.set_vertices(mesh.vertices());
        for (std::uint32_t level = mesh.vertices(); level > mesh.vertices_min(); --level) {
            down.set_vertices(level);
            if (level % 7 == 0) {
                jumps.set_vertices(level);
                ASSERT_TRUE(same(down, jumps)) << level;
            }
        }
    }
}

// Random sequences of levels, of which many are the original or near it: the cut returns there by what it has written
// since, from any mixture of steps and rebuilds, with or without uploads in between.
TEST(MeshCut, random_jumps_and_returns_to_the_original_agree_with_a_slow_walk) {
    for (const ProgressiveMeshData& data : {torus_data(), soup(2500, 3, 10000, 2)}) {
        const ProgressiveMesh mesh(data);
        Walker walker(data);
        for (std::uint64_t seed = 1; seed <= 12; ++seed) {
            SeededRandom random(seed);
            MeshCut cut(mesh);
            Mirror mirror(cut);
            for (int move = 0; move < 30; ++move) {
                const std::uint64_t kind = random.below(6), range = mesh.vertices() - mesh.vertices_min();
                const auto away = static_cast<std::uint32_t>(random.below(kind < 2    ? 1
                                                                          : kind == 2 ? 40
                                                                          : kind == 3 ? range / 8
                                                                                      : range + 1));
                if (random.below(4) == 0)
                    cut.approach(mesh.vertices() - away, 0.0);  // a few hundred steps
                else
                    cut.set_vertices(mesh.vertices() - away);
                if (random.below(3) == 0) continue;
                ASSERT_TRUE(same(cut, walker.walk_to(cut.vertices()))) << seed << ", move " << move;
                mirror.upload(cut);
                ASSERT_TRUE(mirror.shows(cut)) << seed << ", move " << move;
            }
        }
    }
}

TEST(MeshCut, a_return_to_the_original_sends_only_what_the_coarse_level_replaced) {
    const ProgressiveMesh& mesh = torus_mesh();
    MeshCut cut(mesh);
    Mirror mirror(cut);
    const std::size_t all = cut.vertex().size_bytes() + cut.index().size_bytes();
    EXPECT_EQ(mirror.upload(cut), all);
    for (int round = 0; round < 3; ++round) {
        cut.set_vertices(mesh.vertices());
        mirror.upload(cut);
        EXPECT_TRUE(mirror.shows(cut));
        cut.set_vertices(mesh.vertices() / 4);
        mirror.upload(cut);
        cut.set_vertices(mesh.vertices());
        EXPECT_LT(mirror.upload(cut), all / 2) << round;
        EXPECT_TRUE(mirror.shows(cut));
    }
}

TEST(MeshCut, uploads_cover_only_changes) {
    const ProgressiveMesh& mesh = torus_mesh();
    MeshCut cut(mesh);
    Mirror mirror(cut);
    cut.set_vertices(mesh.vertices());
    mirror.upload(cut);
    // Longest unchanged stretch of a range: two blocks and a joined gap.
    const auto longest_idle = [](const auto& before, const auto& now, std::span<const MeshRange> ranges) {
        std::size_t longest = 0;
        for (const MeshRange r : ranges) {
            std::size_t idle = 0;
            for (std::size_t i = r.first; i < r.first + r.count; ++i) {
                idle = before[i] == now[i] ? idle + 1 : 0;
                longest = std::max(longest, idle);
            }
        }
        return longest;
    };
    std::size_t steps = 0;
    while (cut.vertices() > mesh.vertices_min()) {
        const std::vector<MeshRange> draws(cut.draws().begin(), cut.draws().end());
        cut.set_vertices(cut.vertices() - std::min(cut.vertices() - mesh.vertices_min(), 3U));
        const bool same_lists = std::equal(draws.begin(), draws.end(), cut.draws().begin());
        const Mirror before = mirror;
        const MeshChanges changes = cut.changes();
        if (same_lists) {  // a patch that changes lists is rewritten
            ++steps;
            ASSERT_LE(longest_idle(before.vertex, cut.vertex(), changes.vertex), 16U + 16U + 32U);
            ASSERT_LE(longest_idle(before.index, cut.index(), changes.index), 64U + 64U + 128U);
        }
        for (const MeshRange r : changes.vertex)
            std::copy_n(cut.vertex().begin() + r.first, r.count, mirror.vertex.begin() + r.first);
        for (const MeshRange r : changes.index)
            std::copy_n(cut.index().begin() + r.first, r.count, mirror.index.begin() + r.first);
        ASSERT_TRUE(mirror.shows(cut));
        const MeshChanges none = cut.changes();
        ASSERT_TRUE(none.vertex.empty() && none.index.empty());
    }
    EXPECT_GT(steps, 500U);
}

TEST(MeshCut, a_far_goal_is_reached_by_calls_within_their_budget) {
    const ProgressiveMesh& mesh = torus_mesh();
    MeshCut cut(mesh), jumps(mesh);
    const double enough_ns = 1e12;
    EXPECT_EQ(cut.approach(mesh.vertices(), enough_ns), mesh.vertices());
    for (const std::uint32_t goal : {mesh.vertices_min(), mesh.vertices() - 1}) {
        for (std::uint32_t before = cut.vertices(); before != goal; before = cut.vertices()) {
            cut.approach(goal, 0.0);
            const std::uint32_t moved =
                cut.vertices() > before ? cut.vertices() - before : before - cut.vertices();
            ASSERT_GE(moved, std::min(MeshCut::kStepsMin, goal > before ? goal - before : before - goal));
            ASSERT_LE(moved, MeshCut::kStepsMin);
            jumps.set_vertices(cut.vertices());
            ASSERT_TRUE(same(cut, jumps));
        }
    }
    EXPECT_EQ(cut.whole_ns(cut.vertices()), 0.0);
    const double whole_ns = cut.whole_ns(0);
    EXPECT_GT(whole_ns, 0.0);
    EXPECT_NE(cut.approach(0, 0.99 * whole_ns), mesh.vertices_min());  // single steps, which cost more
    EXPECT_EQ(cut.approach(0, enough_ns), mesh.vertices_min());
    EXPECT_EQ(cut.approach(UINT32_MAX, std::nan("")), mesh.vertices_min() + MeshCut::kStepsMin);
}

TEST(MeshCut, few_vertices_are_transformed_twice) {
    const ProgressiveMesh& mesh = torus_mesh();
    MeshCut cut(mesh);
    for (const std::uint32_t level : {mesh.vertices(), mesh.vertices() / 2, mesh.vertices() / 4}) {
        cut.set_vertices(level);
        std::deque<std::uint32_t> cache;  // first in, first out
        std::size_t transforms = 0;
        for (const std::uint32_t v : drawn(cut)) {
            if (std::find(cache.begin(), cache.end(), v) != cache.end()) continue;
            ++transforms;
            cache.push_back(v);
            if (cache.size() > 32) cache.pop_front();
        }
        EXPECT_LT(static_cast<double>(transforms), 1.6 * level) << level;
    }
}

TEST(MeshCut, every_level_is_a_valid_surface_and_the_finest_is_the_original) {
    const TriangleMesh original = isosurface(sampled(33, torus), -0.25);
    const ProgressiveMesh& mesh = torus_mesh();
    ASSERT_EQ(mesh.vertices(), original.vertices());
    ASSERT_EQ(mesh.triangles(), original.triangles());
    MeshCut cut(mesh);
    float error_m = std::numeric_limits<float>::infinity();
    for (std::uint32_t level = mesh.vertices_min(); level <= mesh.vertices(); level += 97) {
        cut.set_vertices(level);
        TriangleMesh now;
        for (const PackedVertex& v : shown(cut))
            now.position_m.insert(now.position_m.end(), v.position_m.begin(), v.position_m.end());
        for (const Triangle& t : triangles(drawn(cut)))
            now.triangle.insert(now.triangle.end(), t.begin(), t.end());
        ASSERT_EQ(now.triangles(), cut.triangles());
        const Topology t = topology(now);
        ASSERT_EQ(t.tangled_edges + t.tangled_vertices + t.flat_triangles + t.border_edges, 0U) << level;
        ASSERT_EQ(t.euler, 0) << level;
        ASSERT_LE(cut.error_m(), error_m);
        error_m = cut.error_m();
    }
    cut.set_vertices(UINT32_MAX);
    ASSERT_EQ(cut.vertices(), mesh.vertices());
    // The same triangles at the same positions, in another order.
    const auto places = [](auto&& corner, std::size_t count) {
        std::multiset<std::array<std::array<float, 3>, 3>> set;
        for (std::size_t t = 0; t < count; ++t)
            set.insert({corner(3 * t), corner(3 * t + 1), corner(3 * t + 2)});
        return set;
    };
    const std::vector<std::uint32_t> index = drawn(cut);
    ASSERT_EQ(index.size(), 3U * cut.triangles());
    EXPECT_EQ(places([&](std::size_t c) { return cut.vertex()[index[c]].position_m; }, cut.triangles()),
              places(
                  [&](std::size_t c) {
                      const float* p = &original.position_m[3 * std::size_t{original.triangle[c]}];
                      return std::array<float, 3>{p[0], p[1], p[2]};
                  },
                  original.triangles()));
}

TEST(MeshCut, normals_are_unit_vectors_that_point_outward_at_every_level) {
    const ProgressiveMesh& mesh = torus_mesh();
    MeshCut cut(mesh);
    for (const std::uint32_t level : {200U, 1000U, mesh.vertices()}) {
        cut.set_vertices(level);
        double worst = 1.0;
        for (const PackedVertex& v : shown(cut)) {
            const auto part = unit_normal(v);
            const Vec3 n(part[0], part[1], part[2]);
            const Vec3 p(v.position_m[0], v.position_m[1], v.position_m[2]);
            const Vec3 ring = Vec3(p.x(), p.y(), 0.0).normalized() * 0.6;
            EXPECT_NEAR(n.norm(), 1.0, 2e-3);  // half of 1/511 in three components
            worst = std::min(worst, n.dot((p - ring).normalized()));
        }
        EXPECT_GT(worst, level < 500 ? 0.9 : 0.97) << level;
    }
}

TEST(MeshCut, changing_levels_does_not_allocate) {
    const ProgressiveMesh& mesh = torus_mesh();
    MeshCut cut(mesh);
    const std::size_t before = allocations;
    for (std::uint32_t i = 0; i < 500; ++i) {
        cut.set_vertices(i * 2654435761U % mesh.vertices());
        cut.set_vertices(cut.vertices() + 3);
        (void)cut.changes();
    }
    EXPECT_EQ(allocations, before);
}

}  // namespace
}  // namespace tact::test
