#include "prep/surface/build_surface.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "ipc/base/error.hpp"
#include "ipc/base/huge_pages.hpp"
#include "ipc/scene/mesh/hilbert.hpp"

namespace tact {
namespace {

constexpr std::uint32_t kBits = 16;  // bits of a coordinate on the curve
constexpr float kInfinite = std::numeric_limits<float>::infinity();

struct Keyed {
    std::uint64_t key;
    std::uint32_t triangle;
};

// Radix sort by key, least digit first; stable, so runs repeat exactly.
void sort_by_key(HugeVector<Keyed>& items) {
    HugeVector<Keyed> other(items.size());
    std::vector<std::size_t> begin(std::size_t{1} << 16);
    for (std::uint32_t shift = 0; shift < 3 * kBits; shift += 16) {
        std::fill(begin.begin(), begin.end(), 0);
        for (const Keyed& item : items) ++begin[item.key >> shift & 0xFFFFU];
        std::size_t sum = 0;
        for (std::size_t& b : begin) {
            const std::size_t count = b;
            b = sum;
            sum += count;
        }
        for (const Keyed& item : items) other[begin[item.key >> shift & 0xFFFFU]++] = item;
        items.swap(other);
    }
}

std::uint64_t mixed(std::uint64_t z) {  // splitmix64
    z += 0x9E3779B97F4A7C15ULL;
    z = (z ^ (z >> 30)) * 0xBF58476D1CE4E5B9ULL;
    z = (z ^ (z >> 27)) * 0x94D049BB133111EBULL;
    return z ^ (z >> 31);
}

struct Box {
    std::array<float, 3> low{kInfinite, kInfinite, kInfinite}, high{-kInfinite, -kInfinite, -kInfinite};
};

class Builder {
public:
    explicit Builder(const TriangleMesh& mesh) : mesh_(mesh) {}

    SurfaceData run(const Progress& progress) {
        check();
        report(progress, 0.1, "ordering the triangles");
        order();
        report(progress, 0.5, "numbering the vertices");
        number();
        report(progress, 0.7, "building the tree");
        make_tree();
        return std::move(data_);
    }

private:
    void check() const {
        const char* const kFix = "export the mesh again";
        if (mesh_.triangles() == 0) throw StartupError("build a surface", "the mesh has no triangles", kFix);
        if (mesh_.triangles() >= SurfaceNode::kFirst || mesh_.vertices() > SurfaceNode::kFirst)
            throw StartupError("build a surface", "the mesh has more than 2^28 triangles or vertices",
                               "split the mesh into parts");
        for (const float x : mesh_.position_m) {
            if (!(std::abs(x) <= 1e6F))
                throw StartupError("build a surface", "a coordinate is " + std::to_string(x), kFix);
        }
        for (const std::uint32_t v : mesh_.triangle) {
            if (v >= mesh_.vertices())
                throw StartupError("build a surface",
                                   "a triangle refers to vertex " + std::to_string(v) +
                                       ", but the number of vertices is " + std::to_string(mesh_.vertices()),
                                   kFix);
        }
    }
    void order() {
        Box box;
        for (std::size_t i = 0; i < mesh_.position_m.size(); ++i) {
            box.low[i % 3] = std::min(box.low[i % 3], mesh_.position_m[i]);
            box.high[i % 3] = std::max(box.high[i % 3], mesh_.position_m[i]);
        }
        float widest = 0.0F;
        for (std::size_t k = 0; k < 3; ++k) widest = std::max(widest, box.high[k] - box.low[k]);
        const float cells = widest > 0.0F ? static_cast<float>((1U << kBits) - 1) / (3.0F * widest) : 0.0F;
        items_.resize(mesh_.triangles());
        for (std::uint32_t t = 0; t < items_.size(); ++t) {
            std::array<float, 3> sum{};
            for (std::size_t k = 0; k < 3; ++k) {
                const float* const p =
                    mesh_.position_m.data() + std::size_t{3} * mesh_.triangle[std::size_t{3} * t + k];
                for (std::size_t axis = 0; axis < 3; ++axis) sum[axis] += p[axis] - box.low[axis];
            }
            std::array<std::uint32_t, 3> cell;
            for (std::size_t axis = 0; axis < 3; ++axis) {
                cell[axis] = std::min(static_cast<std::uint32_t>(std::max(sum[axis] * cells, 0.0F)),
                                      (1U << kBits) - 1);
            }
            items_[t] = {hilbert<kBits>(cell), t};
        }
        sort_by_key(items_);
    }
    void number() {
        data_.triangle.resize(mesh_.triangle.size());
        std::vector<std::uint32_t> now(mesh_.vertices(), UINT32_MAX);
        std::vector<Eigen::Vector3f> sum;
        sum.reserve(mesh_.vertices());
        data_.position_m.reserve(mesh_.position_m.size());
        std::uint64_t border = 0;
        for (std::size_t i = 0; i < items_.size(); ++i) {
            std::array<Eigen::Vector3f, 3> p;
            for (std::size_t k = 0; k < 3; ++k) {
                const std::uint32_t v = mesh_.triangle[std::size_t{3} * items_[i].triangle + k];
                const float* const at = mesh_.position_m.data() + std::size_t{3} * v;
                p[k] = {at[0], at[1], at[2]};
                if (now[v] == UINT32_MAX) {
                    now[v] = static_cast<std::uint32_t>(sum.size());
                    sum.emplace_back(Eigen::Vector3f::Zero());
                    data_.position_m.insert(data_.position_m.end(), at, at + 3);
                }
                data_.triangle[3 * i + k] = now[v];
            }
            const std::uint32_t* const c = data_.triangle.data() + 3 * i;
            const Eigen::Vector3f area = (p[1] - p[0]).cross(p[2] - p[0]);
            for (std::size_t k = 0; k < 3; ++k) {
                sum[c[k]] += area;
                const std::uint64_t from = c[k], to = c[(k + 1) % 3];
                if (from < to) border += mixed(from << 32U | to);
                if (from > to) border -= mixed(to << 32U | from);
            }
        }
        data_.closed = border == 0;
        data_.normal.reserve(sum.size());
        for (const Eigen::Vector3f& s : sum) {
            // Squares of small areas underflow a float.
            const Vec3 wide = s.cast<double>();
            const double length = wide.norm();
            data_.normal.push_back(oct_normal(length > 0.0 ? Vec3(wide / length) : Vec3(Vec3::UnitZ())));
        }
    }
    Box leaf_box(std::uint32_t first, std::uint32_t count) const {
        Box box;
        for (std::size_t i = std::size_t{3} * first; i < std::size_t{3} * (first + count); ++i) {
            for (std::size_t axis = 0; axis < 3; ++axis) {
                const float x = data_.position_m[std::size_t{3} * data_.triangle[i] + axis];
                box.low[axis] = std::min(box.low[axis], x);
                box.high[axis] = std::max(box.high[axis], x);
            }
        }
        return box;
    }
    // Leaves first to first + count, count >= 1, under one node. Children get whole powers of four of leaves, so that
    // only the last child of each level is not full.
    Box make_node(std::uint32_t first, std::uint32_t count) {
        const auto at = static_cast<std::uint32_t>(data_.node.size());
        SurfaceNode node{};
        for (std::size_t axis = 0; axis < 3; ++axis) {
            node.low_m[axis].fill(kInfinite);
            node.high_m[axis].fill(-kInfinite);
        }
        node.child.fill(SurfaceNode::kNone);
        data_.node.push_back(node);
        std::uint32_t each = 1;
        while (std::uint64_t{4} * each < count) each *= 4;
        Box all;
        for (std::size_t k = 0; count > 0; ++k) {
            const std::uint32_t take = std::min(each, count);
            Box box;
            std::uint32_t code = 0;
            if (take == 1) {
                const std::uint32_t triangle = first * 4;
                const auto left = static_cast<std::uint32_t>(data_.triangle.size() / 3) - triangle;
                code = SurfaceNode::leaf(triangle, std::min(left, 4U));
                box = leaf_box(triangle, std::min(left, 4U));
            } else {
                code = static_cast<std::uint32_t>(data_.node.size());
                box = make_node(first, take);
            }
            SurfaceNode& mine = data_.node[at];
            mine.child[k] = code;
            for (std::size_t axis = 0; axis < 3; ++axis) {
                mine.low_m[axis][k] = box.low[axis];
                mine.high_m[axis][k] = box.high[axis];
                all.low[axis] = std::min(all.low[axis], box.low[axis]);
                all.high[axis] = std::max(all.high[axis], box.high[axis]);
            }
            first += take;
            count -= take;
        }
        return all;
    }
    void make_tree() {
        const auto leaves = static_cast<std::uint32_t>((mesh_.triangles() + 3) / 4);
        data_.node.reserve(leaves / 3 + 64);
        make_node(0, leaves);
    }

    const TriangleMesh& mesh_;
    SurfaceData data_;
    HugeVector<Keyed> items_;
};

}  // namespace

SurfaceData build_surface(const TriangleMesh& mesh, const Progress& progress) {
    return Builder(mesh).run(progress);
}

}  // namespace tact
