#include "gui/docking/body_list.hpp"

#include <algorithm>

namespace tact {
namespace {

Pose pose_of(const BodyPlace& place) {
    const double* const q = place.quat_model_body_xyzw;
    return {Vec3(place.pos_model_m), Quat(q[3], q[0], q[1], q[2]).normalized()};
}

}  // namespace

void BodyList::start(std::span<const Pose> homes) {
    structures_ = homes.size();
    bodies_.clear();
    for (std::size_t i = 0; i < std::min(homes.size(), kBodiesMax); ++i) {
        ShownBody body;
        body.id = static_cast<std::uint32_t>(i + 1);
        body.structure = static_cast<std::uint16_t>(i);
        body.newest = body.T_model_body = homes[i];
        bodies_.push_back(body);
    }
    active_ = bodies_.empty() ? std::nullopt : std::optional<std::size_t>(0);
}

void BodyList::follow(const BodiesTopic& topic) {
    before_.swap(bodies_);
    bodies_.clear();
    active_.reset();
    for (std::size_t i = 0; i < std::min<std::size_t>(topic.count, kBodiesMax); ++i) {
        const BodyPlace& place = topic.body[i];
        if (place.structure >= structures_) continue;
        const auto known = std::find_if(before_.begin(), before_.end(),
                                        [&](const ShownBody& b) { return b.id == place.id; });
        ShownBody body = known != before_.end() ? *known : ShownBody{};
        body.id = place.id;
        body.structure = place.structure;
        body.flags = place.flags;
        body.newest = pose_of(place);
        body.predictor.add(topic.taken_at_ns, body.newest);
        if (topic.active == i) active_ = bodies_.size();
        bodies_.push_back(body);
    }
}

void BodyList::follow(const ShapesTopic& topic) {
    for (ShownBody& body : bodies_) {
        const std::span<const float> bent = amplitudes_of(topic, body.id);
        body.amplitude_m.assign(bent.begin(), bent.end());
    }
}

void BodyList::forget_motion() {
    for (ShownBody& body : bodies_) {
        body.predictor.clear();
        body.amplitude_m.clear();
    }
}

void BodyList::predict(std::int64_t now_ns) {
    for (ShownBody& body : bodies_)
        body.T_model_body = body.predictor.known() ? body.predictor.at(now_ns) : body.newest;
}

void BodyList::set_hidden(std::uint32_t id, bool hidden) {
    for (ShownBody& body : bodies_)
        if (body.id == id) body.hidden = hidden;
}

const ShownBody* BodyList::find(std::uint32_t id) const {
    const auto found =
        std::find_if(bodies_.begin(), bodies_.end(), [id](const ShownBody& b) { return b.id == id; });
    return found == bodies_.end() ? nullptr : &*found;
}

}  // namespace tact
