#include "prep/search/place_symmetric.hpp"

#include <algorithm>
#include <cmath>

#include "ipc/base/error.hpp"
#include "ipc/base/units.hpp"
#include "ipc/scene/density/subtracted_map.hpp"
#include "prep/search/joint_fit.hpp"
#include "prep/search/refine_in_turns.hpp"

namespace tact {
namespace {

constexpr std::size_t kHits = 80;
constexpr std::size_t kTried = 40;  // arrangements, of all symmetries together
constexpr int kRounds = 4;

class Symmetric {
public:
    Symmetric(const DensityGrid& map, const Structure& structure, const std::vector<Symmetry>& symmetries,
              const SearchSettings& settings)
        : map_(map),
          structure_(structure),
          symmetries_(symmetries),
          settings_(settings),
          gyration_m_(radius_of_gyration_m(structure)),
          joint_(search_map(map, settings.background, settings.resolution_m, settings.resolution_m,
                            settings.laplacian)) {
        settings_.hits_max = std::max(settings.hits_max, kHits);
    }

    PlacedSymmetric place(const Progress& progress) {
        found_ = search(map_, structure_, settings_, part(progress, 0.0, 0.7));
        tolerance_m_ = 0.5 * settings_.resolution_m;
        tolerance_rad_ = std::min(tolerance_m_ / gyration_m_, 20.0 * kDegreeRad);
        std::vector<Arrangement> tried;
        const std::size_t of_each = std::max<std::size_t>(kTried / symmetries_.size(), 4);
        for (const Symmetry& symmetry : symmetries_) {
            const std::vector<Arrangement> all = arrangements(symmetry);
            tried.insert(tried.end(), all.begin(),
                         all.begin() + static_cast<std::ptrdiff_t>(std::min(of_each, all.size())));
        }
        if (tried.empty())
            throw StartupError(
                "placing copies of " + structure_.name,
                "no two of its places in the map are related by " +
                    (symmetries_.size() == 1 ? symmetries_.front().name() : "a symmetry"),
                "check the symmetry, the map and the resolution, or search without --symmetry");
        Arrangement best = tried.front();
        best.value = -1.0;
        for (std::size_t i = 0; i < tried.size(); ++i) {
            report(progress, 0.7 + 0.1 * static_cast<double>(i) / static_cast<double>(tried.size()),
                   "copies");
            tried[i].value = correlation(tried[i].symmetry, tried[i].place);
            if (tried[i].value > best.value) best = tried[i];
        }
        return refined(best, progress);
    }

private:
    struct Arrangement {
        Symmetry symmetry;
        SymmetricPlace place;
        double value = 0.0;  // by hits at first, then the correlation of all copies
    };

    [[nodiscard]] double between_m(const Pose& a, const Pose& b) const {
        const double turn_m = gyration_m_ * rotation_vector_rad(a.q * b.q.conjugate()).norm();
        return std::hypot((a.p_m - b.p_m).norm(), turn_m);
    }
    [[nodiscard]] std::vector<Pose> copies(const Symmetry& symmetry, const SymmetricPlace& place) const {
        std::vector<Pose> list;
        for (std::size_t k = 0; k < symmetry.copies(); ++k) list.push_back(pose_of_copy(symmetry, place, k));
        return list;
    }
    // The sum of the scores of hits near the copies.
    [[nodiscard]] double value_by_hits(const Symmetry& symmetry, const SymmetricPlace& place) const {
        double sum = 0.0;
        for (const Pose& copy : copies(symmetry, place))
            for (const SearchHit& hit : found_.hits)
                if (between_m(copy, hit.T_model_body) < 3.0 * tolerance_m_) {
                    sum += hit.score;
                    break;
                }
        return sum;
    }
    void add(std::vector<Arrangement>& list, const Symmetry& symmetry, const Pose& T_model_frame,
             const Pose& copy) const {
        // Of a helix, the hit may be any of the copies.
        const std::size_t as = symmetry.kind == Symmetry::Kind::helical ? symmetry.copies() : 1;
        for (std::size_t k = 0; k < as; ++k) {
            const Pose first = T_model_frame * symmetry.element(k).inverse() * T_model_frame.inverse() * copy;
            const SymmetricPlace place{T_model_frame, first};
            list.push_back({symmetry, place, value_by_hits(symmetry, place)});
        }
    }
    [[nodiscard]] std::vector<Arrangement> arrangements(const Symmetry& symmetry) const {
        std::vector<Arrangement> list;
        const auto& hits = found_.hits;
        for (std::size_t i = 0; i < hits.size(); ++i)
            for (std::size_t j = i + 1; j < hits.size(); ++j) {
                const Pose &from = hits[i].T_model_body, &to = hits[j].T_model_body;
                for (const Pose& frame : frames_from_pair(symmetry, from, to, tolerance_m_, tolerance_rad_)) {
                    if (symmetry.kind != Symmetry::Kind::dihedral) {
                        add(list, symmetry, frame, from);
                        continue;
                    }
                    for (const SearchHit& other : hits) {
                        Pose turned = frame;
                        if (across(turned, from, other.T_model_body, tolerance_m_, tolerance_rad_))
                            add(list, symmetry, turned, from);
                    }
                }
            }
        std::stable_sort(list.begin(), list.end(),
                         [](const Arrangement& a, const Arrangement& b) { return a.value > b.value; });
        return list;
    }
    [[nodiscard]] double correlation(const Symmetry& symmetry, const SymmetricPlace& place) const {
        std::vector<PlacedField> fields;
        for (const Pose& copy : copies(symmetry, place)) fields.push_back(joint_.field(structure_, copy));
        return joint_.correlation(fields);
    }
    [[nodiscard]] std::vector<PlacedStructure> placed(const Symmetry& symmetry,
                                                      const SymmetricPlace& place) const {
        std::vector<PlacedStructure> list;
        for (const Pose& copy : copies(symmetry, place)) list.push_back({&structure_, copy});
        return list;
    }
    PlacedSymmetric refined(Arrangement best, const Progress& progress) {
        PlacedSymmetric out;
        out.symmetry = best.symmetry;
        for (int round = 0; round < kRounds; ++round) {
            report(progress, 0.8 + 0.2 * round / kRounds, "copies");
            std::vector<PlacedStructure> free = placed(best.symmetry, best.place);
            refine_in_turns(map_, settings_.background, settings_.resolution_m, free, 1);
            std::vector<Pose> poses;
            for (const PlacedStructure& p : free) poses.push_back(p.T_model_body);
            const SymmetricPlace next = nearest_symmetric(best.symmetry, poses, best.place, gyration_m_);
            double sum = 0.0;
            for (std::size_t k = 0; k < poses.size(); ++k)
                sum += std::pow(between_m(poses[k], pose_of_copy(best.symmetry, next, k)), 2);
            out.free_difference_m = std::sqrt(sum / static_cast<double>(poses.size()));
            const double value = correlation(best.symmetry, next);
            if (!(value > best.value)) break;
            best.place = next, best.value = value;
        }
        out.place = best.place;
        out.correlation = best.value;
        out.found = std::move(found_);
        out.found.hits.clear();
        for (std::size_t k = 0; k < best.symmetry.copies(); ++k) {
            std::vector<PlacedStructure> others = placed(best.symmetry, best.place);
            const Pose own = others[k].T_model_body;
            others.erase(others.begin() + static_cast<std::ptrdiff_t>(k));
            const DensityGrid rest =
                subtract_placed(map_, settings_.background, others, settings_.resolution_m).grid;
            const double score = place_score(rest, structure_, settings_, own);
            out.found.hits.push_back({own, score, out.found.z_of(score)});
        }
        return out;
    }

    const DensityGrid& map_;
    const Structure& structure_;
    const std::vector<Symmetry>& symmetries_;
    SearchSettings settings_;
    double gyration_m_, tolerance_m_ = 0.0, tolerance_rad_ = 0.0;
    JointFit joint_;
    SearchResult found_;
};

}  // namespace

PlacedSymmetric place_symmetric(const DensityGrid& map, const Structure& structure,
                                const std::vector<Symmetry>& symmetries, const SearchSettings& settings,
                                const Progress& progress) {
    return Symmetric(map, structure, symmetries, settings).place(progress);
}

}  // namespace tact
