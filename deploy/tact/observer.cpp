#include "deploy/tact/observer.hpp"

#include <algorithm>
#include <cstring>

namespace tact::launch {

Observer::Observer(const std::string& session) : link_(session, -1) {}

Observer::News Observer::poll() {
    LinkClient::News news = link_.poll();
    if (news.arrived) {
        auto mapped = MappedRegion<RtRegion>::map(std::move(news.rt_fd), refusal_);
        if (mapped.empty()) return News::none;
        region_ = std::move(mapped);
        refusal_.clear();
        return News::arrived;
    }
    return news.left ? News::left : News::none;
}

std::string Observer::status_text() const { return refusal_.empty() ? link_.status_text() : refusal_; }

std::string field_text(const char* field, std::size_t size) {
    std::string text(field, strnlen(field, size));
    std::replace_if(
        text.begin(), text.end(), [](char c) { return c < ' ' || c > '~'; }, '?');
    return text;
}

std::optional<PathLevel> level_of(const LevelsTopic& levels, const char* path) {
    const std::size_t count = std::min<std::size_t>(levels.count, kPathsMax);
    for (std::size_t i = 0; i < count; ++i)
        if (std::strncmp(levels.path[i].path, path, kPathNameMax) == 0) return levels.path[i];
    return std::nullopt;
}

std::optional<PathLevel> level_at(const LevelsTopic& levels, std::size_t index) {
    if (std::min<std::size_t>(levels.count, kPathsMax) <= index) return std::nullopt;
    return levels.path[index];
}

}  // namespace tact::launch
