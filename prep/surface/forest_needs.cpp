#include "prep/surface/forest_needs.hpp"

#include <algorithm>
#include <array>

namespace tact {
namespace {

// Collects the needs along every edge of the mesh; nodes are indexed by their order of merging.
class NeedCollector {
public:
    NeedCollector(std::span<const std::uint32_t> corner, std::uint32_t leaves, std::size_t nodes,
                  const Ancestors& ancestors)
        : ancestors_(ancestors), leaves_(leaves), head_(nodes, kNoForestNode) {
        for (std::size_t t = 0; t < corner.size(); t += 3)
            for (std::size_t i = 0; i < 3; ++i) walk_up(corner[t + i], corner[t + (i + 1) % 3]);
    }
    template <class Visit>
    void each(std::uint32_t of, Visit&& visit) const {
        for (std::uint32_t e = head_[of]; e != kNoForestNode; e = need_[e][1]) visit(need_[e][0]);
    }

private:
    // If a merge on one side of an edge is followed by one on the other side, the star of the later one contains what
    // the earlier one removed: a need. Consecutive merges on one side are parent and child and need no entry.
    void walk_up(std::uint32_t a, std::uint32_t b) {
        while (ancestors_.parent(a) != ancestors_.parent(b)) {
            if (ancestors_.parent(a) > ancestors_.parent(b))
                std::swap(a, b);  // the next merge is on the side of a
            const std::uint32_t other = ancestors_.parent(b);
            a = ancestors_.highest(a, other);
            if (other != kNoForestNode && ancestors_.parent(a) != other) add(a - leaves_, other - leaves_);
        }
    }
    void add(std::uint32_t of, std::uint32_t need) {
        for (std::uint32_t e = head_[of]; e != kNoForestNode; e = need_[e][1])
            if (need_[e][0] == need) return;
        need_.push_back({need, head_[of]});
        head_[of] = static_cast<std::uint32_t>(need_.size() - 1);
    }
    const Ancestors& ancestors_;
    std::uint32_t leaves_;
    std::vector<std::uint32_t> head_;                 // per node: first entry in need_
    std::vector<std::array<std::uint32_t, 2>> need_;  // node, and index of the next entry
};

std::span<const std::uint32_t> needs_of(std::uint32_t n, std::span<const ForestNode> node,
                                        const std::vector<std::uint32_t>& need) {
    const std::size_t end = n + 1 < node.size() ? node[n + 1].first_need : need.size();
    return std::span(need).subspan(node[n].first_need, end - node[n].first_need);
}

// Removes needs that another need implies, so that every step of refinement checks fewer. The cut is the same, because
// splits and merges follow whole chains. Implied needs beyond the search limit stay.
std::vector<std::uint32_t> without_implied(std::span<ForestNode> node,
                                           const std::vector<std::uint32_t>& need) {
    constexpr std::size_t kImpliedMax = 64;
    std::vector<std::uint32_t> kept, first(node.size()), implied;
    std::uint32_t last = 0;  // highest number among the needs
    const auto imply = [&](std::uint32_t n) {
        if (n == kNoForestNode || node[n].number > last || implied.size() == kImpliedMax) return;
        if (std::find(implied.begin(), implied.end(), n) == implied.end()) implied.push_back(n);
    };
    const auto imply_needs_of = [&](std::uint32_t n) {
        imply(node[n].parent);
        for (const std::uint32_t m : needs_of(n, node, need)) imply(m);
    };
    for (std::uint32_t n = 0; n < node.size(); ++n) {
        const auto own = needs_of(n, node, need);
        first[n] = static_cast<std::uint32_t>(kept.size());
        last = 0;
        for (const std::uint32_t m : own) last = std::max(last, node[m].number);
        implied.clear();
        if (node[n].parent != kNoForestNode) imply_needs_of(node[n].parent);
        for (const std::uint32_t m : own) imply_needs_of(m);
        for (std::size_t i = 0; i < implied.size(); ++i) imply_needs_of(implied[i]);
        for (const std::uint32_t m : own)
            if (std::find(implied.begin(), implied.end(), m) == implied.end()) kept.push_back(m);
    }
    for (std::uint32_t n = 0; n < node.size(); ++n) node[n].first_need = first[n];
    return kept;
}

}  // namespace

Ancestors::Ancestors(std::span<const std::uint32_t> parent) : parent_(parent), jump_(parent.size()) {
    std::vector<std::uint32_t> depth(parent.size(), 0);
    for (auto p = static_cast<std::uint32_t>(parent.size()); p-- > 0;) {  // parents first
        const std::uint32_t up = parent[p];
        if (up == kNoForestNode) {
            jump_[p] = p;
            continue;
        }
        depth[p] = depth[up] + 1;
        const std::uint32_t far = jump_[up];
        jump_[p] = depth[up] - depth[far] == depth[far] - depth[jump_[far]] ? jump_[far] : up;
    }
}

std::vector<std::uint32_t> forest_needs(std::span<const std::uint32_t> corner, std::uint32_t leaves,
                                        const Ancestors& ancestors, std::span<const std::uint32_t> number,
                                        std::span<ForestNode> node) {
    std::vector<std::uint32_t> need;
    {
        const NeedCollector collected(corner, leaves, node.size(), ancestors);
        std::vector<std::uint32_t> merge(node.size());  // per node of the forest
        for (std::uint32_t s = 0; s < node.size(); ++s) merge[number[leaves + s]] = s;
        std::vector<std::uint32_t> own;
        for (std::uint32_t n = 0; n < node.size(); ++n) {
            node[n].first_need = static_cast<std::uint32_t>(need.size());
            own.clear();
            collected.each(merge[n], [&](std::uint32_t s) { own.push_back(number[leaves + s]); });
            std::sort(own.begin(), own.end());  // read in order of memory
            need.insert(need.end(), own.begin(), own.end());
        }
    }
    return without_implied(node, need);
}

}  // namespace tact
