#include "prep/mesh_file/import_mesh.hpp"

#include "prep/input/read_file.hpp"
#include "prep/mesh_file/formats.hpp"

namespace tact {
namespace {

struct Format {
    const char* ending;
    ImportedMesh (*read)(const MeshSource&);
};
constexpr Format kFormats[] = {{".ply", &read_ply}, {".obj", &read_obj}, {".stl", &read_stl}};

const Format& format_of(const std::string& ending, const std::string& name) {
    for (const Format& format : kFormats) {
        if (ending == format.ending) return format;
    }
    throw StartupError("read mesh " + name, "its ending \"" + ending + "\" is none of .ply .obj .stl",
                       "convert it, or give the file its right ending");
}

}  // namespace

ImportedMesh import_mesh_bytes(std::vector<char> bytes, const std::string& name, const std::string& ending,
                               const Progress& progress) {
    const Format& format = format_of(ending, name);
    return format.read({{bytes.data(), bytes.size()}, name, progress});
}

ImportedMesh import_mesh(const std::filesystem::path& path, const Progress& progress) {
    const std::string ending = format_ending(path);
    format_of(ending, path.string());  // before gigabytes are read
    report(progress, 0.0, "reading the mesh");
    return import_mesh_bytes(read_whole_file(path, kMeshFileBytesMax), path.string(), ending, progress);
}

}  // namespace tact
