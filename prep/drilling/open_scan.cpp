#include "prep/drilling/open_scan.hpp"

#include "ipc/base/error.hpp"
#include "prep/input/read_file.hpp"
#include "prep/volume/dicom.hpp"
#include "prep/volume/raw_scan.hpp"

namespace tact {
namespace {

namespace fs = std::filesystem;

OpenedScan open_stack(const fs::path& folder, const Vec3& spacing_mm) {
    if (!(spacing_mm.minCoeff() > 0.0))
        throw StartupError("read the images in " + folder.string(), "PNG images have no pixel spacing",
                           "give the spacing of columns, rows and slices, as in --spacing-mm 0.2,0.2,0.2");
    PngStack stack = read_png_stack(folder, spacing_mm);
    return {std::move(stack.scan), std::move(stack.palette)};
}

}  // namespace

bool is_image_stack(const fs::path& path) {
    std::error_code error;
    if (!fs::is_directory(path, error)) return false;
    for (const fs::directory_entry& entry : fs::directory_iterator(path))
        if (format_ending(entry.path()) == ".png") return true;
    return false;
}

OpenedScan open_scan(const fs::path& path, const ScanRequest& o, const Progress& progress) {
    const std::string attempt = "read scan " + path.string();
    std::error_code error;
    if (!fs::exists(path, error)) throw StartupError(attempt, "the file does not exist", "check the path");
    if (fs::is_directory(path, error)) {
        if (is_image_stack(path)) return open_stack(path, o.spacing_mm);
        return {dicom_stack(list_dicom(path, progress), o.series, attempt), nullptr};
    }
    const std::string ending = format_ending(path);
    if (ending == ".nrrd" || ending == ".nhdr")
        return {read_raw_scan(path, "NRRD", nrrd_header, o.unit_mm), nullptr};
    if (ending == ".nii") return {read_raw_scan(path, "NIfTI", nifti_header, o.unit_mm), nullptr};
    if (ending == ".mha" || ending == ".mhd")
        return {read_raw_scan(path, "MetaImage", meta_image_header, o.unit_mm), nullptr};
    if (is_dicom(path)) {  // the series that contains this file
        const fs::path folder = path.has_parent_path() ? path.parent_path() : fs::path(".");
        std::vector<DicomSlice> all = list_dicom(folder, progress);
        std::string uid;
        for (const DicomSlice& s : all)
            if (fs::equivalent(s.path, path, error)) uid = s.series_uid;
        std::erase_if(all, [&](const DicomSlice& s) { return s.series_uid != uid; });
        return {dicom_stack(std::move(all), o.series, attempt), nullptr};
    }
    throw StartupError(
        attempt, "the format is unknown",
        "give a folder of DICOM files or of PNG images, or a .nrrd, .nhdr, .nii, .mha or .mhd file");
}

}  // namespace tact
