// One quantity over hours in bounded memory: rings of bins that keep the least and the greatest value.
//
// Levels   bins of 50 ms, and four times as wide at each further level; 512 bins a level. A plot takes the
//          finest level that covers its window, so that a spike of one sample is still seen after twelve
//          hours.
// Memory   kLevels * kBins * 16 bytes, taken once.  Thread  one; plain arithmetic.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

namespace tact {

struct PlotBin {
    double t_s = 0.0;  // beginning of the bin
    double width_s = 0.0;
    float low = 0.0F, high = 0.0F;
};

class PlotSeries {
public:
    static constexpr std::size_t kBins = 512;
    static constexpr std::size_t kLevels = 8;  // 26 s, 102 s, 7 min, 27 min, 1.8 h, 7.3 h, 29 h, 116 h
    static constexpr double kFinest_s = 0.05;
    static constexpr std::size_t kFactor = 4;

    PlotSeries();
    // t_s must not fall; a value that is not finite, or a time that falls, is left out.
    void add(double t_s, double value);
    void clear();

    // Bins that reach into [begin_s, end_s], oldest first, at most kBins of them.
    void window(double begin_s, double end_s, std::vector<PlotBin>& out) const;
    [[nodiscard]] bool empty() const { return last_t_s_ < 0.0; }
    [[nodiscard]] float last() const { return last_; }
    [[nodiscard]] std::size_t memory_bytes() const { return kLevels * kBins * sizeof(Bin); }

private:
    struct Bin {
        std::int64_t number = -1;  // which bin of its level since time 0; -1: empty
        float low = 0.0F, high = 0.0F;
    };
    [[nodiscard]] static double width_s(std::size_t level);
    std::vector<Bin> bins_;  // level after level
    double last_t_s_ = -1.0;
    float last_ = 0.0F;
};

}  // namespace tact
