#include "prep/drilling/bone_commands.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>

#include "ipc/base/error.hpp"
#include "ipc/base/printed.hpp"
#include "ipc/scene/bone/drilled_bone.hpp"
#include "ipc/scene/bone/patient_frame.hpp"
#include "prep/console/console.hpp"
#include "prep/console/target.hpp"
#include "prep/drilling/cavity.hpp"
#include "prep/mesh_file/write_ply.hpp"
#include "prep/mesh_file/write_stl.hpp"
#include "prep/volume/write_volume.hpp"

namespace tact {
namespace {

using nlohmann::json;

// A scene's bone, as baked and as drilled.
struct Drilled {
    SceneFile scene;
    BoneVolumeView baked;
    std::optional<PatientFrame> patient;

    explicit Drilled(const std::string& path)
        : scene(SceneFile::open(path)), baked(read_bone_volume(scene)), patient(read_patient_frame(scene)) {}
    // As a file of drilled bone says; empty: as baked.
    [[nodiscard]] std::vector<std::uint8_t> density(const std::string& file) const {
        std::vector<std::uint8_t> now(baked.density.begin(), baked.density.end());
        if (file.empty()) return now;
        const DrilledBoneSummary sum =
            read_drilled_bone(file, baked, scene.checksum(), [&](const DrilledBrick& b) {
                std::copy(b.voxels.begin(), b.voxels.end(),
                          now.begin() + static_cast<std::ptrdiff_t>(b.brick * BoneBricks::kVoxels));
            });
        if (sum.bytes_left_out > 0)
            std::fprintf(stderr, "warning: %s: the last %llu bytes were not written whole and are left out\n",
                         file.c_str(), static_cast<unsigned long long>(sum.bytes_left_out));
        return now;
    }
    // From the model (metres) to the patient or, if the scan states no orientation, to the model in mm.
    [[nodiscard]] Vec3 to_mm(const Vec3& model_m) const {
        return patient ? Vec3(patient->origin_mm + patient->axes * (1e3 * model_m)) : Vec3(1e3 * model_m);
    }
    void to_mm(TriangleMesh& mesh) const {
        for (std::size_t v = 0; v < mesh.vertices(); ++v) {
            const Eigen::Map<Eigen::Vector3f> at(&mesh.position_m[3 * v]);
            Eigen::Map<Eigen::Vector3f>(&mesh.position_m[3 * v]) =
                to_mm(Vec3(at.cast<double>())).cast<float>();
        }
    }
    [[nodiscard]] const char* space() const { return patient ? "SPACE=LPS" : "no orientation is known"; }
};

// 3D Slicer looks for the space in the first bytes of an STL file.
std::string stl_header(const Drilled& bone, const char* what) {
    return std::string(what) + " by tact-prep, mm. " + bone.space();
}

VolumeFile volume_of(const Drilled& bone, std::span<const std::uint8_t> now) {
    const BoneBricks& b = bone.baked.bricks;
    VolumeFile v;
    v.size = b.size;
    v.oriented = bone.patient.has_value();
    v.origin_mm = bone.to_mm(b.origin_m);
    for (int a = 0; a < 3; ++a)
        v.step_mm[static_cast<std::size_t>(a)] =
            bone.to_mm(b.origin_m + b.voxel_m * Vec3::Unit(a)) - v.origin_mm;
    const bool hu = bone.baked.has_hu();
    v.content =
        hu ? printed("bone in HU: %g and below is none, %g and above is solid",
                     static_cast<double>(bone.baked.hu_at_0), static_cast<double>(bone.baked.hu_at_255))
           : "bone: 0 none, 255 solid";
    std::array<std::int16_t, 256> value{};
    for (std::size_t d = 0; d < value.size(); ++d) {
        const double of_hu =
            std::lerp(static_cast<double>(bone.baked.hu_at_0), static_cast<double>(bone.baked.hu_at_255),
                      static_cast<double>(d) / 255.0);
        value[d] = static_cast<std::int16_t>(hu ? std::clamp(std::lround(of_hu), -32768L, 32767L)
                                                : static_cast<long>(d));
    }
    v.value.reserve(std::size_t{b.size[0]} * b.size[1] * b.size[2]);
    for (std::uint32_t z = 0; z < b.size[2]; ++z)
        for (std::uint32_t y = 0; y < b.size[1]; ++y)
            for (std::uint32_t x = 0; x < b.size[0]; ++x) v.value.push_back(value[now[b.voxel(x, y, z)]]);
    return v;
}

struct ExportBone {
    std::string scene, bone, volume, stl, cavity;
    bool json = false;
};

void export_bone(const ExportBone& o) {
    if (o.volume.empty() && o.stl.empty() && o.cavity.empty())
        throw StartupError("tact-prep export-bone", "no file to write is given",
                           "give --volume, --stl or --cavity");
    if (!o.cavity.empty() && o.bone.empty())
        throw StartupError("write the cavity", "no drilled bone is given", "give --bone FILE.bone");
    if (!o.volume.empty()) check_volume_name(o.volume);
    for (const std::string& target : {o.volume, o.stl, o.cavity})
        if (!target.empty()) check_target("write " + target, target, {o.scene, o.bone});
    Console console;
    const Drilled bone(o.scene);
    const std::vector<std::uint8_t> now = bone.density(o.bone);
    const CavityVolumes volumes = cavity_volumes(bone.baked, now);
    json report{{"removed_mm3", volumes.removed_mm3},
                {"cavity_mm3", volumes.cavity_mm3},
                {"oriented", bone.patient.has_value()},
                {"written", json::array()}};
    const auto wrote = [&](const std::string& path) { report["written"].push_back(path); };
    if (!o.volume.empty()) {
        write_volume(o.volume, volume_of(bone, now));
        wrote(o.volume);
    }
    if (!o.stl.empty()) {
        BoneVolumeView view = bone.baked;
        view.density = now;
        TriangleMesh mesh = bone_surface(view, console.progress());
        bone.to_mm(mesh);
        write_stl(o.stl, mesh, stl_header(bone, "bone"));
        wrote(o.stl);
    }
    if (!o.cavity.empty()) {
        TriangleMesh mesh = cavity_surface(bone.baked, now, console.progress());
        if (mesh.triangle.empty())
            throw StartupError("write the cavity " + o.cavity, "nothing was drilled out of the bone",
                               "give the file of another run");
        bone.to_mm(mesh);
        write_stl(o.cavity, mesh, stl_header(bone, "cavity"));
        wrote(o.cavity);
    }
    console.clear();
    if (o.json) {
        std::printf("%s\n", report.dump(2).c_str());
        return;
    }
    for (const auto& path : report["written"]) std::printf("wrote %s\n", path.get<std::string>().c_str());
    std::printf("bone removed: %.1f mm3; cavity: %.1f mm3; %s\n", volumes.removed_mm3, volumes.cavity_mm3,
                bone.patient ? "in the patient's axes (LPS, mm)"
                             : "in the axes of the model (mm), since the scan states no orientation");
}

struct CompareBone {
    std::string scene, bone, expert, ply;
    bool json = false;
};

// From blue (bone left that the expert took) over white to red (bone taken that the expert left).
std::array<std::uint8_t, 3> colour_of(float mm) {
    constexpr float kFullMm = 2.0F;
    const float t = std::clamp(mm / kFullMm, -1.0F, 1.0F), pale = 255.0F * (1.0F - std::abs(t));
    const auto part = [](float x) { return static_cast<std::uint8_t>(std::lround(x)); };
    return t < 0.0F ? std::array{part(pale), part(pale), std::uint8_t{255}}
                    : std::array{std::uint8_t{255}, part(pale), part(pale)};
}

void compare_bone(const CompareBone& o) {
    if (!o.ply.empty()) check_target("write " + o.ply, o.ply, {o.scene, o.bone, o.expert});
    Console console;
    const Drilled bone(o.scene);
    const std::vector<std::uint8_t> now = bone.density(o.bone), other = bone.density(o.expert);
    const auto mine = taken_voxels(bone.baked.density, now), theirs = taken_voxels(bone.baked.density, other);
    const CavityDifference d = compare_cavities(bone.baked.bricks, mine, theirs);
    if (!o.ply.empty()) {
        TriangleMesh mesh = cavity_surface(bone.baked, now, console.progress());
        PlyColours colours;
        colours.quality = distances_from(bone.baked.bricks, theirs, mesh.position_m);
        for (const float mm : colours.quality) colours.rgb.push_back(colour_of(mm));
        colours.comment =
            std::string("mm; quality: distance from the other cavity, above 0 outside of it; ") +
            bone.space();
        bone.to_mm(mesh);
        write_ply(o.ply, mesh, colours);
    }
    console.clear();
    const auto value = [](const std::optional<double>& x) { return x ? json(*x) : json(nullptr); };
    if (o.json) {
        std::printf("%s\n", json{{"cavity_mm3", d.a_mm3},
                                 {"expert_mm3", d.b_mm3},
                                 {"both_mm3", d.both_mm3},
                                 {"dice", value(d.dice)},
                                 {"distance_mean_mm", value(d.mean_mm)},
                                 {"distance_p95_mm", value(d.p95_mm)},
                                 {"distance_max_mm", value(d.largest_mm)}}
                                .dump(2)
                                .c_str());
        return;
    }
    std::printf("cavity: %.1f mm3, expert's: %.1f mm3, in both: %.1f mm3\n", d.a_mm3, d.b_mm3, d.both_mm3);
    if (d.dice) std::printf("Dice: %.3f\n", *d.dice);
    if (d.mean_mm)
        std::printf("distance of their surfaces: mean %.2f mm, 95 %% within %.2f mm, largest %.2f mm\n",
                    *d.mean_mm, *d.p95_mm, *d.largest_mm);
    else
        std::printf("one of the cavities is empty: no distance\n");
    if (!o.ply.empty()) std::printf("wrote %s\n", o.ply.c_str());
}

}  // namespace

void add_bone_commands(CLI::App& app) {
    const auto e = std::make_shared<ExportBone>();
    CLI::App* const command = app.add_subcommand(
        "export-bone", "Write bone, as baked or as drilled, for other programs, in the axes of the scan");
    command->add_option("scene", e->scene, "Baked drilling scene")->required();
    command->add_option("--bone", e->bone, "Bone as drilled in a run, which kept it in this file")
        ->type_name("FILE.bone");
    command->add_option("--volume", e->volume, "Bone as a volume, in HU if the scan has them")
        ->type_name("FILE.nrrd|.nii|.nii.gz");
    command->add_option("--stl", e->stl, "Surface of the bone (mm)")->type_name("FILE.stl");
    command->add_option("--cavity", e->cavity, "Surface of what was drilled out (mm)")->type_name("FILE.stl");
    command->add_flag("--json", e->json, "Print the result as JSON");
    command->callback([e] { export_bone(*e); });

    const auto c = std::make_shared<CompareBone>();
    CLI::App* const compare = app.add_subcommand(
        "compare-bone", "Compare what was drilled with an expert's cavity: volumes, Dice, distances");
    compare->add_option("scene", c->scene, "Baked drilling scene")->required();
    compare->add_option("bone", c->bone, "Bone as drilled")->required()->type_name("FILE.bone");
    compare->add_option("expert", c->expert, "Bone as drilled by an expert")
        ->required()
        ->type_name("FILE.bone");
    compare
        ->add_option("--ply", c->ply,
                     "Surface of the cavity, coloured by its distance from the expert's: red where too much "
                     "was taken, blue where bone was left, full at 2 mm")
        ->type_name("FILE.ply");
    compare->add_flag("--json", c->json, "Print the result as JSON");
    compare->callback([c] { compare_bone(*c); });
}

}  // namespace tact
