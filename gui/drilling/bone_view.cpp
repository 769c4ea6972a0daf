#include "gui/drilling/bone_view.hpp"

#include <algorithm>
#include <cmath>

#include "ipc/base/error.hpp"
#include "ipc/base/units.hpp"

namespace tact {
namespace {

constexpr double kReachVoxels = 10.0;    // range of lighting and openness, within which a change is visible
constexpr double kWetReachVoxels = 6.0;  // a cell and the place in front of the bone
constexpr float kSharpStep = 1.0F, kCoarseStep = 1.4F;  // voxels
constexpr int kCoarsest = 12;                           // pixels per ray

bool same_view(const BoneFrame& a, const BoneFrame& b) {
    return a.eye_from_scene == b.eye_from_scene && a.projection == b.projection && a.haze == b.haze &&
           a.width_px == b.width_px && a.height_px == b.height_px && a.coaxial_light == b.coaxial_light;
}

// Two triangles over a box, in clip space.
std::array<float, 12> quad(const BoneFrame& of, const PixelBox& b) {
    const auto clip = [](int px, int size) {
        return 2.0F * static_cast<float>(px) / static_cast<float>(size) - 1.0F;
    };
    const float x0 = clip(b.x0, of.width_px), x1 = clip(b.x1, of.width_px);
    const float y0 = clip(b.y0, of.height_px), y1 = clip(b.y1, of.height_px);
    return {x0, y0, x1, y0, x1, y1, x0, y0, x1, y1, x0, y1};
}

}  // namespace

BoneView::BoneView(const BoneContent& bone, const Vec3& centre_model_m, const BoneVolumeView& now)
    : field_(bone.volume, bone.labels, now, bone.free_cells),
      textures_(field_, bone.labels.structure),
      scene_from_voxels_(Eigen::Matrix4f::Identity()) {
    const BoneBricks& b = now.bricks;
    scene_from_voxels_.topLeftCorner<3, 3>() *= static_cast<float>(b.voxel_m / kAngstromM);
    scene_from_voxels_.topRightCorner<3, 1>() = ((b.origin_m - centre_model_m) / kAngstromM).cast<float>();
    glBindVertexArray(array_.get());
    glBindBuffer(GL_ARRAY_BUFFER, corners_.get());
    attribute(0, 2, GL_FLOAT, GL_FALSE, 8, 0);
    glBindVertexArray(0);
}

void BoneView::Picture::resize(int width, int height) {
    width_px = width;
    height_px = height;
    const auto image = [&](GLuint name, GLint inner, GLenum format, GLenum type) {
        glBindTexture(GL_TEXTURE_2D, name);
        for (const GLenum filter : {GL_TEXTURE_MIN_FILTER, GL_TEXTURE_MAG_FILTER})
            glTexParameteri(GL_TEXTURE_2D, filter, GL_NEAREST);
        for (const GLenum wrap : {GL_TEXTURE_WRAP_S, GL_TEXTURE_WRAP_T})
            glTexParameteri(GL_TEXTURE_2D, wrap, GL_CLAMP_TO_EDGE);
        glTexImage2D(GL_TEXTURE_2D, 0, inner, width, height, 0, format, type, nullptr);
    };
    image(colour.get(), GL_RGBA8, GL_RGBA, GL_UNSIGNED_BYTE);
    image(depth.get(), GL_DEPTH_COMPONENT24, GL_DEPTH_COMPONENT, GL_UNSIGNED_INT);
    glBindFramebuffer(GL_FRAMEBUFFER, frame.get());
    glFramebufferTexture2D(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, GL_TEXTURE_2D, colour.get(), 0);
    glFramebufferTexture2D(GL_FRAMEBUFFER, GL_DEPTH_ATTACHMENT, GL_TEXTURE_2D, depth.get(), 0);
    if (glCheckFramebufferStatus(GL_FRAMEBUFFER) != GL_FRAMEBUFFER_COMPLETE)
        throw StartupError("creating the image of the bone", "the graphics driver rejects it",
                           "use a smaller --size");
}

void BoneView::Picture::bind(int width, int height) {
    glBindFramebuffer(GL_FRAMEBUFFER, frame.get());
    glViewport(0, 0, width, height);
}

float BoneView::reach_a() const {
    const double voxel_a = static_cast<double>(scene_from_voxels_(0, 0));
    const Vec3 centre = -scene_from_voxels_.topRightCorner<3, 1>().cast<double>() / voxel_a;
    return static_cast<float>(voxel_a * field_.reach_voxels(centre));
}

void BoneView::changed(std::uint32_t brick, bool grown) {
    field_.changed(brick, grown);
    const auto n = field_.bricks().bricks();
    const std::uint32_t around = field_.smooth() ? 1 : 0;
    const std::array<std::uint32_t, 3> at{brick % n[0], brick / n[0] % n[1], brick / n[0] / n[1]};
    for (std::uint32_t z = at[2] - std::min(at[2], around); z <= std::min(at[2] + around, n[2] - 1); ++z)
        for (std::uint32_t y = at[1] - std::min(at[1], around); y <= std::min(at[1] + around, n[1] - 1); ++y)
            for (std::uint32_t x = at[0] - std::min(at[0], around); x <= std::min(at[0] + around, n[0] - 1);
                 ++x)
                changed_.push_back((z * n[1] + y) * n[0] + x);
    for (Eyeful& eye : eye_)
        if (eye.pixels() > 0) eye.changed.push_back(brick);
}

void BoneView::wetted(const WetBone& wet) {
    if (wet.changed().empty()) return;
    textures_.send_wet(wet);
    for (Eyeful& eye : eye_)
        if (eye.pixels() > 0) eye.wetted.insert(eye.wetted.end(), wet.changed().begin(), wet.changed().end());
}

PixelBox BoneView::on_screen(const BoneFrame& frame, const Vec3& low, const Vec3& high) const {
    const Eigen::Matrix4f clip_from_voxels = frame.projection * frame.eye_from_scene * scene_from_voxels_;
    Eigen::Vector2f least(1e9F, 1e9F), most(-1e9F, -1e9F);
    for (unsigned k = 0; k < 8; ++k) {
        const Eigen::Vector4f corner(static_cast<float>((k & 1U) != 0 ? high.x() : low.x()),
                                     static_cast<float>((k & 2U) != 0 ? high.y() : low.y()),
                                     static_cast<float>((k & 4U) != 0 ? high.z() : low.z()), 1.0F);
        const Eigen::Vector4f clip = clip_from_voxels * corner;
        if (!(clip.w() > 1e-6F * std::abs(clip.z()))) return {0, 0, frame.width_px, frame.height_px};
        const Eigen::Vector2f at = clip.head<2>() / clip.w();
        least = least.cwiseMin(at);
        most = most.cwiseMax(at);
    }
    const auto px = [](float share, int size, bool up) {
        const float p = std::clamp(0.5F + 0.5F * share, 0.0F, 1.0F) * static_cast<float>(size);
        return static_cast<int>(up ? std::ceil(p) : std::floor(p));
    };
    return {px(least.x(), frame.width_px, false), px(least.y(), frame.height_px, false),
            px(most.x(), frame.width_px, true), px(most.y(), frame.height_px, true)};
}

void BoneView::send_changes() {
    const bool cells_anew = field_.settle();
    std::sort(changed_.begin(), changed_.end());
    changed_.erase(std::unique(changed_.begin(), changed_.end()), changed_.end());
    for (const std::uint32_t b : changed_) textures_.send(field_, b);
    if (cells_anew) textures_.send_cells(field_);
    changed_.clear();
}

void BoneView::mark_changes(Eyeful& eye, bool view_is_same) const {
    if (view_is_same) {
        mark(eye, eye.changed, kReachVoxels);
        mark(eye, eye.wetted, kWetReachVoxels);
    }
    eye.changed.clear();
    eye.wetted.clear();
}

void BoneView::mark(Eyeful& eye, std::span<const std::uint32_t> bricks, double reach_voxels) const {
    const auto n = field_.bricks().bricks();
    for (const std::uint32_t b : bricks) {
        const std::uint32_t x = b % n[0], y = b / n[0] % n[1], z = b / n[0] / n[1];
        const Vec3 low = Vec3(x, y, z) * double{BoneBricks::kEdge};
        eye.tiles.stale(on_screen(eye.last, low.array() - reach_voxels,
                                  low.array() + (BoneBricks::kEdge + reach_voxels)));
    }
}

void BoneView::draw(const BoneFrame& frame) {
    GLint bound = 0;
    glGetIntegerv(GL_DRAW_FRAMEBUFFER_BINDING, &bound);
    Eyeful& eye = eye_[frame.eye];
    eye.rays = 0;
    if (frame.width_px != eye.sharp.width_px || frame.height_px != eye.sharp.height_px) {
        eye.sharp.resize(frame.width_px, frame.height_px);
        eye.coarse.resize((frame.width_px + 1) / 2, (frame.height_px + 1) / 2);
        eye.tiles.resize(frame.width_px, frame.height_px);
    }
    if (!textures_.full()) textures_.fill(field_, frame.fill_s);
    if (!textures_.made()) {
        glBindFramebuffer(GL_FRAMEBUFFER, static_cast<GLuint>(bound));
        return;
    }
    const float filled = textures_.filled(field_);
    const bool same = filled == eye.filled && same_view(frame, eye.last);
    eye.filled = filled;
    if (!same) {
        const auto& size = field_.bricks().size;
        eye.tiles.all_wrong(
            on_screen(frame, Vec3::Constant(-0.5), Vec3(size[0], size[1], size[2]).array() - 0.5));
    }
    eye.last = frame;
    send_changes();
    mark_changes(eye, same);

    glEnable(GL_DEPTH_TEST);
    glDepthFunc(GL_ALWAYS);
    glDisable(GL_BLEND);
    glBindVertexArray(array_.get());
    glBindBuffer(GL_ARRAY_BUFFER, corners_.get());
    const std::uint32_t wrong = eye.tiles.rays_wrong();
    if (!same && wrong > frame.rays_most)
        draw_coarse(eye, frame.rays_most);
    else
        draw_tiles(eye, eye.tiles.take(frame.rays_most));
    glBindFramebuffer(GL_FRAMEBUFFER, static_cast<GLuint>(bound));
    glViewport(frame.x_px, frame.y_px, frame.width_px, frame.height_px);
    show(eye);
    glBindVertexArray(0);
}

void BoneView::draw_coarse(Eyeful& eye, std::uint32_t rays_most) {
    const BoneFrame& frame = eye.last;
    const double pixels_a_ray =
        static_cast<double>(std::max(eye.tiles.rays_wrong(), 1U)) / std::max(rays_most, 1U);
    const int every = std::clamp(static_cast<int>(std::ceil(std::sqrt(pixels_a_ray))), 2, kCoarsest);
    const int w = (frame.width_px + every - 1) / every, h = (frame.height_px + every - 1) / every;
    eye.coarse_share_x = static_cast<float>(w) / static_cast<float>(eye.coarse.width_px);
    eye.coarse_share_y = static_cast<float>(h) / static_cast<float>(eye.coarse.height_px);
    eye.coarse.bind(w, h);
    program_.use(textures_, field_, frame.eye_from_scene * scene_from_voxels_, frame.projection, frame.haze,
                 kCoarseStep, frame.coaxial_light);
    const auto corners = quad(eye.last, {0, 0, frame.width_px, frame.height_px});
    glBufferData(GL_ARRAY_BUFFER, sizeof corners, corners.data(), GL_STREAM_DRAW);
    glDrawArrays(GL_TRIANGLES, 0, 6);
    eye.rays += eye.tiles.rays_wrong() / static_cast<std::uint32_t>(every * every);
}

void BoneView::draw_tiles(Eyeful& eye, std::span<const std::uint32_t> tiles) {
    if (tiles.empty()) return;
    std::vector<float> corners;
    for (const std::uint32_t i : tiles) {
        const auto q = quad(eye.last, eye.tiles.box(i));
        corners.insert(corners.end(), q.begin(), q.end());
        eye.rays += eye.tiles.rays(i);
    }
    eye.sharp.bind(eye.sharp.width_px, eye.sharp.height_px);
    program_.use(textures_, field_, eye.last.eye_from_scene * scene_from_voxels_, eye.last.projection,
                 eye.last.haze, kSharpStep, eye.last.coaxial_light);
    glBufferData(GL_ARRAY_BUFFER, static_cast<GLsizeiptr>(corners.size() * sizeof(float)), corners.data(),
                 GL_STREAM_DRAW);
    glDrawArrays(GL_TRIANGLES, 0, static_cast<GLsizei>(corners.size() / 2));
}

void BoneView::show(Eyeful& eye) {
    glDepthFunc(GL_LESS);
    std::vector<float> good, wrong;
    for (std::uint32_t i = 0; i < eye.tiles.count(); ++i) {
        if (eye.tiles.rays(i) == 0) continue;
        const auto q = quad(eye.last, eye.tiles.box(i));
        std::vector<float>& to = eye.tiles.wrong(i) ? wrong : good;
        to.insert(to.end(), q.begin(), q.end());
    }
    const auto show_tiles = [&](Picture& picture, float x, float y, const std::vector<float>& corners) {
        if (corners.empty() || !(x > 0.0F)) return;
        on_screen_.use(picture.colour.get(), picture.depth.get(), x, y, &picture == &eye.coarse);
        glBufferData(GL_ARRAY_BUFFER, static_cast<GLsizeiptr>(corners.size() * sizeof(float)), corners.data(),
                     GL_STREAM_DRAW);
        glDrawArrays(GL_TRIANGLES, 0, static_cast<GLsizei>(corners.size() / 2));
    };
    show_tiles(eye.sharp, 1.0F, 1.0F, good);
    show_tiles(eye.coarse, eye.coarse_share_x, eye.coarse_share_y, wrong);
}

}  // namespace tact
