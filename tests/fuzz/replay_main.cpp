// Runs a fuzz target without a fuzzer: on given files (a crash that was found), or on its seeds, every truncation of
// them and random mutations. --seeds DIR writes the seeds for the fuzzer to start from.
#include <algorithm>
#include <chrono>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <random>
#include <string>

#include "tests/fuzz/fuzz.hpp"

namespace {

using tact::fuzz::Input;

constexpr int kMutations = 4000;
constexpr auto kTimeMax = std::chrono::seconds(5);  // sanitized builds on slow machines

Input read_file(const char* path) {
    std::ifstream in(path, std::ios::binary);
    const std::string text{std::istreambuf_iterator<char>(in), {}};
    const auto bytes = std::as_bytes(std::span(text));
    return {bytes.begin(), bytes.end()};
}

void write_seeds(const std::filesystem::path& folder, const std::vector<Input>& seeds) {
    std::filesystem::create_directories(folder);
    for (std::size_t i = 0; i < seeds.size(); ++i) {
        std::ofstream out(folder / ("seed-" + std::to_string(i)), std::ios::binary);
        out.write(reinterpret_cast<const char*>(seeds[i].data()),
                  static_cast<std::streamsize>(seeds[i].size()));
    }
}

// Flips bits, overwrites with special numbers, cuts, repeats and splices pieces: typical problems of binary
// readers.
Input mutated(Input input, const std::vector<Input>& seeds, std::mt19937_64& random) {
    const auto below = [&random](std::size_t n) {
        return n == 0 ? 0 : static_cast<std::size_t>(random() % n);
    };
    for (std::size_t step = 0, steps = 1 + below(4); step < steps; ++step) {
        const std::size_t at = below(input.size());
        switch (below(6)) {
            case 0:
                if (!input.empty()) input[at] ^= std::byte{1} << below(8);
                break;
            case 1: {
                constexpr std::uint64_t kTelling[] = {
                    0, 1, 0x7F, 0xFFFFFFFF, 0x80000000, ~0ULL, 0x7FF8000000000000, 1ULL << 40};
                const std::uint64_t word = kTelling[below(std::size(kTelling))];
                for (std::size_t i = 0; i < (std::size_t{1} << below(4)) && at + i < input.size(); ++i)
                    input[at + i] = static_cast<std::byte>(word >> (8 * i));
                break;
            }
            case 2:
                input.resize(at);
                break;
            case 3: {
                const Input piece(
                    input.begin() + static_cast<std::ptrdiff_t>(at),
                    input.begin() + static_cast<std::ptrdiff_t>(std::min(input.size(), at + below(64))));
                input.insert(input.begin() + static_cast<std::ptrdiff_t>(at), piece.begin(), piece.end());
                break;
            }
            case 4: {
                const Input& other = seeds[below(seeds.size())];
                const std::size_t from = below(other.size());
                for (std::size_t i = 0; i < 16 && at + i < input.size() && from + i < other.size(); ++i)
                    input[at + i] = other[from + i];
                break;
            }
            default:
                if (!input.empty()) input[at] = static_cast<std::byte>(random());
        }
    }
    return input;
}

}  // namespace

int main(int argc, char** argv) {
    const std::vector<Input> seeds = tact::fuzz::seeds();
    if (seeds.empty()) return std::puts("no seeds"), 1;
    if (argc == 3 && std::string(argv[1]) == "--seeds") return write_seeds(argv[2], seeds), 0;
    if (argc > 1) {
        for (int i = 1; i < argc; ++i) tact::fuzz::run(read_file(argv[i]));
        return 0;
    }
    const auto end = std::chrono::steady_clock::now() + kTimeMax;
    std::size_t runs = 0;
    for (const Input& seed : seeds) {
        if (!tact::fuzz::run(seed)) {
            std::printf("seed %zu is refused; fix it\n", static_cast<std::size_t>(&seed - seeds.data()));
            return 1;
        }
        const std::size_t stride = std::max<std::size_t>(1, seed.size() / 256);
        for (std::size_t size = 0; size < seed.size() && std::chrono::steady_clock::now() < end;
             size += stride, ++runs)
            tact::fuzz::run(std::span(seed).first(size));
    }
    std::mt19937_64 random(20261120);
    for (int i = 0; i < kMutations && std::chrono::steady_clock::now() < end; ++i, ++runs)
        tact::fuzz::run(mutated(seeds[random() % seeds.size()], seeds, random));
    std::printf("%zu inputs\n", runs + seeds.size());
    return 0;
}
