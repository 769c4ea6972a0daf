#include "gui/drilling/bone_textures.hpp"

#include <algorithm>
#include <string>
#include <vector>

#include "ipc/base/clock.hpp"
#include "ipc/base/error.hpp"

namespace tact {
namespace {

constexpr GLsizei kEdge = BoneBricks::kEdge;

void volume_texture(GLuint name, GLint filter, GLenum wrap, const std::array<std::uint32_t, 3>& size) {
    glBindTexture(GL_TEXTURE_3D, name);
    glTexParameteri(GL_TEXTURE_3D, GL_TEXTURE_MIN_FILTER, filter);
    glTexParameteri(GL_TEXTURE_3D, GL_TEXTURE_MAG_FILTER, filter);
    for (const GLenum axis : {GL_TEXTURE_WRAP_S, GL_TEXTURE_WRAP_T, GL_TEXTURE_WRAP_R})
        glTexParameteri(GL_TEXTURE_3D, axis, static_cast<GLint>(wrap));
    glTexImage3D(GL_TEXTURE_3D, 0, GL_R8, static_cast<GLsizei>(size[0]), static_cast<GLsizei>(size[1]),
                 static_cast<GLsizei>(size[2]), 0, GL_RED, GL_UNSIGNED_BYTE, nullptr);
}

// Assembles the bricks of one layer into a texture of the volume's size.
template <class Value>
void fill_slab(const BoneBricks& bricks, std::uint32_t bz, std::vector<std::uint8_t>& slab,
               const Value& value) {
    const auto n = bricks.bricks();
    const std::size_t wide = bricks.size[0], high = bricks.size[1];
    const std::uint32_t deep = std::min<std::uint32_t>(kEdge, bricks.size[2] - bz * kEdge);
    slab.resize(wide * high * kEdge);
    std::array<std::uint8_t, BoneBricks::kVoxels> voxels{};
    for (std::uint32_t by = 0; by < n[1]; ++by)
        for (std::uint32_t bx = 0; bx < n[0]; ++bx) {
            value((bz * n[1] + by) * n[0] + bx, voxels);
            const std::size_t row = std::min<std::size_t>(kEdge, wide - std::size_t{bx} * kEdge);
            for (std::uint32_t z = 0; z < deep; ++z)
                for (std::uint32_t y = 0; y < kEdge && by * kEdge + y < high; ++y)
                    std::copy_n(voxels.data() + (std::size_t{z} * kEdge + y) * kEdge, row,
                                slab.data() + (z * high + std::size_t{by} * kEdge + y) * wide +
                                    std::size_t{bx} * kEdge);
        }
    glTexSubImage3D(GL_TEXTURE_3D, 0, 0, 0, static_cast<GLint>(bz * kEdge), static_cast<GLsizei>(wide),
                    static_cast<GLsizei>(high), static_cast<GLsizei>(deep), GL_RED, GL_UNSIGNED_BYTE,
                    slab.data());
}

}  // namespace

BoneTextures::BoneTextures(const BoneField& field, std::span<const BoneStructure> structures)
    : label_size_(field.labelled() ? field.bricks().size : std::array<std::uint32_t, 3>{1, 1, 1}),
      unsent_(field.bricks().bricks()[2]) {
    std::vector<std::uint8_t> rgba(std::size_t{4} * 256, 255);
    for (std::size_t i = 0; i < std::min<std::size_t>(structures.size(), 255); ++i)
        std::copy(structures[i].rgba.begin(), structures[i].rgba.end(), rgba.begin() + 4 * (i + 1));
    glBindTexture(GL_TEXTURE_2D, palette_.get());
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, GL_NEAREST);
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAG_FILTER, GL_NEAREST);
    glTexImage2D(GL_TEXTURE_2D, 0, GL_RGBA8, 256, 1, 0, GL_RGBA, GL_UNSIGNED_BYTE, rgba.data());
}

void BoneTextures::make_next(const BoneField& field) {
    while (glGetError() != GL_NO_ERROR) {
    }
    const BoneBricks& bricks = field.bricks();
    glPixelStorei(GL_UNPACK_ALIGNMENT, 1);
    if (unmade_ == 3) {
        volume_texture(solid_.get(), GL_LINEAR, GL_CLAMP_TO_BORDER, bricks.size);
    } else if (unmade_ == 2) {
        volume_texture(label_.get(), GL_NEAREST, GL_CLAMP_TO_EDGE, label_size_);
        if (!field.labelled()) {  // one voxel stands for all
            const std::uint8_t none = 0;
            glTexSubImage3D(GL_TEXTURE_3D, 0, 0, 0, 0, 1, 1, 1, GL_RED, GL_UNSIGNED_BYTE, &none);
        }
    } else {
        const auto& cells = field.cells();
        volume_texture(cells_.get(), GL_NEAREST, GL_CLAMP_TO_EDGE, cells);
        // Empty with distance 1: rays cross them one by one and skip nothing that was sent.
        const std::vector<std::uint8_t> empty(std::size_t{cells[0]} * cells[1] * cells[2], std::uint8_t{1});
        glTexSubImage3D(GL_TEXTURE_3D, 0, 0, 0, 0, static_cast<GLsizei>(cells[0]),
                        static_cast<GLsizei>(cells[1]), static_cast<GLsizei>(cells[2]), GL_RED,
                        GL_UNSIGNED_BYTE, empty.data());
    }
    glPixelStorei(GL_UNPACK_ALIGNMENT, 4);
    if (const GLenum error = glGetError(); error != GL_NO_ERROR)
        throw StartupError("showing bone of " + std::to_string(bricks.size[0]) + " x " +
                               std::to_string(bricks.size[1]) + " x " + std::to_string(bricks.size[2]) +
                               " voxels",
                           "not enough graphics memory, error " + std::to_string(error),
                           "bake a part of it with --crop, or larger voxels with --voxel-mm");
    --unmade_;
}

void BoneTextures::fill(const BoneField& field, double seconds) {
    const Instant begin = Monotonic::now();
    const auto over = [&] { return to_s(Monotonic::now() - begin) >= seconds; };
    while (!made()) {
        make_next(field);
        if (over()) return;
    }
    const BoneBricks& bricks = field.bricks();
    glPixelStorei(GL_UNPACK_ALIGNMENT, 1);
    std::vector<std::uint8_t> slab;
    while (unsent_ > 0) {
        const std::uint32_t bz = --unsent_;
        glBindTexture(GL_TEXTURE_3D, solid_.get());
        fill_slab(bricks, bz, slab, [&](std::uint32_t b, std::span<std::uint8_t, BoneBricks::kVoxels> out) {
            field.solids(b, out);
        });
        if (field.labelled()) {
            glBindTexture(GL_TEXTURE_3D, label_.get());
            fill_slab(bricks, bz, slab,
                      [&](std::uint32_t b, std::span<std::uint8_t, BoneBricks::kVoxels> out) {
                          for (std::size_t i = 0; i < out.size(); ++i)
                              out[i] = field.label(std::size_t{b} * out.size() + i);
                      });
        }
        send_cells(field, bz, 1);
        if (over()) break;
    }
    glPixelStorei(GL_UNPACK_ALIGNMENT, 4);
}

float BoneTextures::filled(const BoneField& field) const {
    return 1.0F - static_cast<float>(unsent_) / static_cast<float>(field.bricks().bricks()[2]);
}

void BoneTextures::send(const BoneField& field, std::uint32_t brick) {
    const BoneBricks& bricks = field.bricks();
    const auto n = bricks.bricks();
    const std::array<std::uint32_t, 3> at{brick % n[0], brick / n[0] % n[1], brick / n[0] / n[1]};
    if (at[2] < unsent_) return;  // it will be sent later, in its current state
    std::array<std::uint8_t, BoneBricks::kVoxels> voxels{};
    field.solids(brick, voxels);
    std::array<GLint, 3> first{};
    std::array<GLsizei, 3> size{};
    for (std::size_t i = 0; i < 3; ++i) {
        first[i] = static_cast<GLint>(at[i] * BoneBricks::kEdge);
        size[i] = std::min(kEdge, static_cast<GLsizei>(bricks.size[i]) - first[i]);
    }
    glPixelStorei(GL_UNPACK_ALIGNMENT, 1);
    glPixelStorei(GL_UNPACK_ROW_LENGTH, kEdge);
    glPixelStorei(GL_UNPACK_IMAGE_HEIGHT, kEdge);
    glBindTexture(GL_TEXTURE_3D, solid_.get());
    glTexSubImage3D(GL_TEXTURE_3D, 0, first[0], first[1], first[2], size[0], size[1], size[2], GL_RED,
                    GL_UNSIGNED_BYTE, voxels.data());
    constexpr std::uint32_t kCells = BoneBricks::kEdge / BoneField::kCell;
    std::array<std::uint8_t, std::size_t{kCells} * kCells * kCells> cells{};
    const auto& wide = field.cells();
    for (std::size_t i = 0; i < cells.size(); ++i) {
        const std::size_t x = std::size_t{at[0]} * kCells + i % kCells,
                          y = std::size_t{at[1]} * kCells + i / kCells % kCells,
                          z = std::size_t{at[2]} * kCells + i / kCells / kCells;
        cells[i] = field.free_cells()[(z * wide[1] + y) * wide[0] + x];
    }
    glPixelStorei(GL_UNPACK_ROW_LENGTH, 0);
    glPixelStorei(GL_UNPACK_IMAGE_HEIGHT, 0);
    glBindTexture(GL_TEXTURE_3D, cells_.get());
    glTexSubImage3D(GL_TEXTURE_3D, 0, static_cast<GLint>(at[0] * kCells), static_cast<GLint>(at[1] * kCells),
                    static_cast<GLint>(at[2] * kCells), kCells, kCells, kCells, GL_RED, GL_UNSIGNED_BYTE,
                    cells.data());
    glPixelStorei(GL_UNPACK_ALIGNMENT, 4);
}

void BoneTextures::send_cells(const BoneField& field) {
    send_cells(field, unsent_, field.bricks().bricks()[2] - unsent_);
}

void BoneTextures::send_cells(const BoneField& field, std::uint32_t first, std::uint32_t count) {
    constexpr std::uint32_t kCells = BoneBricks::kEdge / BoneField::kCell;
    const auto& n = field.cells();
    glPixelStorei(GL_UNPACK_ALIGNMENT, 1);
    glBindTexture(GL_TEXTURE_3D, cells_.get());
    glTexSubImage3D(GL_TEXTURE_3D, 0, 0, 0, static_cast<GLint>(first * kCells), static_cast<GLsizei>(n[0]),
                    static_cast<GLsizei>(n[1]), static_cast<GLsizei>(count * kCells), GL_RED,
                    GL_UNSIGNED_BYTE, field.free_cells().data() + std::size_t{first} * kCells * n[0] * n[1]);
    glPixelStorei(GL_UNPACK_ALIGNMENT, 4);
}

void BoneTextures::send_wet(const WetBone& wet) {
    glPixelStorei(GL_UNPACK_ALIGNMENT, 1);
    glBindTexture(GL_TEXTURE_3D, wet_.get());
    const auto& n = wet.size();
    const auto width = static_cast<GLsizei>(n[0]), height = static_cast<GLsizei>(n[1]),
               depth = static_cast<GLsizei>(n[2]);
    if (wet_size_ != n) {
        wet_size_ = n;
        for (const GLenum filter : {GL_TEXTURE_MIN_FILTER, GL_TEXTURE_MAG_FILTER})
            glTexParameteri(GL_TEXTURE_3D, filter, GL_LINEAR);
        for (const GLenum axis : {GL_TEXTURE_WRAP_S, GL_TEXTURE_WRAP_T, GL_TEXTURE_WRAP_R})
            glTexParameteri(GL_TEXTURE_3D, axis, GL_CLAMP_TO_EDGE);
        glTexImage3D(GL_TEXTURE_3D, 0, GL_RG8, width, height, depth, 0, GL_RG, GL_UNSIGNED_BYTE,
                     wet.texels().data());
    } else {
        constexpr std::uint32_t kCells = BoneBricks::kEdge / WetBone::kCell;
        const std::uint32_t wide = n[0] / kCells, high = n[1] / kCells;
        glPixelStorei(GL_UNPACK_ROW_LENGTH, width);
        glPixelStorei(GL_UNPACK_IMAGE_HEIGHT, height);
        for (const std::uint32_t b : wet.changed()) {
            const std::uint32_t x = b % wide * kCells, y = b / wide % high * kCells,
                                z = b / wide / high * kCells;
            glTexSubImage3D(GL_TEXTURE_3D, 0, static_cast<GLint>(x), static_cast<GLint>(y),
                            static_cast<GLint>(z), kCells, kCells, kCells, GL_RG, GL_UNSIGNED_BYTE,
                            &wet.texels()[(std::size_t{z} * n[1] + y) * n[0] + x]);
        }
        glPixelStorei(GL_UNPACK_ROW_LENGTH, 0);
        glPixelStorei(GL_UNPACK_IMAGE_HEIGHT, 0);
    }
    glPixelStorei(GL_UNPACK_ALIGNMENT, 4);
}

void BoneTextures::bind() {
    GLenum unit = GL_TEXTURE0;
    for (GlTexture* const t : {&solid_, &cells_, &label_, &wet_}) {
        glActiveTexture(unit++);
        glBindTexture(GL_TEXTURE_3D, t->get());
    }
    glActiveTexture(unit);
    glBindTexture(GL_TEXTURE_2D, palette_.get());
    glActiveTexture(GL_TEXTURE0);
}

}  // namespace tact
