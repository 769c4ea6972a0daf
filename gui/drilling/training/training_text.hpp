// Words and numbers that page, table and JSON of a training session share.
//
// Thread   any
#pragma once

#include <cstdio>
#include <nlohmann/json.hpp>
#include <string>

#include "gui/drilling/training/training_score.hpp"

namespace tact {

inline const char* state_name(TrainingItem::State state) {
    switch (state) {
        case TrainingItem::State::done:
            return "done";
        case TrainingItem::State::failed:
            return "failed";
        case TrainingItem::State::open:
            break;
    }
    return "open";
}

inline std::string rounded(double value, int digits) {
    char text[40];
    std::snprintf(text, sizeof text, "%.*f", digits, value);
    return text;
}

// 0 where it is missing or no number.
inline double number(const nlohmann::json& j, const char* key) {
    return j.is_object() && j.contains(key) && j[key].is_number() ? j[key].get<double>() : 0.0;
}

}  // namespace tact
