#include "prep/field/report_field.hpp"

#include <nlohmann/json.hpp>

#include "ipc/scene/field/field.hpp"

namespace tact {

void report_field(const SceneFile& file, nlohmann::ordered_json& json) {
    const FieldMeta f = read_field_meta(file);
    json["field"] = {{"low", f.low},
                     {"high", f.high},
                     {"unit", f.unit},
                     {"force_n_m_per_unit", f.force_n_m_per_unit},
                     {"force_n_max", f.force_n_max},
                     {"stiffness_n_m", f.stiffness_n_m},
                     {"probe_radius_m", f.probe_radius_m}};
}

}  // namespace tact
