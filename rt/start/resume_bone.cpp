#include "rt/start/resume_bone.hpp"

#include <algorithm>

namespace tact {
namespace {

// Repeats the strokes of a file on a bone.
class Resumed {
public:
    explicit Resumed(DrillBone& bone) : bone_(bone), n_(bone.octree.blocks(0)) {}

    void take(const DrilledBrick& b) {
        if (b.stroke != stroke_ || !begun_) begin(b.stroke);
        std::uint8_t* const here = bone_.density.data() + std::size_t{b.brick} * BoneBricks::kVoxels;
        if (std::equal(b.voxels.begin(), b.voxels.end(), here)) return;
        if (of_stroke_) bone_.strokes.look(b.brick, here);
        std::copy(b.voxels.begin(), b.voxels.end(), here);
        if (of_stroke_) bone_.strokes.keep(b.brick);
        const auto lost =
            bone_.octree.refresh(b.brick % n_[0], b.brick / n_[0] % n_[1], b.brick / n_[0] / n_[1]);
        bone_.returned_levels -= lost.m0;
        raise_revision(bone_.revision[b.brick]);
    }
    void end() { bone_.strokes.end_stroke(); }

private:
    void begin(std::uint32_t stroke) {
        begun_ = true;
        stroke_ = stroke;
        bone_.strokes.end_stroke();
        of_stroke_ = stroke > bone_.strokes.strokes();
        while (bone_.strokes.strokes() > stroke && bone_.strokes.undo())
            while (bone_.strokes.exchanging()) bone_.exchange();
        const std::uint32_t before = stroke - (of_stroke_ ? 1 : 0);
        if (bone_.strokes.strokes() != before) bone_.strokes.restart(before);
    }

    DrillBone& bone_;
    std::array<std::uint32_t, 3> n_;
    std::uint32_t stroke_ = 0;
    bool begun_ = false, of_stroke_ = false;
};

}  // namespace

DrilledBoneSummary resume_bone(const std::filesystem::path& file, const SceneFile& scene, DrillBone& bone) {
    Resumed resumed(bone);
    const DrilledBoneSummary sum = read_drilled_bone(file, read_bone_volume(scene), scene.checksum(),
                                                     [&](const DrilledBrick& brick) { resumed.take(brick); });
    resumed.end();
    return sum;
}

}  // namespace tact
