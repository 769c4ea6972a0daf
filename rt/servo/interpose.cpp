// The interposers. They call libc's __libc_malloc and so on, and the real pthread_mutex_lock found with dlsym.
#include "rt/servo/rt_guard.hpp"

#ifndef TACT_SANITIZED

#include <dlfcn.h>
#include <pthread.h>

#include <atomic>
#include <cerrno>
#include <cstddef>

#include "ipc/base/rt.hpp"

extern "C" {

void* __libc_malloc(std::size_t) noexcept;
void* __libc_calloc(std::size_t, std::size_t) noexcept;
void* __libc_realloc(void*, std::size_t) noexcept;
void* __libc_memalign(std::size_t, std::size_t) noexcept;
void __libc_free(void*) noexcept;

void* malloc(std::size_t n) noexcept {
    if (tact::rt_section_depth != 0) [[unlikely]]
        tact::rt_guard::seen_allocation("malloc");
    return __libc_malloc(n);
}
void* calloc(std::size_t n, std::size_t size) noexcept {
    if (tact::rt_section_depth != 0) [[unlikely]]
        tact::rt_guard::seen_allocation("calloc");
    return __libc_calloc(n, size);
}
void* realloc(void* p, std::size_t n) noexcept {
    if (tact::rt_section_depth != 0) [[unlikely]]
        tact::rt_guard::seen_allocation("realloc");
    return __libc_realloc(p, n);
}
void free(void* p) noexcept {
    if (tact::rt_section_depth != 0) [[unlikely]]
        tact::rt_guard::seen_allocation("free");
    __libc_free(p);
}
void* memalign(std::size_t align, std::size_t n) noexcept {
    if (tact::rt_section_depth != 0) [[unlikely]]
        tact::rt_guard::seen_allocation("memalign");
    return __libc_memalign(align, n);
}
void* aligned_alloc(std::size_t align, std::size_t n) noexcept {
    if (tact::rt_section_depth != 0) [[unlikely]]
        tact::rt_guard::seen_allocation("aligned_alloc");
    return __libc_memalign(align, n);
}
int posix_memalign(void** out, std::size_t align, std::size_t n) noexcept {
    if (tact::rt_section_depth != 0) [[unlikely]]
        tact::rt_guard::seen_allocation("posix_memalign");
    if (align < sizeof(void*) || (align & (align - 1)) != 0) return EINVAL;
    void* const p = __libc_memalign(align, n);
    if (p == nullptr) return ENOMEM;
    *out = p;
    return 0;
}

using MutexLock = int (*)(pthread_mutex_t*);
static std::atomic<MutexLock> real_mutex_lock{nullptr};

// dlsym may itself call pthread_mutex_lock. Such a nested call returns without locking; it happens only at the
// first lock of the process, before a second thread exists.
int pthread_mutex_lock(pthread_mutex_t* mutex) noexcept {
    if (tact::rt_section_depth != 0) [[unlikely]]
        tact::rt_guard::seen_lock("pthread_mutex_lock");
    MutexLock real = real_mutex_lock.load(std::memory_order_relaxed);
    if (real == nullptr) {
        static thread_local bool looking = false;
        if (looking) return 0;
        looking = true;
        real = reinterpret_cast<MutexLock>(dlsym(RTLD_NEXT, "pthread_mutex_lock"));
        looking = false;
        real_mutex_lock.store(real, std::memory_order_relaxed);
    }
    return real(mutex);
}

}  // extern "C"

namespace tact::rt_guard {
// Call before a second thread exists: finds pthread_mutex_lock, so no servo cycle has to call dlsym.
bool install() noexcept {
    pthread_mutex_t probe = PTHREAD_MUTEX_INITIALIZER;
    pthread_mutex_lock(&probe);
    pthread_mutex_unlock(&probe);
    return true;
}
}  // namespace tact::rt_guard

#else

namespace tact::rt_guard {
bool install() noexcept { return false; }
}  // namespace tact::rt_guard

#endif
