#include "ipc/scene/file/scene_kinds.hpp"

#include <algorithm>
#include <limits>

namespace tact {
namespace {

constexpr std::uint32_t kAnyNumber = std::numeric_limits<std::uint32_t>::max();
constexpr MetaLimits kNoMap{0.0, 1.0, 0.0, 0.0, 0, kAnyNumber};

constexpr SectionTag kDockingSections[] = {{'G', 'R', 'I', 'D'}, {'B', 'O', 'D', 'Y'}};
constexpr SectionTag kSurfaceSections[] = {{'S', 'U', 'R', 'F'}};
constexpr SectionTag kDrillingSections[] = {{'B', 'O', 'N', 'E'}};

constexpr SectionTag kFieldSections[] = {{'G', 'R', 'I', 'D'}, {'F', 'P', 'O', 'T'}};

constexpr const char* kMapEndings[] = {".mrc", ".map", ".ccp4", ".rec", ".situs", ".sit"};
constexpr const char* kStructureEndings[] = {".pdb", ".ent", ".cif", ".mmcif"};
constexpr const char* kMeshEndings[] = {".ply", ".obj", ".stl", ".off"};
constexpr const char* kScanEndings[] = {".nrrd", ".nhdr", ".nii", ".mhd", ".mha"};

constexpr const char* kFieldEndings[] = {".csv"};

constexpr RawFileType kDockingRaw[] = {
    {"map", "a map", kMapEndings, nullptr, 1,
     "A structure needs the map that it is docked into: give both together."},
    {"structure", "its structures", kStructureEndings, nullptr, kSceneBodiesMax,
     "A map needs a structure to dock into it: give both together.", true},
};
constexpr RawFileType kSurfaceRaw[] = {{"mesh", "a mesh", kMeshEndings, nullptr, 1, nullptr}};
constexpr RawFileType kDrillingRaw[] = {
    {"scan", "a scan", kScanEndings, "DICOM files or images", 1, nullptr}};

constexpr RawFileType kFieldRaw[] = {{"field", "a potential field", kFieldEndings, nullptr, 1, nullptr}};

constexpr SceneKindRow kKinds[] = {
    {SceneKind::docking,
     "docking",
     "dock",
     "Dock",
     kDockingSections,
     {0.5e-10, 1e-7, 1e-12, 1e-30, 1, kSceneBodiesMax},
     kDockingRaw,
     true},
    {SceneKind::surface, "surface", "touch", "Touch", kSurfaceSections, kNoMap, kSurfaceRaw, false},
    {SceneKind::drilling, "drilling", "drill", "Drill", kDrillingSections, kNoMap, kDrillingRaw, true},
    {SceneKind::field, "field", "field", "Feel", kFieldSections, kNoMap, kFieldRaw, false},
};

}  // namespace

std::span<const SceneKindRow> scene_kinds() { return kKinds; }

const SceneKindRow* find_scene_kind(SceneKind kind) {
    const auto* const row = std::find_if(std::begin(kKinds), std::end(kKinds),
                                         [&](const SceneKindRow& r) { return r.kind == kind; });
    return row != std::end(kKinds) ? row : nullptr;
}

const char* scene_kind_text(SceneKind kind) {
    const SceneKindRow* const row = find_scene_kind(kind);
    return row != nullptr ? row->name : "unknown";
}

}  // namespace tact
