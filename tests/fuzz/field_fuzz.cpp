// A CSV of a potential field with arbitrary bytes: refused with a fix, or a complete regular grid of finite values that can be baked.
#include <cmath>

#include "prep/field/bake_field.hpp"
#include "prep/field/import_field.hpp"
#include "tests/fuzz/format_fuzz.hpp"

namespace tact::fuzz {

bool run(std::span<const std::byte> input) {
    return run_formats(input, 1, [](unsigned /*format*/, std::string_view text) {
        ImportedField field = import_field_csv(text, "fuzz.csv", 1e-3);
        const DensityGrid& grid = field.grid;
        require(grid.values.size() == grid.count() && grid.origin_m.allFinite());
        require((grid.spacing_m.array() > 0.0).all());
        for (const float v : grid.values) require(std::isfinite(v));
        if (grid.count() > 20'000) return;
        SceneWriter out;
        FieldInput bake;
        bake.grid = std::move(field.grid);
        const BakedField baked = bake_field(bake, out);
        require(std::isfinite(baked.field.force_n_m_per_unit) && baked.field.force_n_m_per_unit > 0.0);
    });
}

std::vector<Input> seeds() {
    std::string spatial = "x,y,z,phi\n", planar = "# a saddle\n";
    for (int z = 0; z < 4; ++z)
        for (int y = 0; y < 4; ++y)
            for (int x = 0; x < 4; ++x)
                spatial += std::to_string(x) + "," + std::to_string(y) + "," + std::to_string(z) + "," +
                           std::to_string(x * y - z) + "\n";
    for (int y = 0; y < 5; ++y)
        for (int x = 0; x < 5; ++x)
            planar +=
                std::to_string(x) + " " + std::to_string(y) + " " + std::to_string(x * x - y * y) + "\n";
    return {seed(0, spatial), seed(0, planar)};
}

}  // namespace tact::fuzz
