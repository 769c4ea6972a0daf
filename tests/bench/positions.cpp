#include "tests/bench/positions.hpp"

#include <fstream>
#include <sstream>

#include "ipc/base/error.hpp"

namespace tact::launch {
namespace {
constexpr std::size_t kPathMax = 10'000'000;
}

std::vector<Vec3> read_positions(const std::filesystem::path& file, double unit_m) {
    const std::string attempt = "reading the positions in " + file.string();
    std::ifstream in(file);
    if (!in) throw StartupError(attempt, "the file cannot be read", "check the path");
    std::vector<Vec3> path;
    std::string line;
    std::size_t number = 0;
    while (std::getline(in, line)) {
        ++number;
        if (line.empty() || line.front() == '#') continue;
        Vec3 p;
        std::istringstream fields(line);
        if (!(fields >> p.x() >> p.y() >> p.z()) || !p.allFinite() || path.size() == kPathMax)
            throw StartupError(attempt, "line " + std::to_string(number) + " is not a position",
                               "write x y z on each line, at most ten million lines");
        path.emplace_back(unit_m * p);
    }
    return path;
}

}  // namespace tact::launch
