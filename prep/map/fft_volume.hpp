// Fourier transforms of real volumes by FFTW, in single precision.
//
// Volume   x fastest; its transform has size[0] / 2 + 1 values along x. backward() does not divide by the number of voxels.
// Thread   construction and destruction: any, one at a time is ensured here. forward() and backward(): any, on buffers of
//          their own.
#pragma once

#include <fftw3.h>

#include <array>
#include <complex>
#include <cstddef>
#include <memory>
#include <span>

namespace tact {

struct FftFree {
    void operator()(void* memory) const { fftwf_free(memory); }
};
template <class T>
class FftBuffer {
public:
    explicit FftBuffer(std::size_t count)
        : data_(static_cast<T*>(fftwf_malloc(count * sizeof(T)))), count_(count) {
        if (data_ == nullptr) throw std::bad_alloc();
        std::fill_n(data_.get(), count, T{});
    }
    [[nodiscard]] T* data() const { return data_.get(); }
    [[nodiscard]] std::span<T> all() const { return {data_.get(), count_}; }

private:
    std::unique_ptr<T, FftFree> data_;
    std::size_t count_;
};

class FftVolume {
public:
    using Size = std::array<std::uint32_t, 3>;

    explicit FftVolume(const Size& size);
    ~FftVolume();
    FftVolume(const FftVolume&) = delete;
    FftVolume& operator=(const FftVolume&) = delete;

    // The smallest length of at least n that has only the factors 2, 3, 5 and 7.
    [[nodiscard]] static std::uint32_t quick_length(std::uint32_t n);

    [[nodiscard]] const Size& size() const { return size_; }
    [[nodiscard]] std::size_t voxels() const { return std::size_t{size_[0]} * size_[1] * size_[2]; }
    [[nodiscard]] std::size_t waves() const { return (std::size_t{size_[0]} / 2 + 1) * size_[1] * size_[2]; }

    void forward(const FftBuffer<float>& values, FftBuffer<std::complex<float>>& waves) const;
    // Destroys `waves`.
    void backward(FftBuffer<std::complex<float>>& waves, FftBuffer<float>& values) const;

private:
    Size size_;
    fftwf_plan forward_, backward_;
};

}  // namespace tact
