// Maps from anywhere. The first byte selects the format. An accepted map has a consistent grid and finite values.
#include <cmath>
#include <string>

#include "prep/map/import_map.hpp"
#include "tests/fuzz/format_fuzz.hpp"
#include "tests/unit/prep_samples.hpp"

namespace tact::fuzz {
namespace {

enum Kind : unsigned char { kMrc, kSitus, kKinds };

void use(const DensityGrid& grid) {
    require(grid.values.size() == grid.count() && !grid.values.empty());
    require(grid.origin_m.allFinite() && (grid.spacing_m.array() > 0.0).all());
    for (const float v : grid.values) require(std::isfinite(v));
}

}  // namespace

bool run(std::span<const std::byte> input) {
    return run_formats(input, kKinds, [](unsigned kind, std::string_view text) {
        const bool mrc = kind == kMrc;
        use(import_map_bytes({text.begin(), text.end()}, mrc ? "fuzz.mrc" : "fuzz.situs",
                             mrc ? ".mrc" : ".situs")
                .grid);
    });
}

std::vector<Input> seeds() {
    std::vector<Input> all;
    for (const int mode : {0, 1, 2, 6}) {
        sample::Mrc mrc;
        mrc.mode = mode;
        mrc.big_endian = mode == 1;
        mrc.axes = mode == 6 ? std::array<int, 3>{3, 1, 2} : mrc.axes;
        const std::vector<char> bytes = mrc.bytes();
        all.push_back(seed(kMrc, std::string(bytes.begin(), bytes.end())));
    }
    sample::Mrc skew;
    skew.angles = {90.0F, 90.0F, 120.0F};
    const std::vector<char> bytes = skew.bytes();
    all.push_back(seed(kMrc, std::string(bytes.begin(), bytes.end())));
    std::string situs = "2.5 -10.0 0.0 5.0 4 5 4\n\n";
    for (int i = 0; i < 80; ++i) situs += std::to_string(i % 7) + (i % 10 == 9 ? ".5\n" : ".25 ");
    all.push_back(seed(kSitus, situs));
    return all;
}

}  // namespace tact::fuzz
