// Memory    MAP_POPULATE on both sides: the servo thread reads the other process's region, and must not be
//           the first to access any of its pages
// Sealing   the writer maps first and seals afterwards, because F_SEAL_FUTURE_WRITE leaves existing maps
//           writable and forbids all later ones, also from a passed descriptor. F_SEAL_SEAL makes this
//           final: the checked state cannot change afterwards
// Number    a generation is 64 random bits from the kernel, so that neither a reboot nor a reused process
//           id can give two regions the same number
#include "ipc/shm/region.hpp"

#include <fcntl.h>
#include <sys/mman.h>
#include <sys/random.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <new>
#include <system_error>
#include <utility>

#include "ipc/base/error.hpp"
#include "ipc/shm/region_header.hpp"

namespace tact {
namespace {

#ifndef MFD_NOEXEC_SEAL
constexpr unsigned MFD_NOEXEC_SEAL = 0x0008U;  // Linux 6.3
#endif

constexpr int kSealsWanted = F_SEAL_SHRINK | F_SEAL_GROW | F_SEAL_FUTURE_WRITE | F_SEAL_SEAL;

int open_memory(const char* name) {
    const unsigned flags = MFD_CLOEXEC | MFD_ALLOW_SEALING;
    const int fd = memfd_create(name, flags | MFD_NOEXEC_SEAL);
    return fd >= 0 || errno != EINVAL ? fd : memfd_create(name, flags);  // kernels before 6.3
}

std::uint64_t new_generation() {
    std::uint64_t g = 0;
    while (g == 0) {
        if (getrandom(&g, sizeof g, 0) != static_cast<ssize_t>(sizeof g)) g = 0;
    }
    return g;
}

}  // namespace

FileDescriptor& FileDescriptor::operator=(FileDescriptor&& other) noexcept {
    std::swap(fd_, other.fd_);
    return *this;
}

FileDescriptor::~FileDescriptor() {
    if (fd_ >= 0) close(fd_);
}

RegionMemory RegionMemory::create(const RegionIdentity& identity) {
    const std::string attempt = std::string("create region ") + identity.name;
    const std::string fix = "free memory, or raise the limits of this process (ulimit -a)";
    const std::uint64_t bytes = kRegionHeaderBytes + identity.bytes;
    RegionMemory m;
    m.fd_ = FileDescriptor(open_memory(identity.name));
    if (!m.fd_.valid()) throw StartupError(attempt, "memfd_create: " + last_error(), fix);
    if (ftruncate(m.fd_.get(), static_cast<off_t>(bytes)) != 0)
        throw StartupError(attempt, "no " + std::to_string(bytes) + " bytes: " + last_error(), fix);
    void* const base =
        mmap(nullptr, bytes, PROT_READ | PROT_WRITE, MAP_SHARED | MAP_POPULATE, m.fd_.get(), 0);
    if (base == MAP_FAILED) throw StartupError(attempt, "mmap: " + last_error(), fix);
    m.base_ = base;
    m.bytes_ = bytes;
    if (fcntl(m.fd_.get(), F_ADD_SEALS, kSealsWanted) != 0)
        throw StartupError(attempt, "seals: " + last_error(), "run on Linux 5.1 or newer");
    m.generation_ = new_generation();
    auto* const header = new (base) SharedRegionHeader;  // zeroed, ready included
    header->fields.store(make_region_header(identity, m.generation_));
    return m;
}

RegionMemory RegionMemory::map(FileDescriptor fd, const RegionIdentity& identity, std::string& refusal) {
    const std::string region = std::string("region ") + identity.name + ": ";
    const auto refuse = [&](const std::string& why) {
        refusal = why;
        return RegionMemory{};
    };
    const int seals = fcntl(fd.get(), F_GET_SEALS);
    if (seals < 0) return refuse(region + "the received file is not sealed memory: " + last_error());
    if ((seals & kSealsWanted) != kSealsWanted)
        return refuse(region + "its seals are " + std::to_string(seals) + ", expected at least " +
                      std::to_string(kSealsWanted));
    struct stat status {};
    if (fstat(fd.get(), &status) != 0) return refuse(region + "fstat: " + last_error());
    const auto file_bytes = static_cast<std::uint64_t>(status.st_size);
    if (file_bytes < kRegionHeaderBytes)
        return refuse(region + "its file size is " + std::to_string(file_bytes) + ", expected " +
                      (identity.bytes_most > identity.bytes ? "at least " : "") +
                      std::to_string(kRegionHeaderBytes + identity.bytes));

    // Maps the header first: a file of another layout is refused by name and hash, not by its size.
    void* const head = mmap(nullptr, kRegionHeaderBytes, PROT_READ, MAP_SHARED, fd.get(), 0);
    if (head == MAP_FAILED) return refuse(region + "mmap: " + last_error());
    const auto* const shared = static_cast<const SharedRegionHeader*>(head);
    const std::uint64_t ready = shared->ready.load(std::memory_order_acquire);  // pairs with mark_ready()
    RegionHeader header;
    shared->fields.load(header);
    munmap(head, kRegionHeaderBytes);
    const std::string why = refuse_region_header(header, ready, file_bytes, identity);
    if (!why.empty()) return refuse(why);

    const std::uint64_t bytes = kRegionHeaderBytes + header.content_bytes;  // checked above, and sealed
    void* const base = mmap(nullptr, bytes, PROT_READ, MAP_SHARED | MAP_POPULATE, fd.get(), 0);
    if (base == MAP_FAILED) return refuse(region + "mmap: " + last_error());
    refusal.clear();
    RegionMemory m;
    m.fd_ = std::move(fd);
    m.base_ = base;
    m.bytes_ = bytes;
    m.generation_ = header.generation;
    return m;
}

RegionMemory::RegionMemory(RegionMemory&& other) noexcept { *this = std::move(other); }

RegionMemory& RegionMemory::operator=(RegionMemory&& other) noexcept {
    std::swap(fd_, other.fd_);
    std::swap(base_, other.base_);
    std::swap(bytes_, other.bytes_);
    std::swap(generation_, other.generation_);
    return *this;
}

RegionMemory::~RegionMemory() {
    if (base_ != nullptr) munmap(base_, bytes_);
}

void RegionMemory::mark_ready() noexcept {
    static_cast<SharedRegionHeader*>(base_)->ready.store(kRegionReady,
                                                         std::memory_order_release);  // pairs with map()
}

std::uint64_t RegionMemory::content_bytes() const { return bytes_ - kRegionHeaderBytes; }

void* RegionMemory::content() const { return static_cast<std::byte*>(base_) + kRegionHeaderBytes; }

}  // namespace tact
