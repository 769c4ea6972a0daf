#include "ipc/scene/file/scene_meta.hpp"

#include <algorithm>
#include <cmath>
#include <cstring>

#include "ipc/scene/file/bytes.hpp"

namespace tact {
namespace {

constexpr SectionTag kNoteTag{'N', 'O', 'T', 'E'};
constexpr std::uint32_t kNoteVersion = 1;
constexpr std::size_t kNoteBytesMax = 1 << 20;

std::string where(const SceneFile& file) { return file.name() + ", section META"; }

}  // namespace

void write_meta(SceneWriter& out, const SceneMeta& meta, const std::string& note) {
    BytesOut bytes;
    bytes.put(meta);
    out.add(SceneMeta::kTag, SceneMeta::kVersion, 0, bytes.take());
    BytesOut text;
    text.put_all(std::span<const char>(note));
    out.add(kNoteTag, kNoteVersion, 0, text.take());
}

SceneMeta read_meta(const SceneFile& file) {
    BytesIn in(file.section(SceneMeta::kTag, SceneMeta::kVersion), where(file));
    const auto meta = in.get<SceneMeta>("meta");
    in.finish();
    const SceneKindRow* const row = find_scene_kind(meta.kind);
    if (row == nullptr) {
        std::string known;
        for (const SceneKindRow& k : scene_kinds())
            known += (known.empty() ? "" : ", ") + std::string(k.name) + " (" +
                     std::to_string(static_cast<std::uint32_t>(k.kind)) + ")";
        in.fail("kind is " + std::to_string(static_cast<std::uint32_t>(meta.kind)) + "; known kinds are " +
                known);
    }
    const auto within = [&](const char* field, double value, double low, double high) {
        if (!(value >= low && value <= high)) {
            in.fail(std::string(field) + " is " + std::to_string(value) + ", outside of the possible range");
        }
    };
    // Bounds are generous: a scene is between the size of an atom and that of a landscape, and numbers stay
    // far from overflow.
    within("world_per_model", meta.world_per_model, 1e-9, 1e12);
    for (const double c : meta.centre_model_m) within("centre_model_m", c, -1e6, 1e6);
    const MetaLimits& limits = row->limits;
    within("resolution_m", meta.resolution_m, limits.resolution_min_m, limits.resolution_max_m);
    within("energy_j_per_sigma", meta.energy_j_per_sigma, limits.energy_min_j, 1e6);
    within("map_sigma", meta.map_sigma, limits.map_sigma_min, 1e30);
    if (meta.body_count < limits.bodies_min || meta.body_count > limits.bodies_max) {
        in.fail("body_count is " + std::to_string(meta.body_count) + ", outside of " +
                std::to_string(limits.bodies_min) + " to " + std::to_string(limits.bodies_max));
    }
    within("map_mean", meta.map_mean, -1e30, 1e30);
    within("map_background", meta.map_background, -1e30, 1e30);
    within("contour", meta.contour, -1e30, 1e30);
    if (meta.body_count != file.count({'B', 'O', 'D', 'Y'})) {
        in.fail("body_count is " + std::to_string(meta.body_count) + " but the file has " +
                std::to_string(file.count({'B', 'O', 'D', 'Y'})) + " BODY sections");
    }
    const char* const end = meta.title + sizeof meta.title;
    const char* const zero = std::find(meta.title, end, '\0');
    if (zero == end) in.fail("title does not end with a zero byte");
    if (std::any_of(meta.title, zero,
                    [](char c) { return static_cast<unsigned char>(c) < 0x20 || c == 0x7f; })) {
        in.fail("title contains a control character");
    }
    for (const SectionTag& tag : row->sections) {
        if (file.count(tag) == 0)
            in.fail(std::string("kind is ") + row->name + ", but the file has no section " +
                    std::string(tag.data(), tag.size()));
    }
    return meta;
}

std::string read_note(const SceneFile& file) {
    const std::span<const std::byte> bytes = file.section(kNoteTag, kNoteVersion);
    BytesIn in(bytes, file.name() + ", section NOTE");
    if (bytes.size() > kNoteBytesMax)
        in.fail("it has " + std::to_string(bytes.size()) + " bytes, more than 1048576");
    std::string note(reinterpret_cast<const char*>(bytes.data()), bytes.size());
    // The note is printed on terminals, so escape sequences are refused.
    for (const char c : note) {
        if ((static_cast<unsigned char>(c) < 0x20 && c != '\n' && c != '\t') || c == 0x7f) {
            in.fail("the note contains a control character");
        }
    }
    return note;
}

}  // namespace tact
