// Properties of a topic. The layout hash of a region is computed from these rows.
#pragma once

#include <cstddef>
#include <cstdint>

namespace tact {

enum class Writer : std::uint8_t { rt, gui };

struct TopicInfo {
    const char* name;
    std::uint32_t version;
    Writer writer;
};

}  // namespace tact
