#include "prep/drilling/resample.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <map>

#include "ipc/base/error.hpp"
#include "ipc/scene/bone/bone_volume.hpp"

namespace tact {
namespace {

// Model axes x, y, z as columns, in the patient's frame (LPS); z points at the user.
Eigen::Matrix3d model_axes(BoneFace face) {
    const Vec3 left(1, 0, 0), back(0, 1, 0), up(0, 0, 1);
    Vec3 y = up, z = -back;
    switch (face) {
        case BoneFace::front:
            break;
        case BoneFace::back:
            z = back;
            break;
        case BoneFace::left:
            z = left;
            break;
        case BoneFace::right:
            z = -left;
            break;
        case BoneFace::top:
            z = up;
            y = -back;
            break;
        case BoneFace::bottom:
            z = -up;
            y = -back;
            break;
    }
    Eigen::Matrix3d m;
    m.col(0) = y.cross(z);
    m.col(1) = y;
    m.col(2) = z;
    return m;
}

// The rotation by right angles nearest to the true rotation; never a reflection.
void choose_axes(const Scan& scan, BoneFace face, SamplePlan& plan) {
    const Eigen::Matrix3d r = model_axes(face).transpose() * scan.axes;  // model from scan
    std::array<std::size_t, 3> axis{0, 1, 2};
    double best = -10.0;
    do {
        for (unsigned signs = 0; signs < 8; ++signs) {
            Eigen::Matrix3d turn = Eigen::Matrix3d::Zero();
            for (std::size_t a = 0; a < 3; ++a)
                turn(static_cast<int>(a), static_cast<int>(axis[a])) = (signs >> a & 1U) != 0 ? -1.0 : 1.0;
            if (turn.determinant() < 0.0) continue;
            const double fit = turn.cwiseProduct(r).sum();
            if (fit <= best + 1e-9) continue;
            best = fit;
            plan.axis = axis;
            for (std::size_t a = 0; a < 3; ++a) plan.reversed[a] = (signs >> a & 1U) != 0;
        }
    } while (std::next_permutation(axis.begin(), axis.end()));
}

struct Tap {
    std::uint32_t index;
    float weight;
};
using Taps = std::vector<Tap>;

// Weights of evenly spaced samples around the position `at` (unit: their spacing); empty outside their range.
void put_taps(double at, double half_width, std::uint32_t count, Taps& taps) {
    taps.clear();
    if (at < -0.5 || at > count - 0.5) return;
    at = std::clamp(at, 0.0, count - 1.0);
    const double half = std::max(half_width, 1.0);
    const auto first = static_cast<std::uint32_t>(std::max(0.0, std::ceil(at - half)));
    double sum = 0.0;
    for (std::uint32_t i = first; i < count && i < at + half; ++i) {
        const double w = 1.0 - std::abs(at - i) / half;
        if (w <= 1e-9) continue;
        taps.push_back({i, static_cast<float>(w)});
        sum += w;
    }
    for (Tap& t : taps) t.weight /= static_cast<float>(sum);
}

class SliceSampler {
public:
    SliceSampler(const Scan& scan, const SamplePlan& plan, float outside)
        : scan_(scan), plan_(plan), outside_(outside), pixels_(scan.pixels()) {}

    void plane(double s_mm, std::vector<float>& out) {
        out.assign(std::size_t{plan_.count[0]} * plan_.count[1], 0.0F);
        slice_taps(s_mm);
        planes_.erase(planes_.begin(), planes_.lower_bound(taps_.front().index));
        for (const Tap& tap : taps_) {
            const std::vector<float>& plane = slice(tap.index);
            for (std::size_t i = 0; i < out.size(); ++i) out[i] += tap.weight * plane[i];
        }
    }

private:
    void slice_taps(double s_mm) {
        const auto& slices = scan_.slice;
        const auto above = std::upper_bound(slices.begin(), slices.end(), s_mm,
                                            [](double s, const ScanSlice& slice) { return s < slice.s_mm; });
        const auto b = static_cast<std::uint32_t>(std::clamp<std::ptrdiff_t>(
            above - slices.begin(), 0, static_cast<std::ptrdiff_t>(slices.size()) - 1));
        const std::uint32_t a = b > 0 && above != slices.end() ? b - 1 : b;
        const double gap = slices[b].s_mm - slices[a].s_mm;
        taps_.clear();
        if (a == b || gap >= 0.999 * plan_.voxel_mm) {
            const double t = a == b ? 0.0 : std::clamp((s_mm - slices[a].s_mm) / gap, 0.0, 1.0);
            if (t < 1.0) taps_.push_back({a, static_cast<float>(1.0 - t)});
            if (t > 0.0) taps_.push_back({b, static_cast<float>(t)});
            return;
        }
        std::uint32_t first = a;
        while (first > 0 && s_mm - slices[first - 1].s_mm < plan_.voxel_mm) --first;
        double sum = 0.0;
        for (std::uint32_t i = first; i < slices.size() && slices[i].s_mm - s_mm < plan_.voxel_mm; ++i) {
            const double w = 1.0 - std::abs(slices[i].s_mm - s_mm) / plan_.voxel_mm;
            if (w <= 1e-9) continue;
            taps_.push_back({i, static_cast<float>(w)});
            sum += w;
        }
        for (Tap& t : taps_) t.weight /= static_cast<float>(sum);
    }
    // A slice resampled to the plan's columns and rows: along rows first, then across them.
    const std::vector<float>& slice(std::uint32_t index) {
        const auto [at, fresh] = planes_.try_emplace(index);
        if (!fresh) return at->second;
        scan_.read(index, pixels_);
        const ScanSlice& place = scan_.slice[index];
        const std::uint32_t nu = plan_.count[0], nv = plan_.count[1];
        if (columns_.empty() || place.u_mm != at_u_) {
            columns_.resize(nu);
            for (std::uint32_t i = 0; i < nu; ++i)
                put_taps((plan_.start_mm[0] + i * plan_.voxel_mm - place.u_mm) / scan_.column_mm,
                         plan_.voxel_mm / scan_.column_mm, scan_.columns, columns_[i]);
            at_u_ = place.u_mm;
        }
        rows_.resize(std::size_t{scan_.rows} * nu);
        for (std::uint32_t y = 0; y < scan_.rows; ++y) {
            const float* const from = pixels_.data() + std::size_t{y} * scan_.columns;
            float* const to = rows_.data() + std::size_t{y} * nu;
            for (std::uint32_t i = 0; i < nu; ++i) {
                float sum = columns_[i].empty() ? outside_ : 0.0F;
                for (const Tap& t : columns_[i]) sum += t.weight * from[t.index];
                to[i] = sum;
            }
        }
        std::vector<float>& plane = at->second;
        plane.assign(std::size_t{nu} * nv, 0.0F);
        Taps taps;
        for (std::uint32_t j = 0; j < nv; ++j) {
            float* const to = plane.data() + std::size_t{j} * nu;
            put_taps((plan_.start_mm[1] + j * plan_.voxel_mm - place.v_mm) / scan_.row_mm,
                     plan_.voxel_mm / scan_.row_mm, scan_.rows, taps);
            if (taps.empty()) std::fill(to, to + nu, outside_);
            for (const Tap& t : taps) {
                const float* const from = rows_.data() + std::size_t{t.index} * nu;
                for (std::uint32_t i = 0; i < nu; ++i) to[i] += t.weight * from[i];
            }
        }
        return plane;
    }

    const Scan& scan_;
    const SamplePlan& plan_;
    float outside_;
    std::vector<float> pixels_, rows_;
    std::vector<Taps> columns_;
    double at_u_ = 0.0;
    Taps taps_;
    std::map<std::uint32_t, std::vector<float>> planes_;
};

}  // namespace

PatientFrame SamplePlan::patient(const Scan& scan) const {
    PatientFrame frame;
    Vec3 first_mm = Vec3::Zero();  // voxel (0, 0, 0) of the model, along the scan's axes
    for (std::size_t a = 0; a < 3; ++a) {
        const auto from = static_cast<Eigen::Index>(axis[a]);
        const double sign = reversed[a] ? -1.0 : 1.0;
        frame.axes.col(static_cast<Eigen::Index>(a)) = sign * scan.axes.col(from);
        first_mm[from] = start_mm[axis[a]] + (reversed[a] ? voxel_mm * (count[axis[a]] - 1.0) : 0.0);
    }
    frame.origin_mm = scan.origin_mm + scan.axes * first_mm - 1e3 * (frame.axes * bricks.origin_m);
    return frame;
}

SamplePlan plan_samples(const Scan& scan, double voxel_mm, BoneFace face) {
    SamplePlan plan;
    const auto [u_low, u_high] = std::minmax_element(scan.slice.begin(), scan.slice.end(),
                                                     [](auto& a, auto& b) { return a.u_mm < b.u_mm; });
    const auto [v_low, v_high] = std::minmax_element(scan.slice.begin(), scan.slice.end(),
                                                     [](auto& a, auto& b) { return a.v_mm < b.v_mm; });
    plan.start_mm = {u_low->u_mm, v_low->v_mm, scan.slice.front().s_mm};
    const double tall = scan.slice.back().s_mm - scan.slice.front().s_mm;
    const std::array<double, 3> extent{u_high->u_mm - u_low->u_mm + (scan.columns - 1) * scan.column_mm,
                                       v_high->v_mm - v_low->v_mm + (scan.rows - 1) * scan.row_mm, tall};
    plan.voxel_mm = voxel_mm;
    if (voxel_mm <= 0.0) {
        plan.voxel_mm = std::min(scan.column_mm, scan.row_mm);
        if (scan.slice.size() > 1)
            plan.voxel_mm = std::min(plan.voxel_mm, tall / static_cast<double>(scan.slice.size() - 1));
    }
    choose_axes(scan, face, plan);
    std::array<double, 3> count{};
    for (std::size_t a = 0; a < 3; ++a) count[a] = std::floor(extent[a] / plan.voxel_mm + 1e-6) + 1.0;
    const double longest = *std::max_element(extent.begin(), extent.end());
    const auto refuse = [&](const std::string& why) {
        char fix[160];
        std::snprintf(
            fix, sizeof fix,
            "give a larger --voxel-mm (%.2g gives 1024 voxels along the longest side), or a smaller --crop",
            longest / 1023.0);
        throw StartupError("resample the scan", why, fix);
    };
    for (const double n : count)
        if (!(n <= kBoneEdgeMax))
            refuse("the volume would be " + std::to_string(static_cast<std::uint64_t>(std::min(n, 1e15))) +
                   " voxels long, more than " + std::to_string(kBoneEdgeMax));
    for (std::size_t a = 0; a < 3; ++a) plan.count[a] = static_cast<std::uint32_t>(count[a]);
    plan.bricks.voxel_m = 1e-3 * plan.voxel_mm;
    for (std::size_t a = 0; a < 3; ++a) {
        plan.bricks.size[a] = plan.count[plan.axis[a]];
        plan.bricks.origin_m[static_cast<int>(a)] = -0.5 * plan.bricks.voxel_m * (plan.bricks.size[a] - 1.0);
    }
    if (const std::string fault = bone_bricks_fault(plan.bricks); !fault.empty()) refuse(fault);
    return plan;
}

std::vector<std::uint8_t> sample_density(const Scan& scan, const SamplePlan& plan, double low, double high,
                                         const Progress& progress) {
    std::vector<std::uint8_t> out(plan.bricks.bytes());
    SliceSampler sampler(scan, plan, static_cast<float>(low));
    std::vector<float> plane;
    const auto scale = static_cast<float>(255.0 / (high - low)), zero = static_cast<float>(low);
    for (std::uint32_t k = 0; k < plan.count[2]; ++k) {
        report(progress, static_cast<double>(k) / plan.count[2], "reading and resampling the scan");
        sampler.plane(plan.start_mm[2] + k * plan.voxel_mm, plane);
        std::size_t i = 0;
        for (std::uint32_t v = 0; v < plan.count[1]; ++v) {
            for (std::uint32_t u = 0; u < plan.count[0]; ++u, ++i) {
                if (!(plane[i] > zero)) continue;
                const float d = std::clamp(scale * (plane[i] - zero) + 0.5F, 1.0F, 255.0F);
                out[plan.voxel(u, v, k)] = static_cast<std::uint8_t>(d);
            }
        }
    }
    return out;
}

std::vector<std::uint8_t> sample_labels(const Scan& scan, const SamplePlan& plan, const Scan& labels,
                                        const Progress& progress) {
    const bool together = &scan == &labels || !scan.oriented || !labels.oriented;
    if (together && (labels.columns != scan.columns || labels.rows != scan.rows ||
                     labels.slice.size() != scan.slice.size()))
        throw StartupError(
            "put labels on the scan",
            "the labels are " + std::to_string(labels.columns) + " x " + std::to_string(labels.rows) + " x " +
                std::to_string(labels.slice.size()) + " voxels, the scan is " + std::to_string(scan.columns) +
                " x " + std::to_string(scan.rows) + " x " + std::to_string(scan.slice.size()) +
                ", and one of them has no position",
            "save the labels with the scan's geometry (NRRD, NIfTI or MetaImage with directions)");
    std::vector<std::uint8_t> all(labels.pixels() * labels.slice.size());
    std::vector<float> pixels(labels.pixels());
    for (std::uint32_t k = 0; k < labels.slice.size(); ++k) {
        report(progress, 0.5 * k / static_cast<double>(labels.slice.size()), "reading the labels");
        labels.read(k, pixels);
        for (std::size_t i = 0; i < pixels.size(); ++i) {
            if (!(pixels[i] >= 0.0F && pixels[i] <= 255.0F) || pixels[i] != std::floor(pixels[i]))
                throw StartupError("read the labels",
                                   "a voxel of slice " + std::to_string(k) + " is " +
                                       std::to_string(pixels[i]) + ", not a whole number from 0 to 255",
                                   "give a label volume with --labels, not a scan");
            all[k * pixels.size() + i] = static_cast<std::uint8_t>(pixels[i]);
        }
    }
    const Scan& place = together ? scan : labels;  // the volume that places the labels
    const Eigen::Matrix3d turn = place.axes.transpose() * scan.axes;
    const Vec3 shift = place.axes.transpose() * (scan.origin_mm - place.origin_mm);
    std::vector<double> at_s;
    for (const ScanSlice& s : place.slice) at_s.push_back(s.s_mm);
    const double reach_s = at_s.size() > 1
                               ? 0.51 * (at_s.back() - at_s.front()) / static_cast<double>(at_s.size() - 1)
                               : 0.5 * plan.voxel_mm;
    std::vector<std::uint8_t> out(plan.bricks.bytes());
    for (std::uint32_t k = 0; k < plan.count[2]; ++k) {
        report(progress, 0.5 + 0.5 * k / plan.count[2], "aligning the labels with the scan");
        for (std::uint32_t v = 0; v < plan.count[1]; ++v) {
            for (std::uint32_t u = 0; u < plan.count[0]; ++u) {
                const Vec3 p =
                    turn * Vec3(plan.start_mm[0] + u * plan.voxel_mm, plan.start_mm[1] + v * plan.voxel_mm,
                                plan.start_mm[2] + k * plan.voxel_mm) +
                    shift;
                auto s = static_cast<std::size_t>(std::lower_bound(at_s.begin(), at_s.end(), p.z()) -
                                                  at_s.begin());
                if (s == at_s.size() || (s > 0 && p.z() - at_s[s - 1] < at_s[s] - p.z())) --s;
                if (std::abs(p.z() - at_s[s]) > reach_s) continue;
                const double x = std::floor((p.x() - place.slice[s].u_mm) / place.column_mm + 0.5);
                const double y = std::floor((p.y() - place.slice[s].v_mm) / place.row_mm + 0.5);
                if (!(x >= 0.0 && y >= 0.0 && x < labels.columns && y < labels.rows)) continue;
                const std::uint8_t label =
                    all[s * labels.pixels() + static_cast<std::size_t>(y) * labels.columns +
                        static_cast<std::size_t>(x)];
                if (label != 0) out[plan.voxel(u, v, k)] = label;
            }
        }
    }
    return out;
}

}  // namespace tact
