#include "ipc/scene/mesh/vertex_forest.hpp"

#include <algorithm>
#include <cmath>

#include "ipc/scene/file/bytes.hpp"

namespace tact {
namespace {

constexpr SectionTag kForestTag{'F', 'R', 'S', 'T'};
constexpr std::uint32_t kForestVersion = 1;

struct ForestHeader {
    std::uint32_t leaves, trees, nodes, triangles, needs;
    std::uint32_t reserved[11];  // zero
};
static_assert(sizeof(ForestHeader) == 64);

// Visits the whole forest once and checks its invariants.
class ForestChecker {
public:
    ForestChecker(const VertexForest& forest, std::uint32_t always, std::span<const std::uint32_t> corner,
                  const std::string& where)
        : forest_(forest),
          corner_(corner),
          always_(always),
          where_(where),
          number_seen_(forest.nodes() + std::size_t{1}, false),
          triangle_seen_(forest.triangles(), false) {}

    void run() {
        for (std::uint32_t r = 0; r < forest_.roots(); ++r) walk(forest_.root(r));
        // These were selected by having their corners in three trees.
        for (const ForestTriangle& t : forest_.triangles_always()) take(t);
    }
    [[noreturn]] void fail(const std::string& why) const {
        throw StartupError("read " + where_, why, "bake the scene again with this version of tact-prep");
    }

private:
    void walk(const VertexForest::Branch& root) {
        struct Step {
            VertexForest::Branch branch;
            std::uint32_t parent;
        };
        std::vector<Step> stack{{root, kNoForestNode}};
        while (!stack.empty()) {
            const auto [b, parent] = stack.back();
            stack.pop_back();
            if (b.is_leaf()) continue;
            check_node(b, parent);
            stack.push_back({forest_.child(b, 1), b.node});
            stack.push_back({forest_.child(b, 0), b.node});
        }
    }
    void check_node(const VertexForest::Branch& b, std::uint32_t parent) {
        const ForestNode& node = forest_.node(b.node);
        const auto bad = [&](const char* what) {
            fail("node " + std::to_string(b.node) + ": its " + what + " is out of range");
        };
        for (const float x : node.position_m)
            if (!(std::abs(x) <= 1e7F)) bad("position");
        if (!(node.error_m >= 0.0F && node.error_m <= 1e7F)) bad("error");
        if (!(node.reach_m >= 0.0F && node.reach_m <= 1e8F)) bad("reach");
        if (!(node.own_span_m >= 0.0F && node.own_span_m <= node.span_m && node.span_m <= 1e9F)) bad("span");
        if (!(node.deviation_m >= 0.0F && node.deviation_m <= 1e8F)) bad("deviation");
        if (node.first != b.first || node.end != b.end) bad("range of leaves");
        if (!(node.middle > b.first && node.middle < b.end)) bad("middle");
        if (node.parent != parent) bad("parent");
        if (node.reserved != 0) bad("reserved field");
        if (node.number == 0 || node.number > forest_.nodes() || number_seen_[node.number]) bad("number");
        number_seen_[node.number] = true;
        if (parent != kNoForestNode) {
            const ForestNode& up = forest_.node(parent);
            if (node.number >= up.number) bad("number");
            if (node.error_m > up.error_m) bad("error");
            if (node.deviation_m > up.deviation_m) bad("deviation");
        }
        check_needs(b.node);
        const std::uint32_t next =
            b.node + 1 < forest_.nodes() ? forest_.node(b.node + 1).first_triangle : always_;
        if (node.first_triangle > next || next > always_) bad("list of triangles");
        for (const ForestTriangle& t : forest_.triangles_of(b.node)) {
            take(t);
            std::uint32_t in_first = 0, in_second = 0;
            for (const std::uint32_t v : t.leaf) {
                in_first += v >= b.first && v < node.middle ? 1 : 0;
                in_second += v >= node.middle && v < b.end ? 1 : 0;
            }
            if (in_first != 1 || in_second != 1)
                fail("triangle " + std::to_string(t.number) + " does not appear where node " +
                     std::to_string(b.node) + " is split");
        }
    }
    void check_needs(std::uint32_t node) const {
        for (const std::uint32_t need : forest_.needs_of(node))
            if (need >= forest_.nodes() || forest_.node(need).number <= forest_.node(node).number)
                fail("node " + std::to_string(node) + " needs a node that was merged before it");
    }
    void take(const ForestTriangle& t) {
        if (t.number >= forest_.triangles() || triangle_seen_[t.number])
            fail("triangle " + std::to_string(t.number) + " is absent or listed twice");
        triangle_seen_[t.number] = true;
        if (!std::equal(t.leaf.begin(), t.leaf.end(), corner_.begin() + 3 * std::ptrdiff_t{t.number}))
            fail("triangle " + std::to_string(t.number) + " has other corners than in the mesh");
    }

    const VertexForest& forest_;
    std::span<const std::uint32_t> corner_;
    std::uint32_t always_;
    const std::string& where_;
    std::vector<bool> number_seen_, triangle_seen_;
};

template <class T>
std::span<const T> forest_view_of(std::span<const std::byte>& bytes, std::uint64_t count) {
    const std::span<const T> items(reinterpret_cast<const T*>(bytes.data()), static_cast<std::size_t>(count));
    bytes = bytes.subspan(items.size_bytes());
    return items;
}

}  // namespace

VertexForest::VertexForest(std::span<const std::uint32_t> root_first, std::span<const ForestNode> node,
                           std::span<const std::uint32_t> need, std::span<const ForestTriangle> triangle,
                           std::span<const float> position_m, std::span<const std::uint32_t> corner,
                           const std::string& where)
    : root_first_(root_first), node_(node), need_(need), triangle_(triangle), position_m_(position_m) {
    check(corner, where);
}

void VertexForest::check(std::span<const std::uint32_t> corner, const std::string& where) {
    const auto fail = [&](const std::string& why) {
        throw StartupError("read " + where, why, "bake the scene again with this version of tact-prep");
    };
    if (root_first_.size() < 2 || root_first_.front() != 0) fail("it has no tree that begins at leaf 0");
    for (std::size_t r = 0; r + 1 < root_first_.size(); ++r)
        if (root_first_[r] >= root_first_[r + 1]) fail("tree " + std::to_string(r) + " has no leaf");
    if (position_m_.size() != 3 * std::size_t{leaves()})
        fail("it has " + std::to_string(leaves()) + " leaves, but the mesh has " +
             std::to_string(position_m_.size() / 3) + " vertices");
    if (corner.size() != 3 * triangle_.size())
        fail("it has " + std::to_string(triangle_.size()) + " triangles, but the mesh has " +
             std::to_string(corner.size() / 3));
    if (node_.size() != leaves() - roots()) fail("the number of its nodes is not leaves minus trees");
    for (const ForestTriangle& t : triangle_)
        for (const std::uint32_t v : t.leaf)
            if (v >= leaves()) fail("a corner of triangle " + std::to_string(t.number) + " is not a leaf");
    // The lists of nodes fill triangle_ from 0 on without gaps; they end after the last triangle with two
    // corners in one tree.
    std::size_t always = triangle_.size();
    while (always > 0) {
        const std::array<std::uint32_t, 3>& v = triangle_[always - 1].leaf;
        const std::uint32_t a = tree_of(v[0]), b = tree_of(v[1]), c = tree_of(v[2]);
        if (a == b || b == c || c == a) break;
        --always;
    }
    always_ = static_cast<std::uint32_t>(always);
    for (std::size_t i = 0; i < node_.size(); ++i) {
        const std::size_t next = i + 1 < node_.size() ? node_[i + 1].first_need : need_.size();
        if (node_[i].first_need > next || next > need_.size() || (i == 0 && node_[0].first_need != 0))
            fail("its lists of needs are out of order");
    }
    if (!node_.empty() && node_[0].first_triangle != 0) fail("its lists of triangles do not start at 0");
    if (node_.empty() && always != 0) fail("a triangle has two corners in one leaf");
    ForestChecker(*this, always_, corner, where).run();
}

std::uint32_t VertexForest::tree_of(std::uint32_t leaf) const {
    return static_cast<std::uint32_t>(std::upper_bound(root_first_.begin(), root_first_.end(), leaf) -
                                      root_first_.begin()) -
           1;
}

VertexForest view_forest(const VertexForestData& data, std::span<const float> position_m,
                         std::span<const std::uint32_t> corner) {
    return {data.root_first,          data.node, data.need, data.triangle, position_m, corner,
            "the forest of a surface"};
}

void write_forest(SceneWriter& out, const VertexForestData& data) {
    BytesOut bytes;
    bytes.put(ForestHeader{data.leaves,
                           static_cast<std::uint32_t>(data.root_first.size() - 1),
                           static_cast<std::uint32_t>(data.node.size()),
                           static_cast<std::uint32_t>(data.triangle.size()),
                           static_cast<std::uint32_t>(data.need.size()),
                           {}});
    bytes.put_all(data.node);
    bytes.put_all(data.triangle);
    bytes.put_all(data.need);
    bytes.put_all(data.root_first);
    out.add(kForestTag, kForestVersion, 0, bytes.take());
}

VertexForest read_forest(const SceneFile& file, std::span<const float> position_m,
                         std::span<const std::uint32_t> corner) {
    const std::string where = file.name() + ", section FRST";
    std::span<const std::byte> bytes = file.section(kForestTag, kForestVersion);
    BytesIn in(bytes, where);
    const auto header = in.get<ForestHeader>("header");
    bytes = bytes.subspan(sizeof header);
    for (const std::uint32_t word : header.reserved)
        if (word != 0) in.fail("a reserved field is not zero");
    if (reinterpret_cast<std::uintptr_t>(bytes.data()) % alignof(ForestNode) != 0)
        in.fail("it is not aligned to four bytes");
    const std::uint64_t trees = std::uint64_t{header.trees} + 1;
    if (bytes.size() != 4 * trees + sizeof(ForestNode) * std::uint64_t{header.nodes} +
                            sizeof(ForestTriangle) * std::uint64_t{header.triangles} +
                            4 * std::uint64_t{header.needs})
        in.fail("its length does not match the declared nodes and triangles");
    const auto node = forest_view_of<ForestNode>(bytes, header.nodes);
    const auto triangle = forest_view_of<ForestTriangle>(bytes, header.triangles);
    const auto need = forest_view_of<std::uint32_t>(bytes, header.needs);
    const auto root_first = forest_view_of<std::uint32_t>(bytes, trees);
    if (root_first.back() != header.leaves) in.fail("its trees do not cover its leaves");
    return {root_first, node, need, triangle, position_m, corner, where};
}

}  // namespace tact
