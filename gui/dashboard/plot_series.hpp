// One quantity over hours in bounded memory: rings of bins that keep minimum and maximum.
//
// Levels   bins of 50 ms, four times as wide at each further level; 512 bins per level. A plot uses the finest level
//          that covers its window, so a spike of one sample stays visible after twelve hours.
// Memory   kLevels * kBins * 16 bytes, allocated once.  Thread  one; plain arithmetic.
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
    // t_s must not fall; a falling time and a non-finite value are ignored.
    void add(double t_s, double value);
    void clear();

    // Bins that overlap [begin_s, end_s], oldest first, at most kBins of them.
    void window(double begin_s, double end_s, std::vector<PlotBin>& out) const;
    [[nodiscard]] bool empty() const { return last_t_s_ < 0.0; }
    [[nodiscard]] float last() const { return last_; }
    [[nodiscard]] std::size_t memory_bytes() const { return kLevels * kBins * sizeof(Bin); }

private:
    struct Bin {
        std::int64_t number = -1;  // of the bin in its level since time 0; -1: empty
        float low = 0.0F, high = 0.0F;
    };
    [[nodiscard]] static double width_s(std::size_t level);
    std::vector<Bin> bins_;  // level after level
    double last_t_s_ = -1.0;
    float last_ = 0.0F;
};

}  // namespace tact
