#include "gui/drilling/bleeding.hpp"

#include <algorithm>
#include <string_view>

namespace tact {
namespace {

constexpr std::array<std::string_view, 8> kVesselWords{"sinus",   "carotid", "jugular", "artery",
                                                       "arteria", "vessel",  "vein",    "vena"};
// Drops are one voxel each. A sigmoid sinus with 40 opened voxels fills a cavity of a cubic centimetre (37,000 voxels
// of 0.3 mm) in a few seconds; a wall oozes; marrow only stains.
constexpr double kVesselPerS = 150.0, kVesselLastsS = 40.0;
constexpr double kWallPerS = 12.0, kWallLastsS = 8.0;
constexpr double kMarrowPerS = 8.0, kMarrowLastsS = 5.0;
constexpr std::uint8_t kMarrowFrom = 60, kMarrowTo = 190;
constexpr double kMarrowShare = 0.02;  // of the spongy voxels
constexpr double kSealing = 5.0;
constexpr double kOozes_m_s = 0.02;

std::string lower(std::string_view text) {
    std::string out(text);
    for (char& c : out)
        if (c >= 'A' && c <= 'Z') c = static_cast<char>(c - 'A' + 'a');
    return out;
}

}  // namespace

Bleeding::Bleeding(const BoneBricks& bricks, const std::vector<BoneStructure>& structures,
                   std::span<const std::uint8_t> label, std::uint64_t seed)
    : bricks_(bricks), label_(label), random_(seed) {
    for (std::size_t i = 0; i < std::min<std::size_t>(structures.size(), 255); ++i) {
        const std::string name = lower(structures[i].name);
        is_vessel_[i + 1] = std::any_of(kVesselWords.begin(), kVesselWords.end(), [&](std::string_view word) {
            return name.find(word) != std::string::npos;
        });
    }
    wounds_.reserve(kWoundsMost);
}

bool Bleeding::vessel(std::uint32_t x, std::uint32_t y, std::uint32_t z) const noexcept {
    // Unsigned: the voxel before the first wraps beyond the last.
    return x < bricks_.size[0] && y < bricks_.size[1] && z < bricks_.size[2] &&
           is_vessel_[label_[bricks_.voxel(x, y, z)]];
}

void Bleeding::cut(std::uint32_t x, std::uint32_t y, std::uint32_t z, std::uint8_t density) noexcept {
    if (x >= bricks_.size[0] || y >= bricks_.size[1] || z >= bricks_.size[2]) return;
    if (!label_.empty()) {
        if (vessel(x, y, z)) return open(x, y, z, kVesselPerS, kVesselLastsS);
        const bool beside = vessel(x - 1, y, z) || vessel(x + 1, y, z) || vessel(x, y - 1, z) ||
                            vessel(x, y + 1, z) || vessel(x, y, z - 1) || vessel(x, y, z + 1);
        if (beside) return open(x, y, z, kWallPerS, kWallLastsS);
    }
    if (density >= kMarrowFrom && density <= kMarrowTo && random_.uniform() < kMarrowShare)
        open(x, y, z, kMarrowPerS, kMarrowLastsS);
}

void Bleeding::open(std::uint32_t x, std::uint32_t y, std::uint32_t z, double drops_per_s,
                    double lasts_s) noexcept {
    const Wound wound{bricks_.to_model(Vec3(x, y, z)), drops_per_s, lasts_s, 0.0};
    if (wounds_.size() < kWoundsMost) {
        wounds_.push_back(wound);
        return;
    }
    wounds_[oldest_] = wound;
    oldest_ = (oldest_ + 1) % kWoundsMost;
}

void Bleeding::close(const ParticleCells& cells) noexcept {
    std::erase_if(wounds_, [&](const Wound& w) {
        const Vec3 at = cells.to_cells(w.at_m);
        return cells.bone({static_cast<int>(at.x()), static_cast<int>(at.y()), static_cast<int>(at.z())});
    });
    if (wounds_.size() < kWoundsMost) oldest_ = 0;
}

void Bleeding::step(double dt_s, std::size_t drops_most, Particles& particles) noexcept {
    const ParticleCells& cells = particles.cells();
    for (std::size_t i = 0; i < wounds_.size();) {
        Wound& w = wounds_[i];
        const Vec3 at = cells.to_cells(w.at_m);
        const Cell c = {static_cast<int>(at.x()), static_cast<int>(at.y()), static_cast<int>(at.z())};
        const CellState over = cells.inside(c) ? cells.state(c) : CellState::free;
        const bool sealed = over == CellState::grain || over == CellState::paste;
        w.left_s -= sealed ? kSealing * dt_s : dt_s;
        if (w.left_s <= 0.0) {
            w = wounds_.back();
            wounds_.pop_back();
            continue;
        }
        ++i;
        if (sealed) continue;
        w.owed = std::min(w.owed + w.drops_per_s * dt_s, 0.2 * w.drops_per_s + 1.0);
        for (; w.owed >= 1.0 && drops_most > 0; w.owed -= 1.0, --drops_most) {
            if (!particles.emit(Matter::blood, w.at_m, kOozes_m_s * random_.direction())) break;
            ++drops_;
        }
    }
    if (wounds_.size() < kWoundsMost) oldest_ = 0;
}

}  // namespace tact
