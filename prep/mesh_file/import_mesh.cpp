#include "prep/mesh_file/import_mesh.hpp"

#include "prep/input/input_bytes.hpp"
#include "prep/input/read_file.hpp"
#include "prep/mesh_file/formats.hpp"

namespace tact {
namespace {

struct Format {
    const char* ending;
    ImportedMesh (*read)(const MeshSource&);
};
constexpr Format kFormats[] = {
    {".ply", &read_ply}, {".obj", &read_obj}, {".stl", &read_stl}, {".off", &read_off}};

const Format& format_of(const std::string& ending, const std::string& name) {
    for (const Format& format : kFormats) {
        if (ending == format.ending) return format;
    }
    throw StartupError("read mesh " + name,
                       "the file name ending '" + ending + "' is none of .ply .obj .stl .off",
                       "convert the file, or correct the ending of its name");
}

}  // namespace

ImportedMesh import_mesh_bytes(std::string_view bytes, const std::string& name, const std::string& ending,
                               const Progress& progress, const AnnounceMesh& announce) {
    return format_of(ending, name).read({bytes, name, progress, announce});
}

ImportedMesh import_mesh(const std::filesystem::path& path, const Progress& progress,
                         const AnnounceMesh& announce) {
    const std::string ending = format_ending(path);
    format_of(ending, path.string());  // checks the ending before reading gigabytes
    report(progress, 0.0, "reading the mesh");
    const InputBytes bytes(path, kMeshFileBytesMax, kMeshUnpackedBytesMax);
    return import_mesh_bytes(bytes.view(), path.string(), ending, progress, announce);
}

}  // namespace tact
