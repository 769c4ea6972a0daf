// Method. Every voxel evaluates signed distances of the plan and combines the parts from the outside in: shell, cells
// or spongy bone, hard linings around hollow and soft parts, hollows, soft structures. Each brick evaluates only the parts
// that can come near it.
#include "prep/synthetic/temporal_bone.hpp"

#include <atomic>
#include <string>
#include <thread>

#include "ipc/base/error.hpp"
#include "prep/synthetic/air_cells.hpp"
#include "prep/synthetic/ear_plan.hpp"

namespace tact {
namespace {

constexpr double kShellMm = 1.7, kLiningMm = 1.1, kCapsuleMm = 1.9, kDuraMm = 1.0, kNearMm = 2.5;
constexpr double kCellMm = 2.7, kWallMm = 0.17;  // of a cell; half of a wall
constexpr double kShell = 235.0, kCapsule = 255.0, kWall = 185.0, kSpongy = 135.0, kOssicle = 240.0;

struct EarRow {
    const char* name;
    std::array<std::uint8_t, 4> rgba;
    bool critical;
};
constexpr std::array<EarRow, kEarParts - 1> kEarRows{{{"facial nerve", {255, 221, 64, 255}, true},
                                                      {"chorda tympani", {255, 160, 48, 255}, true},
                                                      {"sigmoid sinus", {56, 92, 200, 255}, true},
                                                      {"dura", {226, 150, 168, 255}, true},
                                                      {"carotid artery", {206, 32, 32, 255}, true},
                                                      {"labyrinth", {150, 84, 204, 255}, true},
                                                      {"malleus", {238, 226, 190, 255}, false},
                                                      {"incus", {214, 196, 150, 255}, true},
                                                      {"stapes", {190, 214, 150, 255}, true}}};

constexpr std::size_t at(EarPart p) { return static_cast<std::size_t>(p); }

class EarPainter {
public:
    EarPainter(const EarPlan& plan, const TemporalBone& s, BoneData& out)
        : plan_(plan), out_(out), seed_(s.seed), step_mm_(kEarMm / s.voxels) {}

    void brick(std::uint32_t bx, std::uint32_t by, std::uint32_t bz) {
        constexpr std::uint32_t kEdge = BoneBricks::kEdge;
        const Vec3 middle = place(kEdge * bx + 3.5, kEdge * by + 3.5, kEdge * bz + 3.5);
        const double reach = 1.3 * 0.87 * kEdge * step_mm_ + kNearMm;
        bool any = EarPlan::outside(middle) < reach;
        for (std::size_t i = 0; i < kEarParts; ++i) {
            near_[i].clear();
            for (const shape::Bar& bar : plan_.part[i])
                if (bar.distance(middle) < reach) near_[i].push_back(bar);
            any = any || (i > 0 && !near_[i].empty());
        }
        if (!any) return;
        const auto& n = out_.bricks.size;
        for (std::uint32_t z = kEdge * bz; z < std::min(n[2], kEdge * (bz + 1)); ++z)
            for (std::uint32_t y = kEdge * by; y < std::min(n[1], kEdge * (by + 1)); ++y)
                for (std::uint32_t x = kEdge * bx; x < std::min(n[0], kEdge * (bx + 1)); ++x)
                    voxel(place(x, y, z), out_.bricks.voxel(x, y, z));
    }

private:
    [[nodiscard]] Vec3 place(double x, double y, double z) const {
        const double half = 0.5 * (kEarMm - step_mm_);
        return step_mm_ * Vec3(x, y, z) - Vec3(half, half, half);
    }
    // Fraction of a voxel that is inside.
    [[nodiscard]] double share(double distance_mm) const {
        return std::clamp(0.5 - distance_mm / step_mm_, 0.0, 1.0);
    }
    // Cells never open into hollow or soft parts: solid bone lines these.
    static double lining(const std::array<double, kEarParts>& d) {
        return std::min({d[at(EarPart::none)], d[at(EarPart::facial_nerve)] - 0.3,
                         d[at(EarPart::sigmoid_sinus)], d[at(EarPart::carotid_artery)]}) -
               kLiningMm;
    }
    [[nodiscard]] double bone(const Vec3& p, double outside, const std::array<double, kEarParts>& d) const {
        const double grain = lattice_noise(seed_ + 3, 2.2 * p);
        if (d[at(EarPart::labyrinth)] < kCapsuleMm) return kCapsule;
        const double hard = std::min(lining(d), -outside - kShellMm);
        const double shell = kShell + 14.0 * grain;
        if (hard < -0.5 * step_mm_) return shell;
        double inner = kSpongy + 30.0 * grain + 30.0 * lattice_noise(seed_ + 4, 5.0 * p);
        const double cellular = EarPlan::cellular(p);
        if (cellular < 0.0) {
            // Cells shrink towards the rim, and walls thicken until the cells close.
            const Vec3 bent =
                p + 0.7 * Vec3(lattice_noise(seed_ + 5, 0.4 * p), lattice_noise(seed_ + 6, 0.4 * p),
                               lattice_noise(seed_ + 7, 0.4 * p));
            const double thick = kWallMm + 0.5 * std::max(0.0, 1.0 + cellular / 2.0);
            const double wall = kCellMm * cell_wall_distance(seed_, bent / kCellMm) - thick;
            inner = (kWall + 25.0 * grain) * share(wall);
        }
        return std::lerp(inner, shell, share(hard));
    }
    void voxel(const Vec3& p, std::size_t index) {
        std::array<double, kEarParts> d;
        for (std::size_t i = 0; i < kEarParts; ++i) d[i] = shape::nearest(near_[i], p);
        const double smooth = EarPlan::outside(p);
        const double outside =
            smooth + 0.3 * lattice_noise(seed_ + 1, p / 3.1) + 0.06 * lattice_noise(seed_ + 2, p / 1.1);
        double density = 0.0;
        if (const double solid = share(outside); solid > 0.0) {
            const double cavity = EarPlan::cavity(p);
            const double walled = std::max(cavity, std::min(1.4 - d[at(EarPart::facial_nerve)], 3.0));
            density = solid * bone(p, outside, d);
            if (cavity < 0.8 && density < kShell)
                density = std::max(density, solid * kShell * share(cavity - 0.8));
            density *= 1.0 - share(walled);
            density *= 1.0 - share(d[at(EarPart::none)]);
            // The eardrum closes the canal.
            if (std::abs(p.z() - 1.7) < 0.25 && Vec3(p.x() - 4.6, p.y(), 0.0).norm() < 3.2)
                density = kSoftDensity;
        }
        EarPart label = EarPart::none;
        for (const EarPart ossicle : {EarPart::malleus, EarPart::incus, EarPart::stapes}) {
            density = std::max(density, kOssicle * share(d[at(ossicle)]));
            if (d[at(ossicle)] < 0.0) label = ossicle;
        }
        const auto soft = [&](EarPart part, double canal_mm) {
            const double in = share(d[at(part)] - canal_mm);
            density = std::lerp(density, kSoftDensity, in);
            if (d[at(part)] < 0.0) label = part;
        };
        if (outside > -0.25 * step_mm_ && smooth < kDuraMm && EarPlan::cranial(p)) {
            density = std::max(density, kSoftDensity * share(smooth - kDuraMm));
            if (density < 0.5 * kShell && share(smooth - kDuraMm) > 0.5) label = EarPart::dura;
        }
        soft(EarPart::labyrinth, 0.0);
        soft(EarPart::carotid_artery, 0.0);
        soft(EarPart::sigmoid_sinus, 0.0);
        soft(EarPart::facial_nerve, 0.3);
        soft(EarPart::chorda_tympani, 0.0);
        out_.density[index] = static_cast<std::uint8_t>(std::lround(std::clamp(density, 0.0, 255.0)));
        out_.label[index] = static_cast<std::uint8_t>(label);
    }

    const EarPlan& plan_;
    BoneData& out_;
    std::uint64_t seed_;
    double step_mm_;
    std::array<std::vector<shape::Bar>, kEarParts> near_;
};

}  // namespace

BoneData make_temporal_bone(const TemporalBone& s, const Progress& progress) {
    BoneData out;
    out.bricks.size = {s.voxels, s.voxels, s.voxels};
    out.bricks.voxel_m = s.voxel_m;
    const double half = 0.5 * s.voxel_m * (s.voxels - 1.0);
    out.bricks.origin_m = Vec3(-half, -half, -half);
    std::string fault = bone_bricks_fault(out.bricks);
    if (fault.empty() && (s.voxels < 16 || s.voxels > 1024))
        fault = "the number of voxels along an axis is outside 16 to 1024";
    if (!fault.empty()) throw StartupError("make a temporal bone", fault, "choose another number of voxels");
    for (const EarRow& row : kEarRows) out.structure.push_back({row.name, row.rgba, row.critical});
    out.density.assign(out.bricks.bytes(), 0);
    out.label.assign(out.bricks.bytes(), 0);

    const EarPlan plan;
    const auto n = out.bricks.bricks();
    std::atomic<std::uint32_t> next{0};
    std::atomic<bool> stop{false};
    const auto work = [&](bool reports) {
        EarPainter painter(plan, s, out);
        for (std::uint32_t row; !stop && (row = next++) < n[2] * n[1];) {
            if (reports) report(progress, static_cast<double>(row) / (n[1] * n[2]), "making a temporal bone");
            for (std::uint32_t bx = 0; bx < n[0]; ++bx) painter.brick(bx, row % n[1], row / n[1]);
        }
    };
    std::vector<std::jthread> others;
    const unsigned cores = std::clamp(std::thread::hardware_concurrency(), 1U, 16U);
    for (unsigned i = 1; i < cores; ++i) others.emplace_back(work, false);
    try {
        work(true);
    } catch (...) {
        stop = true;  // ends the other threads before they are joined
        throw;
    }
    others.clear();
    return out;
}

}  // namespace tact
