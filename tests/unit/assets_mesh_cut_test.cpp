#include "ipc/assets/mesh_cut.hpp"

#include <gtest/gtest.h>
#include <rapidcheck.h>

#include <cstdlib>
#include <new>

#include "ipc/assets/isosurface.hpp"
#include "ipc/base/error.hpp"
#include "prep/mesh/progressive.hpp"
#include "tests/unit/prep_mesh_fixtures.hpp"

namespace {
std::size_t allocations = 0;
}
// Every allocation of this program is counted. Not inlined: the compiler would pair new with free and warn.
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

// The slow reference: contraction by contraction from the original, as the definition says.
struct Reference {
    std::vector<MeshVertex> vertex;
    std::vector<std::uint32_t> index;
};
Reference reference(const ProgressiveMeshData& data, std::uint32_t level) {
    Reference r{data.vertex, data.triangle};
    for (std::uint32_t v = static_cast<std::uint32_t>(data.vertex.size()); v-- > level;) {
        const std::size_t k = v - data.base_vertices;
        r.vertex[data.parent[k]] = data.merged[k];
        for (std::uint32_t& corner : r.index) corner = corner == v ? data.parent[k] : corner;
    }
    r.vertex.resize(level);
    r.index.resize(std::size_t{3} * data.triangle_count[level - data.base_vertices]);
    return r;
}

bool same(const MeshCut& cut, const Reference& r) {
    return std::equal(cut.vertex().begin(), cut.vertex().end(), r.vertex.begin(), r.vertex.end()) &&
           std::equal(cut.index().begin(), cut.index().end(), r.index.begin(), r.index.end());
}

TEST(MeshCut, AnyWalkEndsInTheStateThatContractionByContractionGives) {
    const ProgressiveMesh mesh(make_progressive(isosurface(sampled(15, torus), -0.25)));
    rc::check([&] {
        MeshCut cut(mesh);
        std::vector<MeshVertex> gpu_vertex(mesh.vertices());
        std::vector<std::uint32_t> gpu_index(3 * std::size_t{mesh.triangles()});
        const auto levels = *rc::gen::container<std::vector<std::uint32_t>>(
            rc::gen::inRange(mesh.vertices_min(), mesh.vertices() + 1));
        for (const std::uint32_t level : levels) {
            RC_ASSERT(cut.set_vertices(level) == level);
            // A near neighbour too, so that single steps are walked.
            RC_ASSERT(cut.set_vertices(std::max(level, mesh.vertices_min() + 5) - 5) <= level);
            RC_ASSERT(same(cut, reference(mesh.data(), cut.vertices())));
            // What a viewer that uploads the changes alone would draw.
            const MeshChanges changes = cut.changes();
            for (const MeshRange r : changes.vertex)
                std::copy_n(cut.vertex().begin() + r.first, r.count, gpu_vertex.begin() + r.first);
            for (const MeshRange r : changes.index)
                std::copy_n(cut.index().begin() + r.first, r.count, gpu_index.begin() + r.first);
            RC_ASSERT(std::equal(cut.vertex().begin(), cut.vertex().end(), gpu_vertex.begin()));
            RC_ASSERT(std::equal(cut.index().begin(), cut.index().end(), gpu_index.begin()));
        }
    });
}

TEST(MeshCut, SingleStepsAndRebuildsAgreeAtEveryLevel) {
    const ProgressiveMesh& mesh = torus_mesh();
    MeshCut steps(mesh), jumps(mesh);
    for (std::uint32_t level = mesh.vertices_min(); level <= mesh.vertices(); ++level) {
        steps.set_vertices(level);
        jumps.set_vertices((level * 7919U) % mesh.vertices());
        jumps.set_vertices(level);
        ASSERT_TRUE(std::equal(steps.vertex().begin(), steps.vertex().end(), jumps.vertex().begin(),
                               jumps.vertex().end()))
            << level;
        ASSERT_TRUE(std::equal(steps.index().begin(), steps.index().end(), jumps.index().begin(),
                               jumps.index().end()))
            << level;
    }
}

TEST(MeshCut, EveryLevelIsAValidSurfaceAndTheFinestIsTheOriginal) {
    const TriangleMesh original = isosurface(sampled(33, torus), -0.25);
    const ProgressiveMesh& mesh = torus_mesh();
    ASSERT_EQ(mesh.vertices(), original.vertices());
    ASSERT_EQ(mesh.triangles(), original.triangles());
    MeshCut cut(mesh);
    float error_m = std::numeric_limits<float>::infinity();
    for (std::uint32_t level = mesh.vertices_min(); level <= mesh.vertices(); level += 97) {
        cut.set_vertices(level);
        TriangleMesh now;
        for (const MeshVertex& v : cut.vertex())
            now.position_m.insert(now.position_m.end(), v.position_m.begin(), v.position_m.end());
        now.triangle.assign(cut.index().begin(), cut.index().end());
        const Topology t = topology(now);
        ASSERT_EQ(t.tangled_edges + t.tangled_vertices + t.flat_triangles + t.border_edges, 0U) << level;
        ASSERT_EQ(t.euler, 0) << level;
        ASSERT_LE(cut.error_m(), error_m);
        error_m = cut.error_m();
    }
    cut.set_vertices(UINT32_MAX);
    ASSERT_EQ(cut.vertices(), mesh.vertices());
    // The same triangles at the same places, in another order.
    const auto places = [](auto&& corner, std::size_t triangles) {
        std::multiset<std::array<std::array<float, 3>, 3>> set;
        for (std::size_t t = 0; t < triangles; ++t)
            set.insert({corner(3 * t), corner(3 * t + 1), corner(3 * t + 2)});
        return set;
    };
    EXPECT_EQ(places([&](std::size_t c) { return cut.vertex()[cut.index()[c]].position_m; }, cut.triangles()),
              places(
                  [&](std::size_t c) {
                      const float* p = &original.position_m[3 * std::size_t{original.triangle[c]}];
                      return std::array<float, 3>{p[0], p[1], p[2]};
                  },
                  original.triangles()));
}

TEST(MeshCut, NormalsAreUnitVectorsThatPointOutwardAtEveryLevel) {
    const ProgressiveMesh& mesh = torus_mesh();
    MeshCut cut(mesh);
    for (const std::uint32_t level : {200U, 1000U, mesh.vertices()}) {
        cut.set_vertices(level);
        double worst = 1.0;
        for (const MeshVertex& v : cut.vertex()) {
            const Vec3 n = Vec3(v.normal[0], v.normal[1], v.normal[2]) / 32767.0;
            const Vec3 p(v.position_m[0], v.position_m[1], v.position_m[2]);
            const Vec3 ring = Vec3(p.x(), p.y(), 0.0).normalized() * 0.6;
            EXPECT_NEAR(n.norm(), 1.0, 1e-4);
            worst = std::min(worst, n.dot((p - ring).normalized()));
        }
        EXPECT_GT(worst, level < 500 ? 0.9 : 0.97) << level;
    }
}

TEST(MeshCut, WalkingDoesNotAllocate) {
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

TEST(ProgressiveMesh, SurvivesTheFileUnchanged) {
    SceneWriter out;
    write_mesh(out, 0, torus_data());
    const std::vector<std::byte> bytes = out.to_bytes();
    const ProgressiveMesh back = read_mesh(SceneFile::from_bytes(bytes, "torus"), 0);
    EXPECT_EQ(back.data().vertex, torus_data().vertex);
    EXPECT_EQ(back.data().merged, torus_data().merged);
    EXPECT_EQ(back.data().parent, torus_data().parent);
    EXPECT_EQ(back.data().error_m, torus_data().error_m);
    EXPECT_EQ(back.data().triangle, torus_data().triangle);
    EXPECT_EQ(back.data().triangle_count, torus_data().triangle_count);
}

ProgressiveMeshData small_data() { return make_progressive(isosurface(sampled(13, torus), -0.25)); }

// Whatever is accepted can be walked: the sanitizers watch.
void read_and_walk(const ProgressiveMeshData& data) {
    SceneWriter out;
    write_mesh(out, 0, data);
    const std::vector<std::byte> bytes = out.to_bytes();
    const ProgressiveMesh mesh = read_mesh(SceneFile::from_bytes(bytes, "hostile"), 0);
    MeshCut cut(mesh);
    for (std::uint32_t level = mesh.vertices_min(); level < mesh.vertices(); level += 3)
        cut.set_vertices(level);
    cut.set_vertices(mesh.vertices_min());
    for (const std::uint32_t corner : cut.index()) ASSERT_LT(corner, cut.vertices());
}

TEST(ProgressiveMesh, RefusesEachKindOfDamage) {
    const ProgressiveMeshData good = small_data();
    ASSERT_NO_THROW(read_and_walk(good));
    const auto damaged = [&](auto&& damage) {
        ProgressiveMeshData bad = good;
        damage(bad);
        EXPECT_THROW(read_and_walk(bad), StartupError);
    };
    damaged([](ProgressiveMeshData& d) { d.parent[3] = d.base_vertices + 3; });
    damaged([](ProgressiveMeshData& d) { d.parent.back() = UINT32_MAX; });
    damaged([](ProgressiveMeshData& d) { d.triangle[5] = static_cast<std::uint32_t>(d.vertex.size()); });
    damaged([](ProgressiveMeshData& d) { d.triangle[1] = d.triangle[0]; });
    damaged([](ProgressiveMeshData& d) { d.triangle_count[2] = UINT32_MAX; });
    damaged([](ProgressiveMeshData& d) { d.triangle_count.back() -= 1; });
    damaged([](ProgressiveMeshData& d) { d.triangle_count.front() = d.triangle_count.back(); });
    damaged([](ProgressiveMeshData& d) { d.error_m[1] = std::nanf(""); });
    damaged([](ProgressiveMeshData& d) { d.error_m.back() = 1e30F; });
    damaged(
        [](ProgressiveMeshData& d) { d.vertex[0].position_m[1] = std::numeric_limits<float>::infinity(); });
    damaged([](ProgressiveMeshData& d) { d.merged[0].position_m[1] = std::nanf(""); });
    damaged([](ProgressiveMeshData& d) { d.base_vertices = 0; });
    damaged([](ProgressiveMeshData& d) { d.base_vertices = UINT32_MAX; });
    damaged([](ProgressiveMeshData& d) { d.parent.pop_back(); });
    damaged([](ProgressiveMeshData& d) { d.triangle.pop_back(); });
}

TEST(ProgressiveMesh, RandomDamageIsRefusedOrHarmless) {
    const ProgressiveMeshData good = small_data();
    rc::check([&] {
        ProgressiveMeshData bad = good;
        const auto hits = *rc::gen::inRange(1, 6);
        for (int i = 0; i < hits; ++i) {
            const auto value =
                *rc::gen::inRange<std::uint32_t>(0, static_cast<std::uint32_t>(good.vertex.size()) + 2);
            const auto at = *rc::gen::inRange<std::size_t>(0, 1U << 20);
            switch (*rc::gen::inRange(0, 4)) {
                case 0:
                    bad.parent[at % bad.parent.size()] = value;
                    break;
                case 1:
                    bad.triangle[at % bad.triangle.size()] = value;
                    break;
                case 2:
                    bad.triangle_count[at % bad.triangle_count.size()] = value;
                    break;
                default:
                    bad.base_vertices = value;
                    break;
            }
        }
        try {
            read_and_walk(bad);
        } catch (const StartupError&) {
        }
    });
}

TEST(ProgressiveMesh, ChainsThatWouldTakeQuadraticWorkAreRefused) {
    // Every vertex goes into the one before it and every triangle hangs at the end of the chain.
    ProgressiveMeshData d;
    const std::uint32_t n = 20000;
    d.base_vertices = 3;
    d.vertex.assign(n, MeshVertex{{0.0F, 0.0F, 0.0F}, {0, 0, 32767, 0}});
    for (std::uint32_t v = 3; v < n; ++v) d.parent.push_back(v - 1);
    d.merged.assign(n - 3, d.vertex[0]);
    d.error_m.assign(n - 2, 0.0F);
    for (std::uint32_t t = 0; t < 20000; ++t) d.triangle.insert(d.triangle.end(), {0, 1, n - 1});
    d.triangle_count.assign(n - 2, 20000);
    EXPECT_THROW(ProgressiveMesh{d}, StartupError);
}

}  // namespace
}  // namespace tact::test
