#include <algorithm>
#include <cmath>
#include <cstdio>
#include <map>
#include <memory>

#include "ipc/base/error.hpp"
#include "ipc/base/printed.hpp"
#include "prep/volume/dicom.hpp"
#include "prep/volume/slice_gaps.hpp"

namespace tact {
namespace {

constexpr std::size_t kVolumeSlices = 8;  // fewer slices are a localizer
constexpr double kUneven = 0.01, kTiltRad = 2e-3;

bool same_picture(const DicomSlice& a, const DicomSlice& b) {
    return a.series_uid == b.series_uid && a.columns == b.columns && a.rows == b.rows &&
           a.placed == b.placed && (a.along_row - b.along_row).norm() < 1e-3 &&
           (a.down_rows - b.down_rows).norm() < 1e-3 && std::abs(a.column_mm - b.column_mm) < 1e-3 &&
           std::abs(a.row_mm - b.row_mm) < 1e-3;
}

using DicomGroup = std::vector<DicomSlice>;

std::string told(const DicomGroup& g) {
    char text[200];
    std::snprintf(text, sizeof text, "%.16s, series number %d, %zu slices of %u x %u pixels of %.3g mm",
                  g[0].modality.c_str(), g[0].series_number, g.size(), g[0].columns, g[0].rows,
                  g[0].column_mm);
    return text;
}

bool is_volume(const DicomGroup& g) { return g.size() >= kVolumeSlices && g[0].placed; }

std::vector<DicomGroup> grouped_slices(std::vector<DicomSlice> slices) {
    // Makes the list independent of the order in which the folder is read.
    std::sort(slices.begin(), slices.end(), [](const DicomSlice& a, const DicomSlice& b) {
        return std::tie(a.series_number, a.series_uid, a.path) <
               std::tie(b.series_number, b.series_uid, b.path);
    });
    std::vector<DicomGroup> groups;
    for (DicomSlice& s : slices) {
        const auto found = std::find_if(groups.begin(), groups.end(),
                                        [&](const DicomGroup& g) { return same_picture(g[0], s); });
        if (found != groups.end())
            found->push_back(std::move(s));
        else
            groups.emplace_back().push_back(std::move(s));
    }
    return groups;
}

DicomGroup choose(std::vector<DicomGroup> groups, unsigned series, const std::string& attempt, Scan& scan) {
    std::string list;
    for (std::size_t i = 0; i < groups.size() && i < 40; ++i)
        list += "\n  " + std::to_string(i + 1) + ": " + told(groups[i]);
    if (series > groups.size())
        throw StartupError(attempt, "series " + std::to_string(series) + " is not in this list:" + list,
                           "choose a series with --series");
    if (series > 0) return std::move(groups[series - 1]);
    if (groups.size() == 1) return std::move(groups[0]);
    std::size_t volumes = 0, chosen = 0;
    for (std::size_t i = 0; i < groups.size(); ++i) {
        if (!is_volume(groups[i])) continue;
        ++volumes;
        chosen = i;
    }
    if (volumes != 1)
        throw StartupError(attempt,
                           "the folder holds " + std::to_string(groups.size()) +
                               " series, or images of several sizes or directions:" + list,
                           "choose a series with --series");
    scan.note.push_back("series: " + std::to_string(chosen + 1) + " of " + std::to_string(groups.size()) +
                        ", the only one that is a volume");
    return std::move(groups[chosen]);
}

void check_pictures(const DicomGroup& g, const std::string& attempt) {
    const auto fail = [&](const std::string& why, const char* fix) { throw StartupError(attempt, why, fix); };
    for (const DicomSlice& s : g) {
        const std::string name = s.path.filename().string();
        if (s.frames > 1)
            fail(name + " has " + std::to_string(s.frames) + " frames in one file, which is not supported",
                 "save the series as one file per slice, or as NRRD or NIfTI");
        if (!s.placed)
            fail(name + " has no slice position (image position, orientation, pixel spacing)",
                 "export the original slices again, with their positions");
        if (s.samples != 1 || s.photometric != "MONOCHROME2")
            fail(name + " is an image of type \"" + s.photometric.substr(0, 16) + "\", not of grey values",
                 "choose the series of the original slices with --series");
        if (!(s.slope != 0.0 && std::isfinite(s.slope) && std::isfinite(s.intercept)))
            fail(name + ": the rescale slope or intercept is invalid", "export the series again");
    }
    if (g.size() < 2) fail("the series has only one slice", "give the folder with all slices of the series");
}

// Of a slice with another size that lies where one is missing.
std::string lies_there(const DicomGroup& g, const std::vector<DicomSlice>& left_out, const Vec3& normal,
                       double from_mm, double to_mm) {
    for (const DicomSlice& s : left_out) {
        const double at_mm = s.position_mm.dot(normal);
        const bool same = s.placed && s.series_uid == g[0].series_uid &&
                          s.along_row.cross(s.down_rows).normalized().dot(normal) > 0.999;
        if (same && at_mm > from_mm && at_mm < to_mm)
            return printed("; %s is there, but has %u x %u pixels of %.3g mm instead of %u x %u of %.3g mm",
                           s.path.filename().string().c_str(), s.columns, s.rows, s.column_mm, g[0].columns,
                           g[0].rows, g[0].column_mm);
    }
    return {};
}

void check_missing(const DicomGroup& g, const std::vector<DicomSlice>& left_out, const Scan& scan,
                   const SliceGaps& gaps, const std::string& attempt) {
    if (gaps.missing.empty()) return;
    std::size_t missing = 0;
    std::string where;
    const Vec3 normal = g[0].along_row.cross(g[0].down_rows).normalized();
    for (const MissingSlices& m : gaps.missing) {
        missing += m.count;
        if (where.size() > 200) continue;
        where += printed("%s%.2f and %.2f mm", where.empty() ? "" : ", ", scan.slice[m.after].s_mm,
                         scan.slice[m.after + 1].s_mm);
        where += lies_there(g, left_out, normal, g[m.after].position_mm.dot(normal),
                            g[m.after + 1].position_mm.dot(normal));
    }
    throw StartupError(attempt,
                       printed("%zu %s missing: the spacing is %.3g mm, except between ", missing,
                               missing == 1 ? "slice is" : "slices are", gaps.typical_mm) +
                           where,
                       "add the missing slices, or remove the slices on one side of the gap");
}

void check_gaps(const DicomGroup& g, const std::vector<DicomSlice>& left_out, const Eigen::Matrix3d& axes,
                const std::string& attempt, Scan& scan) {
    std::vector<double> at_mm, gap;
    for (const ScanSlice& s : scan.slice) at_mm.push_back(s.s_mm);
    const SliceGaps gaps = slice_gaps(at_mm);
    for (std::size_t i = 0; i + 1 < at_mm.size(); ++i) {
        gap.push_back(at_mm[i + 1] - at_mm[i]);
        if (gap[i] < 1e-3 || gap[i] < 0.02 * gaps.typical_mm)
            throw StartupError(attempt,
                               g[i].path.filename().string() + " and " + g[i + 1].path.filename().string() +
                                   " have the same position: the series holds several scans",
                               "keep one of the scans in the folder");
    }
    check_missing(g, left_out, scan, gaps, attempt);
    char text[240];
    if (gaps.parts.size() > 1) {
        std::string parts;
        for (const SlicePart& p : gaps.parts)
            parts += printed("%s%.4g mm from %.1f to %.1f mm", parts.empty() ? "" : ", ", p.spacing_mm,
                             at_mm[p.first], at_mm[p.first + p.gaps]);
        scan.warning.push_back("the slices have several spacings and were resampled by their positions: " +
                               parts);
    }
    const auto [low, high] = std::minmax_element(gap.begin(), gap.end());
    if (gaps.parts.size() < 2 && *high - *low > kUneven * gaps.typical_mm) {
        std::snprintf(text, sizeof text, "slices are %.4g to %.4g mm apart and were resampled", *low, *high);
        scan.warning.emplace_back(text);
    }
    const Vec3 way = axes.transpose() * (g.back().position_mm - g.front().position_mm);
    const double tilt = std::atan2(std::hypot(way.x(), way.y()), way.z());
    if (tilt > kTiltRad) {
        const double degrees = tilt * 57.29577951308232;
        std::snprintf(text, sizeof text,
                      "the gantry was tilted by %.1f degrees; each slice is sampled at its true position",
                      degrees);
        scan.warning.emplace_back(text);
        if (tilt > 0.6) {
            std::snprintf(text, sizeof text, "the gantry was tilted by %.1f degrees, more than 34", degrees);
            throw StartupError(attempt, text, "export the original slices again");
        }
    }
}

// Words in the names of cone-beam scanners and their manufacturers.
bool cone_beam(const std::string& maker) {
    for (const char* word :
         {"cbct",     "cone",    "newtom",          "i-cat",    "icat",   "imaging sciences",
          "planmeca", "promax",  "accuitomo",       "veraview", "morita", "carestream",
          "cs 9",     "sirona",  "galileos",        "vatech",   "kavo",   "orthophos",
          "scanora",  "soredex", "instrumentarium", "gendex",   "xcat",   "minicat"})
        if (maker.find(word) != std::string::npos) return true;
    return false;
}

}  // namespace

std::vector<DicomSeries> dicom_series(std::vector<DicomSlice> slices) {
    std::vector<DicomSeries> out;
    for (const DicomGroup& g : grouped_slices(std::move(slices)))
        out.push_back({told(g), g.size(), is_volume(g)});
    return out;
}

Scan dicom_stack(std::vector<DicomSlice> slices, unsigned series, const std::string& attempt) {
    if (slices.empty())
        throw StartupError(attempt, "the folder contains no DICOM image",
                           "give the folder of a series, or another format");
    std::vector<DicomGroup> groups = grouped_slices(std::move(slices));
    Scan scan;
    const std::vector<DicomGroup> all = groups;
    DicomGroup g = choose(std::move(groups), series, attempt, scan);
    std::vector<DicomSlice> left_out;
    for (const DicomGroup& other : all)
        if (!same_picture(other[0], g[0])) left_out.insert(left_out.end(), other.begin(), other.end());
    check_pictures(g, attempt);
    const Vec3 u = g[0].along_row, v = g[0].down_rows, n = u.cross(v).normalized();
    std::sort(g.begin(), g.end(), [&](const DicomSlice& a, const DicomSlice& b) {
        return a.position_mm.dot(n) < b.position_mm.dot(n);
    });
    // scan_of() checks the geometry, using the first two slices; the slices then get their own positions.
    const double rise = std::max(1e-3, (g[1].position_mm - g[0].position_mm).dot(n));
    std::vector<std::uint32_t> order;
    Scan shape = scan_of({{g[0].columns, g[0].rows, g.size()},
                          {g[0].column_mm * u, g[0].row_mm * v, std::min(rise, 100.0) * n},
                          g[0].position_mm,
                          true},
                         attempt, order);
    shape.note = std::move(scan.note);
    for (std::size_t i = 0; i < g.size(); ++i) {
        const Vec3 at = shape.axes.transpose() * (g[i].position_mm - g[0].position_mm);
        shape.slice[i] = {at.x(), at.y(), at.z()};
    }
    check_gaps(g, left_out, shape.axes, attempt, shape);
    shape.format = "DICOM";
    const bool hounsfield = g[0].modality == "CT" && (g[0].rescale_type.empty() || g[0].rescale_type == "HU");
    shape.values = hounsfield ? ScanValues::hounsfield : ScanValues::number;
    if (cone_beam(g[0].maker))
        shape.warning.emplace_back(
            "the scan is from a cone-beam scanner, whose values are not true Hounsfield units; inspect the "
            "bone and set --threshold-hu and --solid-hu by eye");
    auto kept = std::make_shared<const DicomGroup>(std::move(g));
    shape.read = [kept](std::uint32_t slice, std::span<float> pixels) {
        read_dicom_pixels(kept->at(slice), pixels);
    };
    return shape;
}

}  // namespace tact
