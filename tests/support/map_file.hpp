// Writes a density grid in the format of a map file, as input of tact-prep in tests and experiments.
#pragma once

#include <array>
#include <cstdint>
#include <cstring>
#include <string>

#include "ipc/base/units.hpp"
#include "ipc/scene/density/density_map.hpp"

namespace tact {

// Mode 2 (float) of MRC 2014.
inline std::string map_file_bytes(const DensityGrid& grid) {
    std::array<std::int32_t, 256> header{};
    const auto put_float = [&header](std::size_t word, double value) {
        const auto f = static_cast<float>(value);
        std::memcpy(&header[word], &f, sizeof f);
    };
    for (std::size_t i = 0; i < 3; ++i) {
        header[i] = static_cast<std::int32_t>(grid.size[i]);
        header[7 + i] = header[i];  // one voxel of the cell for each
        put_float(10 + i, grid.spacing_m[static_cast<Eigen::Index>(i)] / kAngstromM * grid.size[i]);
        put_float(13 + i, 90.0);
        header[16 + i] = static_cast<std::int32_t>(i + 1);
        put_float(49 + i, grid.origin_m[static_cast<Eigen::Index>(i)] / kAngstromM);
    }
    header[3] = 2;
    header[22] = 1;
    std::memcpy(&header[52], "MAP ", 4);
    header[53] = 0x00004144;  // little endian
    std::string bytes(reinterpret_cast<const char*>(header.data()), sizeof header);
    bytes.append(reinterpret_cast<const char*>(grid.values.data()), grid.values.size() * sizeof(float));
    return bytes;
}

}  // namespace tact
