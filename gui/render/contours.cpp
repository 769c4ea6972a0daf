#include "gui/render/contours.hpp"

#include <algorithm>
#include <cmath>

namespace tact {
namespace {

// A level is applied at once if that takes no longer than one frame at 30 Hz.
constexpr double kAtOnceS = 0.033;
// Opacity of the face of a cut through glass: bodies behind it stay visible.
constexpr float kGlassFace = 0.4F;

}  // namespace

Eigen::Vector3f contour_colour(std::size_t contour) {
    // The outermost is cold and pale, because others are seen through it; the inner ones are warm.
    static const std::array<Eigen::Vector3f, kContoursMax> kColours{
        {{0.66F, 0.80F, 0.95F}, {0.98F, 0.76F, 0.35F}, {0.55F, 0.86F, 0.62F}, {0.93F, 0.60F, 0.78F}}};
    return kColours[contour % kContoursMax];
}

Contours::Contours(std::shared_ptr<const SceneContent> content, Programs& programs, RefineContour refine)
    : content_(std::move(content)), programs_(programs) {
    if (!content_->grid.values.empty())
        worker_ = std::make_unique<ContourWorker>(content_, std::move(refine));
    Contour own;
    own.level = content_->meta.contour;
    if (content_->mesh || worker_) set(std::array{own});
}

void Contours::set(std::span<const Contour> contours) {
    wanted_.assign(contours.begin(),
                   contours.begin() + static_cast<std::ptrdiff_t>(std::min(contours.size(), kContoursMax)));
    for (std::size_t i = 0; i < kContoursMax; ++i) {
        Slot& slot = slot_[i];
        const bool want = i < wanted_.size() && wanted_[i].shown;
        const bool own = want && content_->mesh && wanted_[i].level == content_->meta.contour;
        std::optional<double> ask;
        if (want && !own && !(slot.surface && slot.state.level == wanted_[i].level)) ask = wanted_[i].level;
        if (worker_ && ask != slot.asked) worker_->request(i, ask);
        slot.asked = ask;
        if (own && !(slot.surface && slot.mesh.get() == content_->mesh.get()))
            show_mesh(slot, {content_, content_->mesh.get()}, wanted_[i].level);
    }
}

ContourState Contours::state(std::size_t contour) const {
    return contour < kContoursMax ? slot_[contour].state : ContourState{};
}

void Contours::show_mesh(Slot& slot, std::shared_ptr<const ProgressiveMesh> mesh, double level) {
    slot.full.reset();
    slot.surface.reset();
    slot.mesh = std::move(mesh);
    slot.surface = std::make_unique<Surface>(*slot.mesh);
    // At once: otherwise its base mesh would show for a moment.
    slot.surface->approach(static_cast<std::uint32_t>(std::round(share_ * slot.mesh->vertices())), 1e9);
    slot.plain = PlainSurface();
    slot.plain_full = 0;
    slot.state = ContourState{};
    slot.state.level = level;
    slot.state.final = true;
}

void Contours::take_news(std::size_t contour, std::size_t& bytes) {
    std::optional<ContourOutcome> news = worker_->take(contour);
    Slot& slot = slot_[contour];
    if (!news || !slot.asked) return;
    if (news->mesh) {
        show_mesh(slot, std::move(news->mesh), news->level);
    } else if (news->plain) {
        slot.full.reset();
        slot.surface.reset();
        slot.mesh.reset();
        bytes += slot.plain.fill(*news->plain);
        slot.plain_full = news->vertices_full;
        slot.state = ContourState{};
        slot.state.level = news->level;
        slot.state.stride = news->stride;
        slot.state.final = news->plain->empty();
    }
    slot.state.error = std::move(news->error);
    slot.state.extract_s = news->extract_s;
}

std::size_t Contours::upload() {
    std::size_t bytes = 0;
    for (std::size_t i = 0; worker_ && i < kContoursMax; ++i) take_news(i, bytes);
    for (std::size_t i = 0; i < kContoursMax; ++i)
        if (shown(i) && slot_[i].surface) bytes += slot_[i].surface->upload();
    return bytes;
}

bool Contours::shown(std::size_t contour) const { return contour < wanted_.size() && wanted_[contour].shown; }

std::uint32_t Contours::full(const Slot& slot) const {
    return slot.mesh ? slot.mesh->vertices() : slot.plain_full;
}

void Contours::approach_vertices(std::uint32_t wanted, double budget_s) noexcept {
    const std::uint32_t most = vertices_max();
    share_ = most > 0 ? std::min(1.0, static_cast<double>(wanted) / most) : 1.0;
    apply_share(budget_s);
}

void Contours::apply_share(double budget_s) noexcept {
    const auto surfaces = static_cast<double>(std::max<std::size_t>(wanted_.size(), 1));
    double plain = 0.0;
    for (std::size_t i = 0; i < kContoursMax; ++i) {
        if (!shown(i)) continue;
        const double part = std::round(share_ * full(slot_[i]));
        if (slot_[i].surface)
            slot_[i].surface->approach(static_cast<std::uint32_t>(part), budget_s / surfaces,
                                       kAtOnceS / surfaces);
        else
            plain = std::max(plain, part);
    }
    // Fewer vertices than this do not show the shape.
    constexpr double kLeast = 3000.0;
    if (worker_)
        worker_->set_vertices_max(share_ >= 1.0 ? ContourWorker::kPlainVerticesMax
                                                : static_cast<std::uint32_t>(std::clamp(plain, kLeast, 1e9)));
}

void Contours::set_refined(bool refined) {
    refined_ = refined;
    if (!refined) return;
    for (std::size_t i = 0; i < kContoursMax; ++i) {
        Slot& slot = slot_[i];
        if (!shown(i) || !slot.surface || slot.full) continue;
        if (slot.surface->cut().vertices() >= slot.mesh->vertices()) continue;
        slot.full = std::make_unique<Surface>(*slot.mesh);
        slot.full->approach(slot.mesh->vertices(), 1e9);
        slot.full->upload();
    }
}

void Contours::add_to(ContentKey& key) const {
    for (std::size_t i = 0; i < wanted_.size(); ++i) {
        const Contour& c = wanted_[i];
        key.add(c.shown);
        if (!c.shown) continue;
        for (int k = 0; k < 3; ++k) key.add(c.colour[k]);
        key.add(c.opacity);
        key.add(c.style ? static_cast<int>(*c.style) : -1);
        key.add(slot_[i].state.level);
        key.add(slot_[i].state.stride);
        key.add(slot_[i].surface != nullptr);
        if (!slot_[i].surface) key.add(slot_[i].plain.vertices());
    }
}

std::uint32_t Contours::vertices() const {
    std::uint32_t sum = 0;
    for (std::size_t i = 0; i < kContoursMax; ++i)
        if (shown(i))
            sum += slot_[i].surface ? slot_[i].surface->cut().vertices() : slot_[i].plain.vertices();
    return sum;
}

std::uint32_t Contours::triangles() const {
    std::uint32_t sum = 0;
    for (std::size_t i = 0; i < kContoursMax; ++i)
        if (shown(i))
            sum += slot_[i].surface ? slot_[i].surface->cut().triangles() : slot_[i].plain.triangles();
    return sum;
}

std::uint32_t Contours::vertices_min() const {
    std::uint32_t sum = 0;
    for (std::size_t i = 0; i < kContoursMax; ++i)
        if (shown(i) && slot_[i].mesh) sum += slot_[i].mesh->vertices_min();
    return sum;
}

std::uint32_t Contours::vertices_max() const {
    std::uint64_t sum = 0;
    for (std::size_t i = 0; i < kContoursMax; ++i)
        if (shown(i)) sum += full(slot_[i]);
    return static_cast<std::uint32_t>(std::min<std::uint64_t>(sum, 1U << 30U));
}

double Contours::error_m() const {
    double most = 0.0;
    for (std::size_t i = 0; i < kContoursMax; ++i)
        if (shown(i) && slot_[i].surface)
            most = std::max(most, static_cast<double>(slot_[i].surface->cut().error_m()));
    return most;
}

bool Contours::opaque(const Contour& contour, SurfaceStyle otherwise) const {
    return contour.style.value_or(otherwise) != SurfaceStyle::glass && contour.opacity >= 1.0F;
}

void Contours::draw_opaque(const Eigen::Matrix4f& eye, const Eigen::Matrix4f& projection, const Haze& haze,
                           SurfaceStyle otherwise) {
    glDisable(GL_BLEND);
    for (std::size_t i = 0; i < wanted_.size(); ++i)
        if (shown(i) && opaque(wanted_[i], otherwise)) draw(i, eye, projection, haze, otherwise);
}

void Contours::draw_clear(const Eigen::Matrix4f& eye, const Eigen::Matrix4f& projection, const Haze& haze,
                          SurfaceStyle otherwise) {
    std::vector<std::size_t> inside_first;
    for (std::size_t i = 0; i < wanted_.size(); ++i)
        if (shown(i) && !opaque(wanted_[i], otherwise)) inside_first.push_back(i);
    std::sort(inside_first.begin(), inside_first.end(),
              [this](std::size_t a, std::size_t b) { return wanted_[a].level > wanted_[b].level; });
    glEnable(GL_BLEND);
    glBlendFunc(GL_SRC_ALPHA, GL_ONE_MINUS_SRC_ALPHA);
    for (const std::size_t i : inside_first) draw(i, eye, projection, haze, otherwise);
    glDisable(GL_BLEND);
}

bool Contours::glass_alone(SurfaceStyle otherwise) const {
    bool any = false;
    for (std::size_t i = 0; i < wanted_.size(); ++i) {
        if (!shown(i) || opaque(wanted_[i], otherwise)) continue;
        if (wanted_[i].style.value_or(otherwise) != SurfaceStyle::glass) return false;
        any = true;
    }
    return any;
}

void Contours::draw_glass_to_sort(const Eigen::Matrix4f& eye, const Eigen::Matrix4f& projection,
                                  const Haze& haze, SurfaceStyle otherwise) {
    for (std::size_t i = 0; i < wanted_.size(); ++i)
        if (shown(i) && !opaque(wanted_[i], otherwise)) draw(i, eye, projection, haze, otherwise, true);
}

void Contours::draw_cut(const Eigen::Matrix4f& eye, const Eigen::Matrix4f& projection, const Haze& haze,
                        SurfaceStyle otherwise) {
    if (content_->grid.values.empty()) return;
    std::vector<DensitySlice::Level> levels;
    for (std::size_t i = 0; i < wanted_.size(); ++i) {
        const Contour& c = wanted_[i];
        const SurfaceStyle style = c.style.value_or(otherwise);
        if (!shown(i) || style == SurfaceStyle::wire || c.level < content_->meta.map_mean) continue;
        const float face = style == SurfaceStyle::glass ? kGlassFace : 1.0F;
        levels.push_back({slot_[i].state.level, c.colour, face * std::clamp(c.opacity, 0.0F, 1.0F)});
    }
    if (levels.empty()) return;
    if (!slice_) slice_ = std::make_unique<DensitySlice>(content_->grid);
    // What is translucent hides nothing that is drawn later.
    const bool solid =
        std::all_of(levels.begin(), levels.end(), [](const auto& l) { return l.opacity >= 1.0F; });
    glDepthMask(solid ? GL_TRUE : GL_FALSE);
    slice_->draw(eye, projection, haze, levels);
    glDepthMask(GL_TRUE);
}

void Contours::draw(std::size_t i, const Eigen::Matrix4f& eye, const Eigen::Matrix4f& projection,
                    const Haze& haze, SurfaceStyle otherwise, bool sorted) {
    const Contour& contour = wanted_[i];
    Slot& slot = slot_[i];
    const SurfaceStyle style = contour.style.value_or(otherwise);
    programs_.use_lit(
        eye, projection, haze,
        {.glass = style == SurfaceStyle::glass, .opacity = std::clamp(contour.opacity, 0.0F, 1.0F)});
    const auto triangles = [&] {
        if (slot.surface)
            (refined_ && slot.full ? *slot.full : *slot.surface).draw(contour.colour);
        else
            slot.plain.draw(contour.colour);
    };
    if (style == SurfaceStyle::wire) {
        glPolygonMode(GL_FRONT_AND_BACK, GL_LINE);
        triangles();
        glPolygonMode(GL_FRONT_AND_BACK, GL_FILL);
    } else if (style == SurfaceStyle::glass) {
        // Of a contour only the walls towards the eye: the far walls veil the structures inside, and take half of the time in
        // software rendering. Contours face the lower density; below the map's mean that is their inside.
        const bool of_map = !content_->grid.values.empty();
        if (of_map) {
            glEnable(GL_CULL_FACE);
            glCullFace(contour.level >= content_->meta.map_mean ? GL_BACK : GL_FRONT);
        }
        if (!sorted) glDepthMask(GL_FALSE);
        triangles();
        glDisable(GL_CULL_FACE);
        if (!sorted) glDepthMask(GL_TRUE);
    } else if (contour.opacity < 1.0F) {
        // Only the nearest layer, so that it looks like one object: first the depth, then the colour.
        glColorMask(GL_FALSE, GL_FALSE, GL_FALSE, GL_FALSE);
        triangles();
        glColorMask(GL_TRUE, GL_TRUE, GL_TRUE, GL_TRUE);
        glDepthFunc(GL_LEQUAL);
        triangles();
        glDepthFunc(GL_LESS);
    } else {
        triangles();
    }
}

}  // namespace tact
