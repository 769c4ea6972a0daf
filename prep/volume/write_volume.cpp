#include "prep/volume/write_volume.hpp"

#include <zlib.h>

#include <algorithm>
#include <cstring>
#include <memory>

#include "ipc/base/error.hpp"
#include "ipc/base/part_file.hpp"
#include "ipc/base/printed.hpp"

namespace tact {
namespace {

bool ends_with(const std::filesystem::path& path, std::string_view ending) {
    const std::string name = path.string();
    return name.size() > ending.size() &&
           name.compare(name.size() - ending.size(), ending.size(), ending) == 0;
}

std::string vector_text(const Vec3& v) { return printed("(%.9g,%.9g,%.9g)", v.x(), v.y(), v.z()); }

std::string nrrd_header(const VolumeFile& v) {
    std::string h = "NRRD0004\n# " + v.content + "\ntype: int16\ndimension: 3\n";
    h += v.oriented ? "space: left-posterior-superior\n" : "space dimension: 3\n";
    h += printed("sizes: %u %u %u\n", v.size[0], v.size[1], v.size[2]);
    h += "space directions: " + vector_text(v.step_mm[0]) + " " + vector_text(v.step_mm[1]) + " " +
         vector_text(v.step_mm[2]) + "\n";
    h += "space units: \"mm\" \"mm\" \"mm\"\nkinds: domain domain domain\nendian: little\nencoding: gzip\n";
    return h + "space origin: " + vector_text(v.origin_mm) + "\n\n";
}

std::string packed(std::string_view bytes) {
    z_stream z{};
    constexpr int kGzip = 16 + MAX_WBITS;
    if (deflateInit2(&z, Z_DEFAULT_COMPRESSION, Z_DEFLATED, kGzip, 8, Z_DEFAULT_STRATEGY) != Z_OK)
        throw StartupError("packing a volume", "no memory", "free some memory");
    std::string out;
    std::vector<char> part(std::size_t{1} << 20U);
    std::size_t at = 0;
    int state = Z_OK;
    while (state != Z_STREAM_END) {
        if (z.avail_in == 0 && at < bytes.size()) {
            const std::size_t size = std::min(bytes.size() - at, std::size_t{1} << 28U);
            z.next_in = reinterpret_cast<Bytef*>(const_cast<char*>(bytes.data() + at));
            z.avail_in = static_cast<uInt>(size);
            at += size;
        }
        z.next_out = reinterpret_cast<Bytef*>(part.data());
        z.avail_out = static_cast<uInt>(part.size());
        state = deflate(&z, at < bytes.size() ? Z_NO_FLUSH : Z_FINISH);
        out.append(part.data(), part.size() - z.avail_out);
    }
    deflateEnd(&z);
    return out;
}

void write_parts(const std::filesystem::path& path, std::initializer_list<std::string_view> parts) {
    PartFile file(path, "volume");
    for (const std::string_view part : parts) file.write(part);
    file.finish();
}

}  // namespace

void check_volume_name(const std::filesystem::path& path) {
    if (ends_with(path, ".nrrd") || ends_with(path, ".nii") || ends_with(path, ".nii.gz")) return;
    throw StartupError("write volume " + path.string(), "the ending names no format of volumes",
                       "end the name with .nrrd, .nii or .nii.gz");
}

void write_volume(const std::filesystem::path& path, const VolumeFile& v) {
    check_volume_name(path);
    const std::string_view values(reinterpret_cast<const char*>(v.value.data()),
                                  v.value.size() * sizeof v.value[0]);
    if (ends_with(path, ".nrrd")) return write_parts(path, {nrrd_header(v), packed(values)});
    const std::string header = nifti_file_header(v);
    if (ends_with(path, ".nii")) return write_parts(path, {header, values});
    write_parts(path, {packed(header), packed(values)});  // members of a gzip file follow each other
}

}  // namespace tact
