#include "ipc/scene/field/field.hpp"

#include <algorithm>

#include "ipc/scene/file/bytes.hpp"

namespace tact {

void write_field_meta(SceneWriter& out, const FieldMeta& field) {
    BytesOut bytes;
    bytes.put(field);
    out.add(FieldMeta::kTag, FieldMeta::kVersion, 0, bytes.take());
}

FieldMeta read_field_meta(const SceneFile& file) {
    BytesIn in(file.section(FieldMeta::kTag, FieldMeta::kVersion), file.name() + ", section FPOT");
    const auto f = in.get<FieldMeta>("field");
    in.finish();
    const auto within = [&](const char* what, double value, double low, double high) {
        if (!(value >= low && value <= high))
            in.fail(std::string(what) + " is " + std::to_string(value) + ", outside the possible range");
    };
    for (int a = 0; a < 3; ++a) {
        within("box_low_m", f.box_low_m[a], -1e6, 1e6);
        within("box_high_m", f.box_high_m[a], -1e6, 1e6);
        if (!(f.box_low_m[a] < f.box_high_m[a])) in.fail("its box has no volume");
    }
    within("mean", f.mean, -1e38, 1e38);
    within("deviation", f.deviation, 1e-38, 1e38);
    within("low", f.low, -1e38, 1e38);
    within("high", f.high, f.low, 1e38);
    within("force_n_m_per_unit", f.force_n_m_per_unit, 1e-45, 1e45);
    within("force_n_max", f.force_n_max, 0.0, 100.0);
    within("stiffness_n_m", f.stiffness_n_m, 0.0, 1e5);
    within("probe_radius_m", f.probe_radius_m, 0.0, 1e6);
    const char* const end = f.unit + sizeof f.unit;
    const char* const zero = std::find(f.unit, end, '\0');
    if (zero == end) in.fail("the unit does not end with a zero byte");
    if (std::any_of(f.unit, zero, [](char c) { return static_cast<unsigned char>(c) < 0x20 || c == 0x7f; }))
        in.fail("the unit contains a control character");
    return f;
}

}  // namespace tact
