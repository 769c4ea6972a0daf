// A region of shared memory: one writer, read-only maps everywhere else.
//
// Content    header (magic, build, layout hash, sizes, generation), then one R (ipc/topics/regions.hpp).
//            The writer fills it first; the ready mark is stored last, with release.
// Memory     an anonymous file (memfd) with sealed size (no shrink, no grow), so that no truncation can
//            kill a reader; F_SEAL_FUTURE_WRITE makes every later map read-only, enforced by the kernel
// Errors     a reader checks seals, size, magic, layout hash and ready mark; a refusal contains the value
//            found and the value expected
// Thread     create and map off the servo thread; content access per Latest and Ring
#pragma once

#include <cstdint>
#include <string>

namespace tact {

inline constexpr std::uint64_t kRegionMagic = 0x31304D4853544341ULL;

struct RegionIdentity {
    const char* name;
    std::uint64_t layout_hash;
    std::uint64_t bytes;           // of R
    std::uint64_t bytes_most = 0;  // above bytes: largest size that the writer may choose
};

class FileDescriptor {
public:
    FileDescriptor() = default;
    explicit FileDescriptor(int fd) : fd_(fd) {}
    FileDescriptor(FileDescriptor&& other) noexcept : fd_(other.fd_) { other.fd_ = -1; }
    FileDescriptor& operator=(FileDescriptor&& other) noexcept;
    ~FileDescriptor();
    [[nodiscard]] int get() const { return fd_; }
    [[nodiscard]] bool valid() const { return fd_ >= 0; }

private:
    int fd_ = -1;
};

// Untyped base; use OwnedRegion<R>, MappedRegion<R>, or the classes of a region with variable size.
class RegionMemory {
public:
    static RegionMemory create(const RegionIdentity& identity);  // throws StartupError
    static RegionMemory map(FileDescriptor fd, const RegionIdentity& identity,
                            std::string& refusal);  // empty(): refused
    RegionMemory() = default;
    RegionMemory(RegionMemory&& other) noexcept;
    RegionMemory& operator=(RegionMemory&& other) noexcept;
    ~RegionMemory();
    void mark_ready() noexcept;
    [[nodiscard]] bool empty() const { return base_ == nullptr; }
    [[nodiscard]] void* content() const;
    [[nodiscard]] std::uint64_t content_bytes() const;
    [[nodiscard]] std::uint64_t generation() const { return generation_; }
    [[nodiscard]] int fd() const { return fd_.get(); }

private:
    FileDescriptor fd_;
    void* base_ = nullptr;
    std::uint64_t bytes_ = 0;
    std::uint64_t generation_ = 0;  // random; unique among regions, also across reboots
};

template <class R>
constexpr RegionIdentity region_identity() {
    return {R::kName, R::Topics::hash() ^ sizeof(R), sizeof(R)};
}

template <class R>
class OwnedRegion {
public:
    OwnedRegion() : memory_(RegionMemory::create(region_identity<R>())) {}
    R* operator->() const { return static_cast<R*>(memory_.content()); }
    R& operator*() const { return *static_cast<R*>(memory_.content()); }
    void mark_ready() noexcept { memory_.mark_ready(); }
    [[nodiscard]] std::uint64_t generation() const { return memory_.generation(); }
    [[nodiscard]] int fd() const { return memory_.fd(); }

private:
    RegionMemory memory_;
};

template <class R>
class MappedRegion {
public:
    MappedRegion() = default;
    static MappedRegion map(FileDescriptor fd, std::string& refusal) {
        MappedRegion m;
        m.memory_ = RegionMemory::map(static_cast<FileDescriptor&&>(fd), region_identity<R>(), refusal);
        return m;
    }
    [[nodiscard]] bool empty() const { return memory_.empty(); }
    const R* operator->() const { return static_cast<const R*>(memory_.content()); }
    const R& operator*() const { return *static_cast<const R*>(memory_.content()); }
    [[nodiscard]] std::uint64_t generation() const { return memory_.generation(); }

private:
    RegionMemory memory_;
};

}  // namespace tact
