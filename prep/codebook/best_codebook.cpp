#include "prep/codebook/best_codebook.hpp"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <future>
#include <thread>

namespace tact {
namespace {

std::vector<LevelQuality> quality_of(const std::vector<Codebook>& all) {
    std::vector<LevelQuality> quality(all.front().levels.size());
    const auto n = static_cast<double>(all.size());
    for (std::size_t l = 0; l < quality.size(); ++l) {
        double mean = 0.0, squares = 0.0;
        for (const Codebook& c : all) mean += c.levels[l].rms_error_m / n;
        for (const Codebook& c : all) squares += std::pow(c.levels[l].rms_error_m - mean, 2.0);
        quality[l].rms_error_mean_m = mean;
        quality[l].rms_error_sd_m = all.size() > 1 ? std::sqrt(squares / (n - 1.0)) : 0.0;
    }
    return quality;
}

double mean_share(const Codebook& c, const std::vector<LevelQuality>& quality) {
    double sum = 0.0;
    for (std::size_t l = 0; l < quality.size(); ++l)
        sum +=
            quality[l].rms_error_mean_m > 0.0 ? c.levels[l].rms_error_m / quality[l].rms_error_mean_m : 1.0;
    return sum;
}

}  // namespace

std::uint32_t codebook_restarts(std::size_t atoms) {
    if (atoms > 200'000) return 1;
    return atoms > 50'000 ? 2 : 4;
}

BestCodebook best_codebook(const Structure& structure, const CodebookSettings& settings,
                           const Progress& progress) {
    BestCodebook best;
    best.restarts = codebook_restarts(structure.size());
    std::vector<Codebook> all(best.restarts);
    std::atomic<bool> stop{false};
    std::atomic<std::uint32_t> next{1};  // this thread computes codebook 0 and reports progress
    // Worker threads compute the remaining codebooks one by one; `stop` ends each at its next level.
    const auto work = [&] {
        try {
            for (std::uint32_t i = next++; i < best.restarts; i = next++) {
                CodebookSettings own = settings;
                own.seed = settings.seed + i;
                all[i] = build_codebook(structure, own, [&](double, const char*) { return !stop.load(); });
            }
        } catch (const Cancelled&) {  // the calling thread rethrows the cause
        }
    };
    std::vector<std::future<void>> others;
    const std::uint32_t cores = std::max(1U, std::thread::hardware_concurrency());
    for (std::uint32_t i = 1; i < std::min(cores, best.restarts); ++i)
        others.push_back(std::async(std::launch::async, work));
    try {
        all[0] = build_codebook(structure, settings, [&](double fraction, const char* what) {
            return !progress || progress(0.5 * fraction, what);
        });
        for (std::uint32_t i = next++; i < best.restarts; i = next++) {
            CodebookSettings own = settings;
            own.seed = settings.seed + i;
            all[i] = build_codebook(
                structure, own, [&](double, const char* what) { return !progress || progress(0.75, what); });
        }
    } catch (...) {
        stop = true;
        for (auto& other : others) other.wait();
        throw;
    }
    for (auto& other : others) other.get();
    report(progress, 1.0, "codebook");
    best.quality = quality_of(all);
    std::size_t chosen = 0;
    for (std::size_t i = 1; i < all.size(); ++i)
        if (mean_share(all[i], best.quality) < mean_share(all[chosen], best.quality)) chosen = i;
    best.codebook = std::move(all[chosen]);
    for (std::size_t l = 0; l < best.quality.size(); ++l)
        best.quality[l].rms_error_m = best.codebook.levels[l].rms_error_m;
    return best;
}

}  // namespace tact
