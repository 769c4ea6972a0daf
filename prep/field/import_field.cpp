#include "prep/field/import_field.hpp"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <limits>

#include "ipc/base/error.hpp"
#include "prep/input/read_file.hpp"
#include "prep/volume/raw_scan.hpp"

namespace tact {
namespace {

constexpr std::uint64_t kCsvBytesMax = std::uint64_t{2} << 30;
constexpr std::uint64_t kPointsMax = std::uint64_t{1} << 26;
// Relative to the step: files often write coordinates with three digits.
constexpr double kStepTolerance = 0.02;

[[noreturn]] void fail(const std::string& name, const std::string& why, const std::string& fix) {
    throw StartupError("read field " + name, why, fix);
}

struct Point {
    double x, y, z, value;
};

bool separates(char c) { return c == ',' || c == ';' || c == '\t' || c == ' ' || c == '\r'; }

// Parses the numbers of a line and returns their count, or -1 if a word is not a number.
int numbers_of(std::string_view line, std::array<double, 5>& number) {
    int count = 0;
    std::size_t at = 0;
    while (true) {
        while (at < line.size() && separates(line[at])) ++at;
        if (at == line.size()) return count;
        std::size_t end = at;
        while (end < line.size() && !separates(line[end])) ++end;
        if (count == static_cast<int>(number.size())) return count + 1;
        std::string_view word = line.substr(at, end - at);
        if (word.front() == '+') word.remove_prefix(1);
        double value = 0.0;
        const auto [last, error] = std::from_chars(word.data(), word.data() + word.size(), value);
        if (error == std::errc::result_out_of_range) value = std::numeric_limits<double>::infinity();
        if ((error != std::errc() && error != std::errc::result_out_of_range) ||
            last != word.data() + word.size())
            return -1;
        number[static_cast<std::size_t>(count++)] = value;
        at = end;
    }
}

std::vector<Point> points_of(std::string_view text, const std::string& name, bool& planar) {
    std::vector<Point> points;
    int columns = 0;
    std::size_t line_number = 0;
    while (!text.empty()) {
        const std::size_t end = std::min(text.find('\n'), text.size());
        const std::string_view line = text.substr(0, end);
        text.remove_prefix(std::min(end + 1, text.size()));
        ++line_number;
        std::array<double, 5> number{};
        const std::size_t first = line.find_first_not_of(" \t\r");
        if (first == std::string_view::npos || line[first] == '#') continue;
        const int count = numbers_of(line, number);
        const std::string where = name + ", line " + std::to_string(line_number);
        if (count < 0) {
            if (points.empty() && columns == 0) continue;  // header line
            fail(where, "the line holds a word that is not a number",
                 "write numbers with a decimal point, separated by commas or spaces");
        }
        if (columns == 0) columns = count;
        if (count != columns || (count != 3 && count != 4))
            fail(where, "the line has " + std::to_string(count) + " numbers",
                 "write x y z value, or x y value, on every line");
        const Point p = count == 4 ? Point{number[0], number[1], number[2], number[3]}
                                   : Point{number[0], number[1], 0.0, number[2]};
        if (!std::isfinite(p.x) || !std::isfinite(p.y) || !std::isfinite(p.z) || !std::isfinite(p.value))
            fail(where, "a number is not finite", "replace the number by a finite value");
        if (points.size() == kPointsMax)
            fail(where, "the file has more than " + std::to_string(kPointsMax) + " points",
                 "give a coarser grid");
        points.push_back(p);
    }
    planar = columns == 3;
    return points;
}

struct Axis {
    double low = 0.0, step = 0.0;
    std::uint32_t count = 0;
};

// The grid axis through all values of one coordinate.
Axis axis_of(const std::vector<Point>& points, double Point::*coordinate, char letter,
             const std::string& name) {
    std::vector<double> values(points.size());
    std::transform(points.begin(), points.end(), values.begin(),
                   [&](const Point& p) { return p.*coordinate; });
    std::sort(values.begin(), values.end());
    const double span = values.back() - values.front();
    if (span <= 0.0) return {values.front(), 0.0, 1};
    // Values closer than a thousandth of the mean step of the finest grid are one grid position.
    const double same = 1e-3 * span / kFieldPointsMax;
    std::vector<double> places{values.front()};
    for (const double v : values) {
        if (v - places.back() <= same) continue;
        places.push_back(v);
        if (places.size() > kFieldPointsMax)
            fail(name,
                 std::string("axis ") + letter + " has more than " + std::to_string(kFieldPointsMax) +
                     " different coordinates",
                 "give a regular grid of at most 512 points along each axis");
    }
    const auto count = static_cast<std::uint32_t>(places.size());
    const double step = span / (count - 1.0);
    for (std::uint32_t i = 0; i < count; ++i) {
        const double wanted = places.front() + step * i;
        if (std::abs(places[i] - wanted) > kStepTolerance * step)
            fail(name, std::string("axis ") + letter + " has unequal steps near " + std::to_string(places[i]),
                 "interpolate the values onto a regular grid");
    }
    return {places.front(), step, count};
}

void check_counts(const DensityGrid& grid, const std::string& name) {
    for (std::size_t a = 0; a < 3; ++a)
        if (grid.size[a] < kFieldPointsMin || grid.size[a] > kFieldPointsMax)
            fail(name, std::string("axis ") + "xyz"[a] + " has " + std::to_string(grid.size[a]) + " points",
                 "give " + std::to_string(kFieldPointsMin) + " to " + std::to_string(kFieldPointsMax) +
                     " points along each axis");
}

// Extends one layer to a box as deep as its shorter side; the potential is the same at every z.
void continue_along_z(DensityGrid& grid) {
    const double side_m =
        std::min((grid.size[0] - 1.0) * grid.spacing_m.x(), (grid.size[1] - 1.0) * grid.spacing_m.y());
    constexpr std::uint32_t kLayers = 8;
    grid.size[2] = kLayers;
    grid.spacing_m.z() = side_m / (kLayers - 1.0);
    grid.origin_m.z() -= 0.5 * side_m;
    const std::size_t layer = grid.values.size();
    grid.values.resize(layer * kLayers);
    for (std::uint32_t z = 1; z < kLayers; ++z)
        std::copy_n(grid.values.begin(), layer, grid.values.begin() + static_cast<std::ptrdiff_t>(z * layer));
}

ImportedField import_nrrd(const std::filesystem::path& path, double unit_m) {
    const std::string name = path.filename().string();
    const Scan scan =
        read_raw_scan(path, "NRRD", &nrrd_header, 1e3 * unit_m, std::numeric_limits<float>::quiet_NaN());
    if (!scan.axes.isApprox(Eigen::Matrix3d::Identity(), 1e-6) &&
        !scan.axes.cwiseAbs().isApprox(Eigen::Matrix3d::Identity(), 1e-6))
        fail(name, "the axes are not parallel to x, y and z",
             "resample the field onto axes parallel to x, y and z");
    ImportedField field;
    DensityGrid& grid = field.grid;
    grid.size = {scan.columns, scan.rows, static_cast<std::uint32_t>(scan.slice.size())};
    check_counts(grid, name);
    grid.values.resize(grid.count());
    const double first_mm = scan.slice.front().s_mm, last_mm = scan.slice.back().s_mm;
    grid.spacing_m = 1e-3 * Vec3(scan.column_mm, scan.row_mm, (last_mm - first_mm) / (grid.size[2] - 1.0));
    grid.origin_m = 1e-3 * (scan.origin_mm + scan.slice.front().u_mm * scan.axes.col(0) +
                            scan.slice.front().v_mm * scan.axes.col(1) + first_mm * scan.axes.col(2));
    for (std::uint32_t z = 0; z < grid.size[2]; ++z)
        scan.read(z, std::span(grid.values).subspan(std::size_t{z} * scan.pixels(), scan.pixels()));
    // Reverse axes with a negative direction.
    for (Eigen::Index a = 0; a < 3; ++a) {
        if (scan.axes(a, a) > 0.0) continue;
        const auto n = grid.size[static_cast<std::size_t>(a)];
        grid.origin_m[a] -= grid.spacing_m[a] * (n - 1.0);
        DensityGrid turned = grid;
        for (std::uint32_t z = 0; z < grid.size[2]; ++z)
            for (std::uint32_t y = 0; y < grid.size[1]; ++y)
                for (std::uint32_t x = 0; x < grid.size[0]; ++x) {
                    std::array<std::uint32_t, 3> at{x, y, z};
                    at[static_cast<std::size_t>(a)] = n - 1 - at[static_cast<std::size_t>(a)];
                    turned.values[(std::size_t{z} * grid.size[1] + y) * grid.size[0] + x] =
                        grid.at(at[0], at[1], at[2]);
                }
        grid = std::move(turned);
    }
    field.format = "NRRD";
    return field;
}

}  // namespace

ImportedField import_field_csv(std::string_view text, const std::string& name, double unit_m) {
    bool planar = false;
    const std::vector<Point> points = points_of(text, name, planar);
    if (points.empty())
        fail(name, "the file has no points", "write x y z value, or x y value, on every line");
    const Axis x = axis_of(points, &Point::x, 'x', name), y = axis_of(points, &Point::y, 'y', name),
               z = axis_of(points, &Point::z, 'z', name);
    planar = planar || z.count == 1;
    const std::uint64_t places = std::uint64_t{x.count} * y.count * z.count;
    if (places != points.size())
        fail(name,
             std::to_string(points.size()) + " points do not fill a grid of " + std::to_string(x.count) +
                 " x " + std::to_string(y.count) + " x " + std::to_string(z.count),
             "give every grid point exactly once");
    ImportedField field;
    DensityGrid& grid = field.grid;
    grid.size = {x.count, y.count, z.count};
    grid.origin_m = unit_m * Vec3(x.low, y.low, z.low);
    grid.spacing_m = unit_m * Vec3(x.step, y.step, planar ? x.step : z.step);
    grid.values.assign(points.size(), std::numeric_limits<float>::quiet_NaN());
    for (const Point& p : points) {
        const auto index = [](double v, const Axis& a) {
            return a.count == 1 ? 0U : static_cast<std::uint32_t>(std::lround((v - a.low) / a.step));
        };
        float& value =
            grid.values[(std::size_t{index(p.z, z)} * y.count + index(p.y, y)) * x.count + index(p.x, x)];
        if (!std::isnan(value))
            fail(name,
                 "a grid point is given twice, near x = " + std::to_string(p.x) +
                     ", y = " + std::to_string(p.y),
                 "give every grid point exactly once");
        value = static_cast<float>(p.value);
        if (!std::isfinite(value)) fail(name, "a value is too large", "give values of at most 1e38 in size");
    }
    if (planar) {
        continue_along_z(grid);
        field.notes.emplace_back("planar: the potential is the same at every z");
    }
    check_counts(grid, name);
    field.format = "CSV";
    return field;
}

ImportedField import_field(const std::filesystem::path& path, double unit_m) {
    const std::string ending = format_ending(path);
    ImportedField field;
    if (ending == ".nrrd" || ending == ".nhdr") {
        field = import_nrrd(path, unit_m);
    } else if (ending == ".csv" || ending == ".txt" || ending == ".dat") {
        const std::vector<char> bytes = read_whole_file(path, kCsvBytesMax);
        field = import_field_csv({bytes.data(), bytes.size()}, path.filename().string(), unit_m);
    } else {
        fail(path.filename().string(),
             "the file name ending '" + ending + "' is not one of .csv, .txt, .dat, .nrrd, .nhdr",
             "rename the file, or convert it to CSV with x,y,z,value on every line");
    }
    for (const float v : field.grid.values)
        if (!std::isfinite(v))
            fail(path.filename().string(), "a value is not finite",
                 "give a finite number for every grid point");
    const auto& n = field.grid.size;
    field.format +=
        ", " + std::to_string(n[0]) + " x " + std::to_string(n[1]) + " x " + std::to_string(n[2]) + " points";
    return field;
}

}  // namespace tact
