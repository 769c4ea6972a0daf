#include "tests/reproduce/fitting.hpp"

#include <chrono>
#include <cmath>
#include <cstdio>
#include <functional>
#include <nlohmann/json.hpp>
#include <optional>

#include "deploy/tact/files.hpp"
#include "ipc/base/error.hpp"
#include "ipc/base/random.hpp"
#include "ipc/base/units.hpp"
#include "ipc/scene/density/subtracted_map.hpp"
#include "prep/map/import_map.hpp"
#include "prep/map/map_statistics.hpp"
#include "prep/search/place_together.hpp"
#include "prep/structure/import_structure.hpp"
#include "prep/synthetic/ring.hpp"
#include "tests/reproduce/draw.hpp"
#include "tests/reproduce/fitting_bend.hpp"
#include "tests/reproduce/fitting_hand.hpp"
#include "tests/reproduce/text.hpp"

namespace tact::launch {
namespace {

namespace fs = std::filesystem;
constexpr double kHandFarM = 30.0 * kAngstromM, kHandFarRad = 60.0 * kDegreeRad, kHandSeconds = 20.0;
constexpr double kRightM = 3.0 * kAngstromM, kBentRightM = 1.5 * kAngstromM, kEqualScore = 0.01;

struct Pair {
    std::string name;
    DensityGrid grid;
    SearchSettings settings;
    std::vector<Structure> structures;
};

std::vector<std::string> split(const std::string& line) {
    std::vector<std::string> words;
    for (std::size_t from = 0; from <= line.size();) {
        const std::size_t to = std::min(line.find(',', from), line.size());
        words.push_back(line.substr(from, to - from));
        from = to + 1;
    }
    return words;
}

Pair ready(std::string name, DensityGrid grid, double resolution_m, std::vector<Structure> structures) {
    const MapStatistics statistics = map_statistics(grid);
    return {std::move(name),
            std::move(grid),
            {.resolution_m = resolution_m, .background = statistics.background},
            std::move(structures)};
}

Pair pair_of(const std::string& line) {
    const std::vector<std::string> words = split(line);
    char* end = nullptr;
    const double resolution_a = words.size() > 2 ? std::strtod(words[1].c_str(), &end) : 0.0;
    if (!(resolution_a > 0.0) || *end != '\0')
        throw StartupError("reading the pair '" + line + "'", "it is not MAP,RESOLUTION,MODEL",
                           "name a map, its resolution in angstrom and one or more structures, with commas");
    std::vector<Structure> structures;
    for (std::size_t i = 2; i < words.size(); ++i) structures.push_back(import_structure(words[i]).structure);
    return ready(fs::path(words[0]).filename().string(), import_map(words[0]).grid, resolution_a * kAngstromM,
                 std::move(structures));
}

double rmsd_m(const Structure& s, const Pose& a, const Pose& b) {
    double sum = 0.0;
    for (std::size_t i = 0; i < s.size(); ++i) {
        const Vec3 at(static_cast<double>(s.x_m[i]), static_cast<double>(s.y_m[i]),
                      static_cast<double>(s.z_m[i]));
        sum += ((a.p_m + a.q * at) - (b.p_m + b.q * at)).squaredNorm();
    }
    return std::sqrt(sum / static_cast<double>(s.size()));
}

// The same where equal chains may have changed places, as in a ring of copies that is turned by one: each chain at `a` against the
// nearest one at `b` with as many atoms; large unless that pairs them all.
double rmsd_of_equal_m(const Structure& s, const Pose& a, const Pose& b) {
    std::vector<std::pair<std::size_t, std::size_t>> chains;  // first atom, atoms
    for (std::size_t i = 0; i < s.size(); ++i) {
        if (i == 0 || s.chain[i] != s.chain[i - 1]) chains.emplace_back(i, 0);
        ++chains.back().second;
    }
    const auto at = [&](std::size_t i) {
        return Vec3(static_cast<double>(s.x_m[i]), static_cast<double>(s.y_m[i]),
                    static_cast<double>(s.z_m[i]));
    };
    std::vector<bool> taken(chains.size(), false);
    double sum = 0.0;
    for (const auto& [first, atoms] : chains) {
        double least = 1.0;
        std::size_t with = chains.size();
        for (std::size_t k = 0; k < chains.size(); ++k) {
            if (taken[k] || chains[k].second != atoms) continue;
            double squares = 0.0;
            for (std::size_t i = 0; i < atoms; ++i)
                squares += (a * at(first + i) - b * at(chains[k].first + i)).squaredNorm();
            if (squares < least) least = squares, with = k;
        }
        if (with == chains.size()) return 1.0;
        taken[with] = true;
        sum += least;
    }
    return std::sqrt(sum / static_cast<double>(s.size()));
}

// A structure whose atoms are turned; its place in the map is then the inverse rotation. So a search has no advantage from
// the orientation of the file.
Structure turned(const Structure& s, const Quat& by) {
    Structure out = s;
    for (std::size_t i = 0; i < s.size(); ++i) {
        const Vec3 at = by * Vec3(static_cast<double>(s.x_m[i]), static_cast<double>(s.y_m[i]),
                                  static_cast<double>(s.z_m[i]));
        out.x_m[i] = static_cast<float>(at.x());
        out.y_m[i] = static_cast<float>(at.y());
        out.z_m[i] = static_cast<float>(at.z());
    }
    return out;
}

struct FitRow {
    std::string pair, model, test;
    int starts = 0, right = 0, equal = 0;
    double seconds = 0.0;  // median of a start
    double away_a = 0.0;   // median of the right ones
};

double median(std::vector<double> v) {
    if (v.empty()) return 0.0;
    std::nth_element(v.begin(), v.begin() + static_cast<std::ptrdiff_t>(v.size() / 2), v.end());
    return v[v.size() / 2];
}

class Fitting {
public:
    explicit Fitting(const FittingExperiment& e) : e_(e) {}

    void run(const Pair& p) {
        for (std::size_t i = 0; i < p.structures.size(); ++i) {
            search_alone(p, i);
            refine_near(p, i, p.grid, "");
            led_by_hand(p, i);
            bend(p, i);
            if (p.structures.size() < 2) continue;
            if (!does("refine")) continue;
            std::vector<PlacedStructure> others;
            for (std::size_t k = 0; k < p.structures.size(); ++k)
                if (k != i) others.push_back({&p.structures[k], p.structures[k].home()});
            refine_near(p, i,
                        subtract_placed(p.grid, p.settings.background, others, p.settings.resolution_m).grid,
                        ", others subtracted");
        }
        if (p.structures.size() > 1) together(p);
    }
    [[nodiscard]] const std::vector<FitRow>& rows() const { return rows_; }

private:
    using Find = std::function<std::pair<Pose, double>(SeededRandom&)>;

    void repeat(const Pair& p, const Structure& s, const DensityGrid& grid, const std::string& test,
                const Find& find) {
        const RefineResult answer = refine_place(grid, s, p.settings, s.home());
        FitRow row{p.name, s.name, test, e_.starts, 0, 0, 0.0, 0.0};
        std::vector<double> seconds, away;
        for (int k = 0; k < e_.starts; ++k) {
            SeededRandom random(e_.seed + static_cast<std::uint64_t>(k));
            const auto begin = std::chrono::steady_clock::now();
            const auto [place, score] = find(random);
            seconds.push_back(
                std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count());
            const double off_m = rmsd_m(s, place, answer.T_model_body);
            if (off_m < kRightM) {
                ++row.right;
                away.push_back(rmsd_m(s, place, s.home()) / kAngstromM);
            } else if (rmsd_of_equal_m(s, place, answer.T_model_body) < kRightM ||
                       std::abs(score - answer.score) < kEqualScore) {
                ++row.equal;
            }
        }
        row.seconds = median(seconds);
        row.away_a = median(away);
        std::printf("%-26s %-30s %-38s %3d right, %2d equal of %d; %.2f A from the file; %.1f s\n",
                    row.pair.c_str(), row.model.c_str(), row.test.c_str(), row.right, row.equal, row.starts,
                    row.away_a, row.seconds);
        std::fflush(stdout);
        rows_.push_back(row);
    }
    void search_alone(const Pair& p, std::size_t i) {
        if (!does("search")) return;
        const Structure& s = p.structures[i];
        repeat(p, s, p.grid, "search alone", [&](SeededRandom& random) {
            const Quat by = random.rotation();
            const SearchHit hit = search(p.grid, turned(s, by), p.settings).hits.at(0);
            return std::pair{Pose{hit.T_model_body.p_m, hit.T_model_body.q * by}, hit.score};
        });
    }
    void refine_near(const Pair& p, std::size_t i, const DensityGrid& grid, const std::string& where) {
        if (!does("refine")) return;
        const Structure& s = p.structures[i];
        for (const double far : {1.0, 2.0}) {
            const double shift_m = far * 10.0 * kAngstromM, turn_rad = far * 20.0 * kDegreeRad;
            repeat(p, s, grid, text("refine from %.0f A, %.0f deg", 10.0 * far, 20.0 * far) + where,
                   [&](SeededRandom& random) {
                       Pose start = s.home();
                       start.p_m += shift_m * random.direction();
                       const Vec3 axis = random.direction();
                       start.q = quat_from_rotation_vector(turn_rad * axis);
                       SearchSettings near = p.settings;
                       near.near = SearchNear{start, shift_m, turn_rad};
                       const SearchHit hit = search(grid, s, near).hits.at(0);
                       return std::pair{hit.T_model_body, hit.score};
                   });
        }
    }
    [[nodiscard]] bool does(const char* what) const { return e_.only.empty() || e_.only == what; }
    // From where a hand finds a place only rarely: without and with the pull towards the places of one search.
    void led_by_hand(const Pair& p, std::size_t i) {
        if (!does("hand")) return;
        const Structure& s = p.structures[i];
        const HandInMap hand(p.grid, s, p.settings.resolution_m);
        const std::vector<SearchHit> found = search(p.grid, s, p.settings).hits;
        struct Way {
            const char* name;
            bool pull, laplacian;
        };
        for (const auto& [name, pull, laplacian] :
             {Way{"", false, false}, Way{", pull", true, false}, Way{", Laplacian, pull", true, true}}) {
            repeat(
                p, s, p.grid,
                text("hand from %.0f A, %.0f deg", kHandFarM / kAngstromM, kHandFarRad / kDegreeRad) + name,
                [&, pull = pull, laplacian = laplacian](SeededRandom& random) {
                    Pose start = s.home();
                    start.p_m += kHandFarM * random.direction();
                    const Vec3 axis = random.direction();
                    start.q = quat_from_rotation_vector(kHandFarRad * axis);
                    const Pose end = hand.led_from(start, pull ? found : std::vector<SearchHit>{}, laplacian,
                                                   kHandSeconds);
                    return std::pair{end, refine_place(p.grid, s, p.settings, end).score};
                });
        }
    }
    void bend(const Pair& p, std::size_t i) {
        if (!does("bend")) return;
        const Structure& s = p.structures[i];
        FitRow row{p.name, s.name, text("bent by %.0f A, back in its map", kBentM / kAngstromM), 0, 0, 0,
                   0.0,    0.0};
        std::vector<double> seconds, left;
        int torn = 0;
        for (int k = 0; k < e_.starts; ++k) {
            SeededRandom random(e_.seed + static_cast<std::uint64_t>(k));
            const auto begin = std::chrono::steady_clock::now();
            const Bending bending = bend_back(s, random);
            torn += bending.torn;
            if (bending.left_m < 0.0) {
                std::printf(
                    "%-26s %-30s cannot be bent by %.0f A: too small, or every answer was torn (%d)\n",
                    p.name.c_str(), s.name.c_str(), kBentM / kAngstromM, bending.torn);
                return;
            }
            seconds.push_back(
                std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count());
            left.push_back(bending.left_m / kAngstromM);
            ++row.starts;
            row.right += bending.left_m < kBentRightM ? 1 : 0;
        }
        row.seconds = median(seconds);
        row.away_a = median(left);
        std::printf(
            "%-26s %-30s %-38s %3d right of %d; %.2f A left, at most %.2f; %.1f s; %d torn answers not "
            "used\n",
            row.pair.c_str(), row.model.c_str(), row.test.c_str(), row.right, row.starts, row.away_a,
            *std::max_element(left.begin(), left.end()), row.seconds, torn);
        std::fflush(stdout);
        rows_.push_back(row);
    }
    void together(const Pair& p) {
        if (!does("together")) return;
        std::vector<FitRow> each;
        std::vector<std::vector<double>> away(p.structures.size());
        std::vector<double> seconds;
        for (const Structure& s : p.structures)
            each.push_back({p.name, s.name, "together", e_.starts, 0, 0, 0.0, 0.0});
        for (int k = 0; k < e_.starts; ++k) {
            SeededRandom random(e_.seed + static_cast<std::uint64_t>(k));
            std::vector<Structure> moved;
            std::vector<Quat> by;
            for (const Structure& s : p.structures) {
                by.push_back(random.rotation());
                moved.push_back(turned(s, by.back()));
            }
            const auto begin = std::chrono::steady_clock::now();
            const PlacedTogether placed = place_together(p.grid, moved, p.settings);
            seconds.push_back(
                std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count());
            for (std::size_t i = 0; i < moved.size(); ++i) {
                if (placed.found[i].hits.empty()) continue;
                const Pose& at = placed.found[i].hits.front().T_model_body;
                const double off_m = rmsd_m(p.structures[i], {at.p_m, at.q * by[i]}, p.structures[i].home());
                each[i].right += off_m < kRightM ? 1 : 0;
                away[i].push_back(off_m / kAngstromM);
            }
        }
        for (std::size_t i = 0; i < each.size(); ++i) {
            each[i].seconds = median(seconds);
            each[i].away_a = median(away[i]);
            std::printf("%-26s %-30s %-38s %3d right of %d; %.2f A from the file; %.1f s\n",
                        each[i].pair.c_str(), each[i].model.c_str(), "together", each[i].right,
                        each[i].starts, each[i].away_a, each[i].seconds);
            rows_.push_back(each[i]);
        }
        std::fflush(stdout);
    }

    const FittingExperiment& e_;
    std::vector<FitRow> rows_;
};

nlohmann::ordered_json json_of(const FittingExperiment& e, const std::vector<FitRow>& rows) {
    nlohmann::ordered_json json{
        {"seed", e.seed}, {"right_a", kRightM / kAngstromM}, {"rows", nlohmann::ordered_json::array()}};
    for (const FitRow& r : rows)
        json["rows"].push_back({{"pair", r.pair},
                                {"model", r.model},
                                {"test", r.test},
                                {"starts", r.starts},
                                {"right", r.right},
                                {"equal", r.equal},
                                {"median_s", r.seconds},
                                {"median_from_file_a", r.away_a}});
    return json;
}

}  // namespace

int reproduce_fitting(const FittingExperiment& wanted) {
    FittingExperiment e = wanted;
    if (e.quick) e.starts = 1;
    write_whole(e.out / ".writable", "");  // checks now, not after minutes
    fs::remove(e.out / ".writable");
    Fitting fitting(e);
    std::printf("seeds %llu to %llu, one per start\n", static_cast<unsigned long long>(e.seed),
                static_cast<unsigned long long>(e.seed) + static_cast<unsigned long long>(e.starts) - 1);
    if (e.pairs.empty()) {
        SyntheticRing ring = make_ring();
        ring.subunits.resize(e.quick ? 1 : 3);
        fitting.run(
            ready("synthetic ring", std::move(ring.grid), ring.resolution_m, std::move(ring.subunits)));
    }
    for (const std::string& line : e.pairs) fitting.run(pair_of(line));
    write_whole(e.out / "fitting.json", json_of(e, fitting.rows()).dump(2) + "\n");
    draw_figures(e.out);
    std::printf("wrote %s and a figure in the same folder\n", (e.out / "fitting.json").c_str());
    return 0;
}

}  // namespace tact::launch
