#include "prep/map/fft_volume.hpp"

#include <mutex>
#include <new>
#include <stdexcept>

namespace tact {
namespace {

// FFTW makes and destroys plans on one thread at a time.
std::mutex& planner() {
    static std::mutex mutex;
    return mutex;
}

fftwf_complex* raw(const FftBuffer<std::complex<float>>& waves) {
    return reinterpret_cast<fftwf_complex*>(waves.data());
}

}  // namespace

std::uint32_t FftVolume::quick_length(std::uint32_t n) {
    for (;; ++n) {
        std::uint32_t rest = n;
        for (const std::uint32_t factor : {2U, 3U, 5U, 7U})
            while (rest > 0 && rest % factor == 0) rest /= factor;
        if (rest == 1) return n;
    }
}

FftVolume::FftVolume(const Size& size) : size_(size) {
    const FftBuffer<float> values(voxels());
    const FftBuffer<std::complex<float>> transformed(waves());
    const std::lock_guard lock(planner());
    const auto z = static_cast<int>(size[2]), y = static_cast<int>(size[1]), x = static_cast<int>(size[0]);
    forward_ = fftwf_plan_dft_r2c_3d(z, y, x, values.data(), raw(transformed), FFTW_ESTIMATE);
    backward_ = fftwf_plan_dft_c2r_3d(z, y, x, raw(transformed), values.data(), FFTW_ESTIMATE);
    if (forward_ == nullptr || backward_ == nullptr) throw std::bad_alloc();
}

FftVolume::~FftVolume() {
    const std::lock_guard lock(planner());
    fftwf_destroy_plan(forward_);
    fftwf_destroy_plan(backward_);
}

void FftVolume::forward(const FftBuffer<float>& values, FftBuffer<std::complex<float>>& waves) const {
    fftwf_execute_dft_r2c(forward_, values.data(), raw(waves));
}

void FftVolume::backward(FftBuffer<std::complex<float>>& waves, FftBuffer<float>& values) const {
    fftwf_execute_dft_c2r(backward_, raw(waves), values.data());
}

}  // namespace tact
