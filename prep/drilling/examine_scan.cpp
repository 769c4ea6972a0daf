#include "prep/drilling/examine_scan.hpp"

#include <algorithm>
#include <array>

#include "ipc/base/printable.hpp"
#include "ipc/base/printed.hpp"
#include "ipc/scene/bone/structure_table.hpp"
#include "prep/drilling/bone_threshold.hpp"
#include "prep/drilling/import_bone.hpp"
#include "prep/drilling/resample.hpp"
#include "prep/drilling/structure_names.hpp"
#include "prep/volume/dicom.hpp"

namespace tact {
namespace {

namespace fs = std::filesystem;

constexpr const char* kSpacingHelp = "Images state no size. One number for pixels and slices alike.";
constexpr const char* kThresholdHelp =
    "What is at or below holds no bone: the coloured part of the histogram is bone.";
constexpr const char* kSolidHelp = "From here on bone is as hard as it gets.";

std::string scan_size(const Scan& scan) {
    return printed("%u x %u x %zu", scan.columns, scan.rows, scan.slice.size());
}

// A line's text is for people: nothing that a file says can break it.
void add_line(ImportReport& out, const char* label, const std::string& value) {
    out.lines.push_back({label, printable(value)});
}

// The series of a folder of DICOM files; chooses the largest volume if none is asked for.
void add_series(ImportReport& out, const fs::path& path, ScanRequest& request, const Progress& progress) {
    std::error_code error;
    if (!fs::is_directory(path, error)) return;
    const std::vector<DicomSeries> all = dicom_series(list_dicom(path, progress));
    if (all.size() < 2) return;
    ImportReport::Choice choice{"--series", "Series", {}, 0};
    for (const DicomSeries& s : all)
        choice.rows.push_back({std::to_string(choice.rows.size() + 1), printable(s.text)});
    if (request.series == 0) {
        const auto largest =
            std::max_element(all.begin(), all.end(), [](const DicomSeries& a, const DicomSeries& b) {
                return (a.is_volume ? a.slices : 0) < (b.is_volume ? b.slices : 0);
            });
        request.series = static_cast<unsigned>(largest - all.begin()) + 1;
    }
    choice.chosen = std::min<std::size_t>(request.series, all.size()) - 1;
    out.choices.push_back(std::move(choice));
}

void add_bone_values(ImportReport& out, const Scan& scan, const Progress& progress) {
    const std::optional<ScanHistogram> histogram = scan_histogram(scan, progress);
    if (!histogram) {
        out.warnings.emplace_back("all voxels have the same value: there is nothing to separate");
        return;
    }
    const ProposedBone proposed = propose_bone(*histogram);
    const bool hounsfield = in_hounsfield(scan, histogram->low);
    const double threshold = hounsfield ? kBoneFromHu : proposed.threshold,
                 solid = hounsfield ? kBoneSolidHu : proposed.solid;
    const std::string unit = hounsfield ? "HU" : "";
    add_line(out, "Values",
             hounsfield ? printed("%.4g to %.4g HU", histogram->low, histogram->most)
                        : printed("%.4g to %.4g, of no known unit", histogram->low, histogram->most));
    out.histogram = {histogram->low, histogram->high, histogram->count};
    out.numbers.push_back(
        {"--threshold-hu", "Bone above", unit, kThresholdHelp, -1e6, 1e6, threshold, true, !hounsfield});
    out.numbers.push_back(
        {"--solid-hu", "Solid bone from", unit, kSolidHelp, -1e6, 1e6, solid, true, !hounsfield});
    if (!hounsfield)
        out.warnings.emplace_back(
            "the values have no known unit: where bone begins is proposed from the histogram; look at the "
            "result");
}

// The structures of a stack of coloured images, by the table beside it or by a known palette.
void add_structures(ImportReport& out, const fs::path& path, const OpenedScan& opened,
                    const Progress& progress) {
    const Scan& scan = opened.scan;
    std::array<std::uint64_t, 256> voxels{};
    std::vector<float> pixels(scan.pixels());
    for (std::uint32_t k = 0; k < scan.slice.size(); ++k) {
        report(progress, k / static_cast<double>(scan.slice.size()), "finding the structures");
        scan.read(k, pixels);
        for (const float v : pixels) ++voxels[static_cast<std::size_t>(std::clamp(v, 0.0F, 255.0F))];
    }
    const std::vector<ScanLabel> known = known_names(path, *opened.palette);
    bool bone = false;
    for (std::size_t i = 0; i < opened.palette->rgba.size() && i < voxels.size(); ++i) {
        const auto& c = opened.palette->rgba[i];
        if (c[3] == 0 || voxels[i] == 0) continue;
        if (std::equal(c.begin(), c.begin() + 3, kBoneColour.begin())) {
            bone = true;
            continue;
        }
        ImportReport::Structure s;
        s.colour = printed("#%02X%02X%02X", c[0], c[1], c[2]);
        s.name = s.colour;
        s.voxels = voxels[i];
        std::optional<bool> critical;
        for (const ScanLabel& k : known)
            if (k.rgba[3] != 0 && std::equal(c.begin(), c.begin() + 3, k.rgba.begin())) {
                s.name = printable(k.name);
                critical = k.critical;
            }
        s.critical = critical.value_or(critical_name(s.name, {}));
        out.structures.push_back(std::move(s));
    }
    std::stable_sort(out.structures.begin(), out.structures.end(),
                     [](const auto& a, const auto& b) { return a.voxels > b.voxels; });
    out.structure_table = structure_table_path(fs::absolute(path)).string();
    if (!bone)
        out.warnings.push_back(
            printed("no pixel has the colour of bone, %u,%u,%u: import it with tact drill and "
                    "--bone-colour",
                    kBoneColour[0], kBoneColour[1], kBoneColour[2]));
}

}  // namespace

ImportReport examine_scan(const fs::path& path, ScanRequest request, const Progress& progress) {
    ImportReport out;
    const bool images = is_image_stack(path);
    if (images && !(request.spacing_mm.minCoeff() > 0.0)) {
        out.numbers.push_back(
            {"--spacing-mm", "Spacing", "mm", kSpacingHelp, 0.001, 100.0, std::nullopt, false});
        request.spacing_mm = Vec3::Ones();
    }
    if (!images) add_series(out, path, request, progress);
    const OpenedScan opened = open_scan(path, request, progress);
    const Scan& scan = opened.scan;
    add_line(out, "Format", scan.format);
    if (out.numbers.empty())
        add_line(out, "Voxels",
                 scan_size(scan) +
                     printed(" of %.4g x %.4g mm, slices %.4g mm apart", scan.column_mm, scan.row_mm,
                             scan.slice.size() < 2 ? 0.0
                                                   : (scan.slice.back().s_mm - scan.slice.front().s_mm) /
                                                         static_cast<double>(scan.slice.size() - 1)));
    else
        add_line(out, "Images", scan_size(scan));
    add_line(
        out, "Patient",
        scan.oriented
            ? printed("columns to %s, rows to %s, slices to %s", patient_letters(scan.axes.col(0)).c_str(),
                      patient_letters(scan.axes.col(1)).c_str(), patient_letters(scan.axes.col(2)).c_str())
            : std::string("left and right are not stated: the bone may be mirrored"));
    if (opened.palette)
        add_structures(out, path, opened, progress);
    else if (scan.values == ScanValues::label)
        out.warnings.emplace_back("the file holds labels: give the scan itself, and these with --labels");
    else
        add_bone_values(out, scan, progress);
    for (const std::string& note : scan.note) add_line(out, "Note", note);
    for (const std::string& warning : scan.warning) out.warnings.push_back(printable(warning));
    return out;
}

}  // namespace tact
