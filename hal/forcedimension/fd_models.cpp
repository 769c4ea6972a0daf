#include "hal/forcedimension/fd_models.hpp"

#include <array>

namespace tact::fd {

namespace {

constexpr std::array kModels{
    Model{33, "omega.3", 12.0, 0.0, 5000.0, 0.075, 1e-5, {0.0, 0.0, 0.0}},
    Model{34, "omega.6", 12.0, 0.0, 5000.0, 0.075, 1e-5, {0.0, 0.0, 0.0}},
    Model{36, "omega.6, left-handed", 12.0, 0.0, 5000.0, 0.075, 1e-5, {0.0, 0.0, 0.0}},
    Model{35, "omega.7", 12.0, 0.0, 5000.0, 0.075, 1e-5, {0.0, 0.0, 0.0}},
    Model{37, "omega.7, left-handed", 12.0, 0.0, 5000.0, 0.075, 1e-5, {0.0, 0.0, 0.0}},
    Model{63, "delta.3", 20.0, 0.0, 5000.0, 0.150, 3e-5, {0.0, 0.0, 0.0}},
    Model{206, "sigma.3", 12.0, 0.0, 4000.0, 0.075, 1e-5, {0.0, 0.0, 0.0}},
    Model{104, "sigma.7", 12.0, 0.2, 4000.0, 0.075, 1e-5, {0.01, -0.02, 0.0}},
    Model{105, "sigma.7, left-handed", 12.0, 0.2, 4000.0, 0.075, 1e-5, {0.01, 0.02, 0.0}},
    Model{203, "lambda.3", 12.0, 0.0, 4000.0, 0.075, 1e-5, {0.0, 0.0, 0.0}},
    Model{108, "lambda.7", 12.0, 0.2, 4000.0, 0.075, 1e-5, {0.0, 0.0, 0.0}},
    Model{109, "lambda.7, left-handed", 12.0, 0.2, 4000.0, 0.075, 1e-5, {0.0, 0.0, 0.0}},
};

}  // namespace

const Model* model(int type) noexcept {
    for (const Model& m : kModels)
        if (m.type == type) return &m;
    return nullptr;
}

}  // namespace tact::fd
