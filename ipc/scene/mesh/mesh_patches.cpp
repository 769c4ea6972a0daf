// Patches are runs along a Hilbert curve through the centroids: compact, and built by one sort. Within a
// list, the order is optimized for its level and the connectivity there.
#include "ipc/scene/mesh/mesh_patches.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>

#include "ipc/base/error.hpp"
#include "ipc/scene/mesh/hilbert.hpp"
#include "ipc/scene/mesh/progressive_mesh.hpp"
#include "ipc/scene/mesh/vertex_cache.hpp"

namespace tact {
namespace {

struct Keyed {
    std::uint64_t key;
    std::uint32_t triangle;
};

std::vector<Keyed> along_curve(const ProgressiveMeshData& data) {
    std::array<float, 3> low{1e30F, 1e30F, 1e30F}, high{-1e30F, -1e30F, -1e30F};
    for (const MeshVertex& v : data.vertex) {
        for (std::size_t i = 0; i < 3; ++i) {
            low[i] = std::min(low[i], v.position_m[i]);
            high[i] = std::max(high[i], v.position_m[i]);
        }
    }
    const float side_m = std::max({high[0] - low[0], high[1] - low[1], high[2] - low[2], 1e-30F});
    std::vector<Keyed> order(data.triangle.size() / 3);
    for (std::size_t t = 0; t < order.size(); ++t) {
        std::array<std::uint32_t, 3> cell{};
        for (std::size_t i = 0; i < 3; ++i) {
            float sum = 0.0F;
            for (std::size_t c = 3 * t; c < 3 * t + 3; ++c)
                sum += (data.vertex[data.triangle[c]].position_m[i] - low[i]) / side_m;
            cell[i] = static_cast<std::uint32_t>(std::clamp(sum / 3.0F, 0.0F, 1.0F) * 1048575.0F);
        }
        order[t] = {hilbert<20>(cell), static_cast<std::uint32_t>(t)};
    }
    std::sort(order.begin(), order.end(), [](const Keyed& a, const Keyed& b) {
        return a.key != b.key ? a.key < b.key : a.triangle < b.triangle;
    });
    return order;
}

// Builds the lists of all patches.
class Maker {
public:
    Maker(const ProgressiveMeshData& data, std::uint64_t lifts_max)
        : data_(data), lifts_left_(lifts_max), local_(data.vertex.size(), kNone) {
        made_.number.resize(data.triangle.size() / 3);
    }

    PatchedMesh run() {
        const std::vector<Keyed> order = along_curve(data_);
        MeshPatches& m = made_.patches;
        m.list_first.push_back(0);
        for (std::size_t first = 0; first < order.size(); first += MeshPatches::kTriangles) {
            const std::size_t end = std::min(order.size(), first + MeshPatches::kTriangles);
            member_.clear();
            corner_.clear();
            for (std::size_t i = first; i < end; ++i) {
                const std::size_t t = order[i].triangle;
                member_.push_back({static_cast<std::uint32_t>(t), 0});
                corner_.insert(corner_.end(), data_.triangle.begin() + static_cast<std::ptrdiff_t>(3 * t),
                               data_.triangle.begin() + static_cast<std::ptrdiff_t>(3 * t + 3));
            }
            number_members();
            make_lists();
            m.list_first.push_back(static_cast<std::uint32_t>(m.list.size()));
        }
        std::sort(m.change.begin(), m.change.end(), [](const auto& a, const auto& b) {
            return a.level != b.level ? a.level < b.level : a.patch < b.patch;
        });
        m.list.shrink_to_fit();
        m.corner.shrink_to_fit();
        m.slot.shrink_to_fit();
        m.vertex.shrink_to_fit();
        m.parent.shrink_to_fit();
        m.change.shrink_to_fit();
        return std::move(made_);
    }

private:
    static constexpr std::uint32_t kNone = UINT32_MAX;
    struct Member {
        std::uint32_t triangle;  // of the data
        std::uint16_t number;    // within the patch
    };

    // The data is ordered by lifetime, longest first.
    void number_members() {
        by_life_.resize(member_.size());
        std::iota(by_life_.begin(), by_life_.end(), std::uint16_t{0});
        std::sort(by_life_.begin(), by_life_.end(), [&](std::uint16_t a, std::uint16_t b) {
            return member_[a].triangle < member_[b].triangle;
        });
        for (std::size_t i = 0; i < by_life_.size(); ++i) {
            Member& member = member_[by_life_[i]];
            member.number = static_cast<std::uint16_t>(i);
            made_.number[member.triangle] = made_.patches.patches() << MeshPatches::kShift | member.number;
        }
    }

    void make_lists() {
        MeshPatches& m = made_.patches;
        const std::uint32_t patch = m.patches();
        std::uint32_t level = static_cast<std::uint32_t>(data_.vertex.size());
        add_list(level);
        // Levels at which the patch changes lists: spread evenly over the octave by the golden ratio.
        const double phase = std::fmod((patch + 0.5) * 0.6180339887498949, 1.0);
        // the loop halves `next`; it is not a counter
        for (double next = level * std::exp2(-phase); !member_.empty(); next *= 0.5) {
            const auto to = static_cast<std::uint32_t>(next);
            if (to <= data_.base_vertices) break;
            if (to == level) continue;
            lift(to);
            add_list(to);
            m.change.push_back({to, patch});
            level = to;
        }
    }

    // Removes the triangles that do not exist at the level and lifts the vertices of the others to it.
    void lift(std::uint32_t level) {
        const std::uint32_t alive = data_.triangle_count[level - data_.base_vertices];
        for (std::uint32_t& v : vertex_) {
            while (v >= level) {
                if (lifts_left_-- == 0)
                    throw StartupError("read a progressive mesh", "its contraction chains are too long",
                                       "bake the scene again with this version of tact-prep");
                v = data_.parent[v - data_.base_vertices];
            }
        }
        std::size_t kept = 0;
        std::vector<std::uint32_t>& corner = corner_;
        for (std::size_t i = 0; i < member_.size(); ++i) {
            if (member_[i].triangle >= alive) continue;
            for (std::size_t c = 0; c < 3; ++c) corner[3 * kept + c] = vertex_[list_corner_[3 * i + c]];
            member_[kept++] = member_[i];
        }
        member_.resize(kept);
        corner.resize(3 * kept);
    }

    // Input: member_ and corner_, which it sorts into the order of the list; output: list_corner_ and vertex_.
    void add_list(std::uint32_t level) {
        MeshPatches& m = made_.patches;
        number_vertices();
        const auto order = cache_order_.run(list_corner_, vertex_.size());
        const std::size_t slot_first = m.slot.size();
        m.list.push_back(
            {level, static_cast<std::uint32_t>(slot_first), static_cast<std::uint32_t>(m.vertex.size()),
             static_cast<std::uint16_t>(member_.size()), static_cast<std::uint16_t>(vertex_.size())});
        m.slot.resize(slot_first + member_.size());
        moved_.clear();
        for (const std::uint16_t from : order) {
            for (std::size_t c = 0; c < 3; ++c) m.corner.push_back(list_corner_[3 * std::size_t{from} + c]);
            const Member member = member_[from];
            m.slot[slot_first + member.number] = static_cast<std::uint16_t>(moved_.size());
            moved_.push_back(member);
        }
        member_.swap(moved_);
        list_corner_.assign(m.corner.end() - static_cast<std::ptrdiff_t>(3 * member_.size()), m.corner.end());
        m.vertex.insert(m.vertex.end(), vertex_.begin(), vertex_.end());
    }

    // Collects the vertices of corner_ in vertex_, increasing, with their parents; fills list_corner_.
    void number_vertices() {
        vertex_.clear();
        for (const std::uint32_t v : corner_) {
            if (local_[v] == kNone) vertex_.push_back(v);
            local_[v] = 0;
        }
        std::sort(vertex_.begin(), vertex_.end());
        for (std::size_t i = 0; i < vertex_.size(); ++i) local_[vertex_[i]] = static_cast<std::uint32_t>(i);
        list_corner_.clear();
        for (const std::uint32_t v : corner_) list_corner_.push_back(static_cast<std::uint16_t>(local_[v]));
        for (const std::uint32_t v : vertex_) {
            const std::uint32_t to =
                v < data_.base_vertices ? kNone : local_[data_.parent[v - data_.base_vertices]];
            made_.patches.parent.push_back(to == kNone ? MeshPatches::kElsewhere
                                                       : static_cast<std::uint16_t>(to));
        }
        for (const std::uint32_t v : vertex_) local_[v] = kNone;
    }

    const ProgressiveMeshData& data_;
    std::uint64_t lifts_left_;
    PatchedMesh made_;
    std::vector<std::uint32_t> local_;  // local number of a vertex of the mesh
    std::vector<Member> member_, moved_;
    std::vector<std::uint16_t> by_life_;
    std::vector<std::uint32_t> corner_;       // of the members, numbers in the mesh
    std::vector<std::uint16_t> list_corner_;  // of the members, numbers in vertex_
    std::vector<std::uint32_t> vertex_;
    CacheOrder cache_order_;
};

}  // namespace

std::size_t MeshPatches::memory_bytes() const {
    const auto bytes = [](const auto& v) { return v.capacity() * sizeof(v[0]); };
    return bytes(list_first) + bytes(list) + bytes(corner) + bytes(slot) + bytes(vertex) + bytes(parent) +
           bytes(change);
}

PatchedMesh make_patches(const ProgressiveMeshData& data, std::uint64_t lifts_max) {
    return Maker(data, lifts_max).run();
}

}  // namespace tact
