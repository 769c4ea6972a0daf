// Situs maps: text, "voxel ox oy oz nx ny nz" in ångström and voxels, then the values with x fastest.
#include <charconv>
#include <cmath>
#include <cstdio>
#include <string_view>

#include "ipc/base/error.hpp"
#include "ipc/base/units.hpp"
#include "prep/map/formats.hpp"

namespace tact::map_format {
namespace {

class Tokens {
public:
    Tokens(const std::vector<char>& bytes, const std::string& name)
        : at_(bytes.data()), end_(at_ + bytes.size()), name_(name) {}

    // Returns an empty token at the end of the file.
    std::string_view next() {
        while (at_ != end_ && is_space(*at_)) {
            if (*at_ == '\n') ++line_;
            ++at_;
        }
        const char* const first = at_;
        while (at_ != end_ && !is_space(*at_)) ++at_;
        return {first, static_cast<std::size_t>(at_ - first)};
    }
    template <class T>
    T number(const char* what) {
        std::string_view token = next();
        if (token.empty()) fail(std::string("the file ends before ") + what, "fetch the file again");
        if (token.front() == '+') token.remove_prefix(1);
        T value{};
        const auto [rest, error] = std::from_chars(token.data(), token.data() + token.size(), value);
        if (error == std::errc::result_out_of_range && std::is_floating_point_v<T>) {
            fail(std::string(what) + " '" + shown(token) + "' is too large or too small for a number",
                 "compute the map again");
        }
        if (error != std::errc() || rest != token.data() + token.size()) {
            fail(std::string(what) + " '" + shown(token) + "' is not a number",
                 "check that the file is a Situs map, and fetch it again");
        }
        return value;
    }
    [[noreturn]] void fail(const std::string& why, const std::string& fix) const {
        throw StartupError("read map " + name_, "line " + std::to_string(line_) + ": " + why, fix);
    }

private:
    static bool is_space(char c) { return c == ' ' || c == '\n' || c == '\r' || c == '\t'; }
    // Limits the text of a malicious file in messages.
    static std::string shown(std::string_view token) {
        std::string text(token.substr(0, 20));
        for (char& c : text) {
            if (static_cast<unsigned char>(c) < 0x20 || static_cast<unsigned char>(c) >= 0x7f) c = '?';
        }
        return text;
    }
    const char* at_;
    const char* end_;
    std::size_t line_ = 1;
    const std::string& name_;
};

}  // namespace

ImportedMap read_situs(const std::vector<char>& bytes, const std::string& name) {
    Tokens in(bytes, name);
    const auto voxel_a = in.number<double>("the voxel size");
    if (!(voxel_a >= 1e-3 && voxel_a <= 1e4)) {
        in.fail("the voxel size " + std::to_string(voxel_a) + " ångström is outside 0.001 to 10000",
                "write the first line as: voxel ox oy oz nx ny nz");
    }
    Vec3 origin_a;
    for (int a = 0; a < 3; ++a) {
        origin_a[a] = in.number<double>("the origin");
        if (!std::isfinite(origin_a[a]))
            in.fail("the origin is not a number", "set the origin in the first line");
    }
    ImportedMap map;
    std::uint64_t voxels = 1;
    for (std::uint32_t& n : map.grid.size) {
        const auto size = in.number<long>("the size");
        if (size < 4 || size > 16384) {
            in.fail("the map has " + std::to_string(size) + " voxels along an axis, outside 4 to 16384",
                    "write the first line as: voxel ox oy oz nx ny nz");
        }
        n = static_cast<std::uint32_t>(size);
        voxels *= n;
    }
    if (voxels > kMapVoxelsMax)
        in.fail(std::to_string(voxels) + " voxels are more than " + std::to_string(kMapVoxelsMax),
                "crop the map, or bin it to larger voxels");
    // Every value takes at least two characters: reject false sizes before memory is allocated.
    if (voxels > bytes.size() / 2 + 1) {
        in.fail("the first line declares " + std::to_string(voxels) + " voxels, but the file has " +
                    std::to_string(bytes.size()) + " bytes (truncated)",
                "fetch the file again");
    }
    map.grid.origin_m = kAngstromM * origin_a;
    map.grid.spacing_m = Vec3::Constant(kAngstromM * voxel_a);
    map.grid.values.reserve(voxels);
    for (std::uint64_t i = 0; i < voxels; ++i) {
        // Values are printed by printf("%f") in double; tiny values underflow a float, which is not an error.
        map.grid.values.push_back(static_cast<float>(in.number<double>("a voxel")));
    }
    if (!in.next().empty())
        in.fail("the file has more than the " + std::to_string(voxels) +
                    " values that the first line declares (oversized)",
                "correct the sizes in the first line");
    map.format = "Situs";
    char rule[160];
    std::snprintf(rule, sizeof rule, "origin of the Situs header (%.6g, %.6g, %.6g) A", origin_a.x(),
                  origin_a.y(), origin_a.z());
    map.origin_rule = rule;
    return map;
}

}  // namespace tact::map_format
