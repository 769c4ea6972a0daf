// One block of memory, taken at start-up, handed out once, then sealed.
//
// The servo path's working memory comes from here, so that it lies together, is locked and is touched
// before the loop starts. Construction may throw; take() after seal() is a programming error and throws
// too, which is safe because only start-up code calls it.
#pragma once

#include <cstddef>
#include <memory>
#include <span>
#include <stdexcept>
#include <type_traits>

namespace tact {

class Arena {
public:
    explicit Arena(std::size_t bytes)
        : size_(bytes), block_(new (std::align_val_t{kAlign}) std::byte[bytes]{}) {}

    // Elements are value-initialized and never destroyed.
    template <class T>
    [[nodiscard]] std::span<T> take(std::size_t count) {
        static_assert(std::is_trivially_destructible_v<T> && alignof(T) <= kAlign);
        if (sealed_) throw std::logic_error("arena: take after seal");
        const std::size_t begin = (used_ + kAlign - 1) / kAlign * kAlign;
        if (begin > size_ || count > (size_ - begin) / sizeof(T)) throw std::bad_alloc();
        used_ = begin + count * sizeof(T);
        T* const first = reinterpret_cast<T*>(block_.get() + begin);
        std::uninitialized_value_construct_n(first, count);
        return {first, count};
    }
    void seal() noexcept { sealed_ = true; }
    [[nodiscard]] bool sealed() const noexcept { return sealed_; }
    [[nodiscard]] std::size_t used() const noexcept { return used_; }

private:
    static constexpr std::size_t kAlign = 64;
    struct Free {
        void operator()(std::byte* p) const noexcept { ::operator delete[](p, std::align_val_t{kAlign}); }
    };
    std::size_t size_;
    std::size_t used_ = 0;
    bool sealed_ = false;
    std::unique_ptr<std::byte[], Free> block_;
};

}  // namespace tact
