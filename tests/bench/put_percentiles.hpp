// Adds percentiles to the report of a benchmark, with the keys before_p50_after, before_p99_after and so on.
#pragma once

#include <nlohmann/json.hpp>
#include <string>

#include "tests/bench/percentiles.hpp"

namespace tact::launch {

inline void put_percentiles(nlohmann::json& all, const std::string& before, const Percentiles& p,
                            const std::string& after = "") {
    all[before + "_p50" + after] = p.p50;
    all[before + "_p99" + after] = p.p99;
    all[before + "_p999" + after] = p.p999;
    all[before + "_max" + after] = p.max;
}

}  // namespace tact::launch
