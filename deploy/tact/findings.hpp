// Output of the findings of `tact doctor` and `tact probe`.
#pragma once

#include <nlohmann/json.hpp>
#include <vector>

#include "deploy/tact/doctor.hpp"

namespace tact::launch {

[[nodiscard]] bool none_fails(const std::vector<Finding>& findings);
[[nodiscard]] nlohmann::json findings_json(const std::vector<Finding>& findings);  // an array of objects
void print_findings(const std::vector<Finding>& findings);

}  // namespace tact::launch
