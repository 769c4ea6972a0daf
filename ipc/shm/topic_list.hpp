// The topics of a region as a list of types, and the layout hash that both sides compare.
#pragma once

#include <cstdint>
#include <string_view>

#include "ipc/shm/topic.hpp"

namespace tact {

template <class... T>
struct TopicList {
    // FNV-1a over name, version, size and alignment of every topic, in order.
    static constexpr std::uint64_t hash() noexcept {
        std::uint64_t h = 14695981039346656037ULL;
        const auto byte = [&h](std::uint64_t b) { h = (h ^ (b & 0xFFU)) * 1099511628211ULL; };
        const auto word = [&byte](std::uint64_t w) {
            for (int i = 0; i < 8; ++i) byte(w >> (8 * i));
        };
        const auto topic = [&](const TopicInfo& info, std::uint64_t size, std::uint64_t align) {
            for (const char c : std::string_view(info.name)) byte(static_cast<unsigned char>(c));
            word(info.version);
            word(size);
            word(align);
        };
        (topic(T::kInfo, sizeof(T), alignof(T)), ...);
        return h;
    }
};

}  // namespace tact
