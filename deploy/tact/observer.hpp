// Read-only access to the published state of a controller.
//
// The region stays mapped, so that the last values remain readable after the controller ended, however it ended.
// Hostile   every value may be anything; texts are bounded here, numbers by the users.
#pragma once

#include <optional>
#include <string>

#include "ipc/shm/link.hpp"
#include "ipc/topics/regions.hpp"

namespace tact::launch {

class Observer {
public:
    explicit Observer(const std::string& session);  // throws StartupError for a bad session name

    enum class News { none, arrived, left };
    News poll();  // never blocks
    [[nodiscard]] bool seen() const {
        return !region_.empty();
    }  // a region is readable, of a running or ended controller
    [[nodiscard]] bool attached() const { return link_.attached(); }
    [[nodiscard]] bool reached() const { return link_.reached(); }  // a process serves the session
    [[nodiscard]] const RtRegion& region() const { return *region_; }
    [[nodiscard]] std::uint64_t generation() const { return region_.generation(); }
    [[nodiscard]] std::string status_text() const;  // reason for waiting, or for rejecting a region

private:
    LinkClient link_;
    MappedRegion<RtRegion> region_;
    std::string refusal_;
};

template <class T>
std::optional<T> newest(const Latest<T>& topic) {
    T value{};
    if (!topic.read(value)) return std::nullopt;
    return value;
}

// Text of a fixed field, printable ASCII only.
std::string field_text(const char* field, std::size_t size);

// The level of one path, by name.
std::optional<PathLevel> level_of(const LevelsTopic& levels, const char* path);
// The level at an index: kDisplayPathIndex and the like.
std::optional<PathLevel> level_at(const LevelsTopic& levels, std::size_t index);

}  // namespace tact::launch
