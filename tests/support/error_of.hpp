// The text of a call's StartupError, or "" without one.
#pragma once

#include <string>
#include <utility>

#include "ipc/base/error.hpp"

namespace tact::sample {

template <class Call>
std::string error_of(Call&& call) {
    try {
        std::forward<Call>(call)();
    } catch (const StartupError& error) {
        return error.what();
    }
    return {};
}

}  // namespace tact::sample
