// Our own parsers for scans. The first byte selects: headers of NRRD, MetaImage and NIfTI with their voxels, names of an
// image stack, a list of label names. Accepted scans are read and resampled.
#include <cmath>

#include "prep/drilling/import_bone.hpp"
#include "prep/volume/png_stack.hpp"
#include "prep/volume/raw_scan.hpp"
#include "tests/fuzz/format_fuzz.hpp"
#include "tests/unit/prep_scan_samples.hpp"

namespace tact::fuzz {
namespace {

constexpr RawHeaderReader kReaders[] = {nrrd_header, meta_image_header, nifti_header};

void use_header(RawHeaderReader reader, std::string_view text) {
    RawHeader header = reader(text, "read a scan", 1.0);
    if (!header.data_file.empty()) return;
    const Scan scan = raw_scan(std::move(header), text, nullptr, "read a scan");
    require(scan.slice.size() > 0 && scan.axes.allFinite());
    for (std::size_t i = 0; i + 1 < scan.slice.size(); ++i)
        require(scan.slice[i].s_mm <= scan.slice[i + 1].s_mm);
    if (scan.pixels() * scan.slice.size() > 100'000) return;
    std::vector<float> pixels(scan.pixels());
    scan.read(static_cast<std::uint32_t>(scan.slice.size() - 1), pixels);
    for (const float p : pixels) require(std::isfinite(p));
    const SamplePlan plan = plan_samples(scan, 0.0, BoneFace::left);
    if (plan.bricks.bytes() > 1'000'000) return;
    require(sample_density(scan, plan, 300.0, 1800.0, {}).size() == plan.bricks.bytes());
}

void use_names(std::string_view text) {
    std::vector<std::string> names;
    for (std::size_t at = 0; at <= text.size() && names.size() < 1000;) {
        const std::size_t end = std::min(text.find('\n', at), text.size());
        names.emplace_back(text.substr(at, end - at));
        at = end + 1;
    }
    const std::size_t all = names.size(), kept = stack_order(std::move(names), "read a stack").size();
    require(kept > 0 && kept <= all);
}

}  // namespace

bool run(std::span<const std::byte> input) {
    return run_formats(input, 5, [](unsigned format, std::string_view text) {
        if (format < 3)
            use_header(kReaders[format], text);
        else if (format == 3)
            use_names(text);
        else
            (void)parse_label_names(text, "read names of labels");
    });
}

std::vector<Input> seeds() {
    const std::string voxels = sample::bone_numbers({0, 1, 2});
    std::string nrrd =
        "NRRD0004\n# made by hand\ntype: short\ndimension: 3\nendian: little\nsizes: 6 5 4\nspace: RAS\n"
        "space directions: (1,0,0) (0,1,0) (0,0,-1)\nspace origin: (1,2,3)\nencoding: raw\n"
        "Segment0_Name:=nerve\nSegment0_LabelValue:=3\nSegment0_Color:=1 0.5 0\n\n";
    nrrd += voxels;
    std::string meta =
        "ObjectType = Image\nNDims = 3\nBinaryData = True\nDimSize = 6 5 4\nElementSpacing = 1 1 1\n"
        "TransformMatrix = -1 0 0 0 1 0 0 0 -1\nOffset = 5 0 3\nElementType = MET_SHORT\nElementDataFile = "
        "LOCAL\n";
    meta += voxels;
    std::string nifti(352, '\0');
    const auto at = [&](std::size_t offset, auto value) {
        std::memcpy(nifti.data() + offset, &value, sizeof value);
    };
    at(0, std::int32_t{348});
    const std::int16_t dim[] = {3, 6, 5, 4};
    for (std::size_t i = 0; i < 4; ++i) at(40 + 2 * i, dim[i]);
    at(70, std::int16_t{4});
    for (std::size_t i = 0; i < 4; ++i) at(76 + 4 * i, 1.0F);
    at(108, 352.0F);
    at(252, std::int16_t{1});
    std::memcpy(nifti.data() + 344, "n+1", 4);
    nifti += voxels;
    return {seed(0, nrrd),
            seed(1, meta),
            seed(2, nifti),
            seed(3, "plane000.png\nplane001.png\nplane0002.png"),
            seed(3, "plane0.png\nplane01.png\nplane002.png"),
            seed(4, "# remark\n0 0 0 0 0 0 0 \"Clear Label\"\n3 255 0 9 1 1 1 \"nerve\"\n")};
}

}  // namespace tact::fuzz
