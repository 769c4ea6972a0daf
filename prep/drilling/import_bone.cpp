#include "prep/drilling/import_bone.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "ipc/base/error.hpp"
#include "ipc/base/printable.hpp"
#include "ipc/base/printed.hpp"
#include "ipc/scene/bone/structure_table.hpp"
#include "prep/drilling/bone_threshold.hpp"
#include "prep/drilling/open_scan.hpp"
#include "prep/drilling/structure_names.hpp"
#include "prep/input/read_file.hpp"

namespace tact {
namespace {

namespace fs = std::filesystem;

constexpr const char* kFaceNames[] = {"front", "back", "left side", "right side", "top", "bottom"};

struct DensityRange {
    double low, high;
    bool hounsfield;
    std::string warning{};  // that it is a proposal; empty: it is known
};

// 8-bit values have lost their unit, and the values of other scans may have any: above 0 would be skin and all within.
DensityRange proposed_range(const Scan& scan, const std::optional<ScanHistogram>& histogram) {
    const std::optional<ProposedBone> bone =
        histogram ? std::optional(propose_bone(*histogram)) : std::nullopt;
    const std::string options =
        bone ? printed("--threshold-hu %.4g --solid-hu %.4g", bone->threshold, bone->solid) : "";
    if (scan.values != ScanValues::grey)
        throw StartupError(
            "separate bone from other tissue",
            "no voxel is as low as air in Hounsfield units, so the unit of the values is unknown",
            bone ? "give the file's values for no bone and for solid bone; its histogram suggests " + options
                 : "give the file's values for no bone and for solid bone: --threshold-hu and --solid-hu");
    if (!bone) return {0.0, 255.0, false};  // one value: nothing to separate
    return {bone->threshold, bone->solid, false,
            printed("8-bit values have no unit: the histogram suggests that bone begins at %.4g (%.1f %% of "
                    "the voxels are above) "
                    "and is solid at %.4g; inspect it, and set others with ",
                    bone->threshold, 100.0 * bone->share_above, bone->solid) +
                options};
}

DensityRange choose_range(const Scan& scan, const BoneImport& o, const Progress& progress) {
    DensityRange range{0.0, 255.0, false};
    const bool both = o.threshold && o.solid, stated = scan.values == ScanValues::hounsfield;
    // An 8-bit scan with both values given needs no look at its own.
    const std::optional<ScanHistogram> histogram =
        stated || (both && scan.values == ScanValues::grey) ? std::nullopt : scan_histogram(scan, progress);
    if (stated || (histogram && in_hounsfield(scan, histogram->low)))
        range = {kBoneFromHu, kBoneSolidHu, true};
    else if (!both)
        range = proposed_range(scan, histogram);
    if (o.threshold) range.low = *o.threshold;
    if (o.solid) range.high = *o.solid;
    if (!(range.low < range.high) || std::abs(range.low) > 1e6 || std::abs(range.high) > 1e6)
        throw StartupError(
            "separate bone from other tissue",
            printed("the threshold %g is not below the value of solid bone, %g", range.low, range.high),
            "give a --solid-hu that is greater than --threshold-hu");
    return range;
}

// Converts the label values of the file to rows of a table, 1 and up, in the order of their values.
void put_structures(BoneInput& input, std::vector<ScanLabel> known, const BoneImport& o) {
    BoneData& bone = input.bone;
    std::array<std::uint64_t, 256> count{};
    for (const std::uint8_t l : bone.label) ++count[l];
    std::array<std::uint8_t, 256> row_of{};
    for (std::size_t value = 1; value < 256; ++value) {
        if (count[value] == 0) continue;
        BoneStructure s;
        const double hue = 2.399963 * static_cast<double>(value);
        for (std::size_t c = 0; c < 3; ++c)
            s.rgba[c] =
                static_cast<std::uint8_t>(150.0 + 100.0 * std::cos(hue - 2.094395 * static_cast<double>(c)));
        s.rgba[3] = 255;
        s.name = "label " + std::to_string(value);
        const auto named =
            std::find_if(known.begin(), known.end(), [&](const ScanLabel& l) { return l.value == value; });
        if (named != known.end()) {
            if (!named->name.empty()) s.name = named->name;
            if (named->rgba[3] != 0) s.rgba = named->rgba;
        }
        s.name = printable(s.name);
        std::size_t size = std::min(s.name.size(), BoneStructure::kNameBytesMax);
        while (size < s.name.size() && size > 0 &&
               (static_cast<unsigned char>(s.name[size]) & 0xC0U) == 0x80U)
            --size;
        s.name.resize(size);  // do not cut inside a UTF-8 character
        s.critical = critical_name(s.name, o.critical);
        if (named != known.end() && named->critical) s.critical = *named->critical;
        input.table.push_back({static_cast<std::uint8_t>(value), s.name, s.rgba, s.critical});
        input.table_voxels.push_back(count[value]);
        bone.structure.push_back(std::move(s));
        row_of[value] = static_cast<std::uint8_t>(bone.structure.size());
    }
    for (std::size_t i = 0; i < bone.label.size(); ++i) {
        std::uint8_t& l = bone.label[i];
        if (l == 0) continue;
        l = row_of[l];
        if (bone.structure[l - 1U].critical) bone.density[i] = std::max(bone.density[i], kLabelDensity);
    }
}

// A stack of images whose colours mark structures; one of the colours is bone.
void segmented(const Scan& scan, const SamplePlan& plan, const StackPalette& palette, const BoneImport& o,
               std::vector<ScanLabel> known, BoneInput& input, const Progress& progress) {
    BoneData& bone = input.bone;
    bone.label = sample_labels(scan, plan, scan, progress);
    std::string known_palette;  // the colours are known once all images were read
    if (known.empty()) {
        known = names_of_palette(palette, known_palette);
        if (!known.empty())
            input.note.push_back("structures: named by their colours, those of the " + known_palette);
    }
    bone.density.assign(bone.label.size(), 0);
    std::vector<ScanLabel> colours;
    std::size_t bone_colour = 256;
    std::array<bool, 256> empty{};
    for (std::size_t i = 0; i < palette.rgba.size(); ++i) {
        const auto& c = palette.rgba[i];
        empty[i] = c[3] == 0;
        if (std::equal(o.bone_colour.begin(), o.bone_colour.end(), c.begin()) && c[3] != 0) bone_colour = i;
        char name[16];
        std::snprintf(name, sizeof name, "#%02X%02X%02X", c[0], c[1], c[2]);
        ScanLabel label{static_cast<std::uint8_t>(i), name, c, {}};
        for (const ScanLabel& k : known)
            if (k.rgba[3] != 0 && std::equal(c.begin(), c.begin() + 3, k.rgba.begin())) {
                label.name = k.name;
                label.critical = k.critical;
            }
        colours.push_back(std::move(label));
    }
    if (bone_colour == 256)
        throw StartupError("separate bone from other tissue",
                           printed("no pixel has the colour of bone, %u,%u,%u", o.bone_colour[0],
                                   o.bone_colour[1], o.bone_colour[2]),
                           "give the colour of bone with --bone-colour RED,GREEN,BLUE");
    // Label 0 means none: if the first palette colour is a structure, it gets an unused number.
    std::uint8_t first = 0;
    if (!empty[0] && bone_colour != 0) {
        if (palette.rgba.size() == 256)
            throw StartupError("read the labels", "the images have 256 structure colours",
                               "use at most 255 colours and an empty one");
        first = static_cast<std::uint8_t>(palette.rgba.size());
        colours[0].value = first;
    }
    const bool outside_is_first = first != 0;
    for (std::size_t i = 0; i < bone.label.size(); ++i) {
        std::uint8_t& l = bone.label[i];
        if (l == bone_colour) {
            bone.density[i] = 255;
            l = 0;
        } else if (empty[l] && !(outside_is_first && l == 0)) {
            l = 0;
        } else {
            if (l == 0) l = first;
            bone.density[i] = kLabelDensity;
        }
    }
    // Clear the padding of the bricks beyond the size of the volume.
    const auto& n = plan.bricks.size;
    const auto rest = plan.bricks.bricks();
    for (std::uint32_t z = 0; z < 8 * rest[2]; ++z)
        for (std::uint32_t y = 0; y < 8 * rest[1]; ++y)
            for (std::uint32_t x = z < n[2] && y < n[1] ? n[0] : 0; x < 8 * rest[0]; ++x) {
                bone.density[plan.bricks.voxel(x, y, z)] = 0;
                bone.label[plan.bricks.voxel(x, y, z)] = 0;
            }
    put_structures(input, std::move(colours), o);
    for (ScanLabel& row : input.table) row.value = 0;  // colours are what the images have
}

}  // namespace

BoneInput import_bone(const BoneImport& o, const Progress& whole) {
    const Progress progress = [&whole](double fraction, const char* what) {
        return !whole || whole(0.5 * fraction, what);
    };
    OpenedScan opened = open_scan(o.scan, o.request, progress);
    Scan& scan = opened.scan;
    const std::string size = printed("%u x %u x %zu voxels of %.4g x %.4g mm", scan.columns, scan.rows,
                                     scan.slice.size(), scan.column_mm, scan.row_mm);
    if (o.crop) crop_scan(scan, *o.crop);
    const SamplePlan plan = plan_samples(scan, o.voxel_mm, o.face);
    const bool labelled = opened.palette || !o.labels.empty();
    if (o.announce) {
        const auto voxels = static_cast<double>(plan.bricks.bytes());
        constexpr std::size_t kFieldsExpected = 8;
        o.announce(voxels, bake_bytes(plan.bricks, labelled, kFieldsExpected) +
                               8.0 * static_cast<double>(scan.pixels()) +
                               (labelled ? static_cast<double>(scan.pixels() * scan.slice.size()) : 0.0));
    }
    std::vector<ScanLabel> known = scan.label;
    fs::path names = o.label_names;
    if (names.empty() && !o.labels.empty()) names = structure_table_beside(o.labels);
    if (names.empty()) names = structure_table_beside(o.scan);
    if (!names.empty()) known = read_structure_names(names);
    BoneInput input;
    BoneData& bone = input.bone;
    bone.bricks = plan.bricks;
    if (opened.palette) {
        if (!o.labels.empty())
            throw StartupError("read the labels", "the scan itself consists of label images",
                               "omit --labels");
        segmented(scan, plan, *opened.palette, o, std::move(known), input, progress);
    } else {
        const DensityRange range = choose_range(scan, o, progress);
        if (!range.warning.empty()) scan.warning.push_back(range.warning);
        if (range.hounsfield) {
            bone.hu_at_0 = static_cast<float>(range.low);
            bone.hu_at_255 = static_cast<float>(range.high);
        } else {
            input.note.push_back(
                printed("bone: values above %g, solid at %g and above", range.low, range.high));
        }
        const double labels_from = o.labels.empty() ? 1.0 : 0.5;
        bone.density = sample_density(scan, plan, range.low, range.high, part(progress, 0.0, labels_from));
        if (!o.labels.empty()) {
            OpenedScan labels = open_scan(o.labels, o.request, part(progress, labels_from, labels_from));
            if (labels.palette)
                throw StartupError("read the labels", "coloured images cannot be combined with a scan",
                                   "save the labels as NRRD, NIfTI or MetaImage");
            if (names.empty()) known = labels.scan.label;
            if (o.crop && !(scan.oriented && labels.scan.oriented)) crop_scan(labels.scan, *o.crop);
            bone.label = sample_labels(scan, plan, labels.scan, part(progress, labels_from, 1.0));
            if (std::all_of(bone.label.begin(), bone.label.end(), [](std::uint8_t l) { return l == 0; }))
                throw StartupError("put labels on the scan", "no label lies in the volume",
                                   "give labels of this scan, or another --crop");
            put_structures(input, std::move(known), o);
        }
    }
    input.title = "bone from " + scan.format;
    input.note.insert(input.note.begin(),
                      {"scan: " + scan.format + ", " + size,
                       std::string("towards the user: ") +
                           (scan.oriented ? "the patient's " : "presumably the patient's ") +
                           kFaceNames[static_cast<std::size_t>(o.face)]});
    if (scan.oriented) {
        bone.patient = plan.patient(scan);
        const Vec3& middle = bone.patient->origin_mm;
        input.note.push_back(
            printed("model (0, 0, 0): %.2f mm left, %.2f mm back, %.2f mm up from the scan's origin",
                    middle.x(), middle.y(), middle.z()));
        const Eigen::Matrix3d& axes = bone.patient->axes;
        input.note.push_back(printed(
            "model axes in the patient: x to %s, y to %s, z to %s", patient_letters(axes.col(0)).c_str(),
            patient_letters(axes.col(1)).c_str(), patient_letters(axes.col(2)).c_str()));
    } else {
        scan.warning.emplace_back(
            "the file does not state the patient's left side: the bone may be mirrored");
    }
    for (const std::string& line : scan.note) input.note.push_back(line);
    for (const std::string& line : scan.warning) {
        input.note.push_back("warning: " + line);
        if (o.warn) o.warn(line);
    }
    return input;
}

}  // namespace tact
