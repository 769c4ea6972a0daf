// What a controller says of itself, seen from outside: a link that only watches.
//
// The region stays mapped, so that the last values can still be read after the controller ended, however it
// ended. Hostile  every value may be anything; texts are bounded here, numbers by those who use them.
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
    }  // there is a region to read, of now or of before
    [[nodiscard]] bool attached() const { return link_.attached(); }
    [[nodiscard]] bool reached() const { return link_.reached(); }  // somebody serves the session
    [[nodiscard]] const RtRegion& region() const { return *region_; }
    [[nodiscard]] std::uint64_t generation() const { return region_.generation(); }
    [[nodiscard]] std::string status_text() const;  // what it waits for, or why a region was refused

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
// By its place: kDisplayPathIndex and the like.
std::optional<PathLevel> level_at(const LevelsTopic& levels, std::size_t index);

}  // namespace tact::launch
