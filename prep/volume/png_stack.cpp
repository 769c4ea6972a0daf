#include "prep/volume/png_stack.hpp"

#include <algorithm>
#include <cstring>
#include <map>

#include "ipc/base/error.hpp"
#include "ipc/image/png.hpp"

namespace tact {
namespace {

namespace fs = std::filesystem;
constexpr std::size_t kStackMax = Scan::kEdgeMax;

// Converts libpng's errors for the file `name` of a folder to StartupError.
template <class Use>
auto use_png(const fs::path& folder, const std::string& name, const std::string& attempt, Use&& use) {
    try {
        PngReader picture(folder / name);
        return use(picture);
    } catch (const PngError& e) {
        throw StartupError(attempt, name + ": " + e.what(), "export the images again");
    }
}

}  // namespace

std::vector<std::string> stack_order(std::vector<std::string> names, const std::string& attempt) {
    const auto fail = [&](const std::string& why) {
        throw StartupError(attempt, why, "give a folder with the images of one stack, numbered without gaps");
    };
    std::map<std::uint64_t, std::string> by_number;
    std::string word;
    for (std::string& name : names) {
        if (name.size() < 5 || !(name.ends_with(".png") || name.ends_with(".PNG"))) continue;
        const std::size_t end = name.size() - 4;
        std::size_t begin = end;
        while (begin > 0 && name[begin - 1] >= '0' && name[begin - 1] <= '9') --begin;
        if (begin == end || end - begin > 9)
            fail(name + " has no number before .png, or one of more than 9 digits");
        if (by_number.empty()) word = name.substr(0, begin);
        if (name.compare(0, begin, word) != 0 || begin != word.size())
            fail("the folder contains images with two names: " + by_number.begin()->second + " and " + name);
        const std::uint64_t number = std::stoull(name.substr(begin, end - begin));
        const auto [at, fresh] = by_number.emplace(number, name);
        if (!fresh) fail(at->second + " and " + name + " have the same number");
        if (by_number.size() > kStackMax)
            fail("the folder contains more than " + std::to_string(kStackMax) + " images");
    }
    if (by_number.empty()) fail("the folder contains no .png image");
    std::vector<std::string> order;
    std::uint64_t expected = by_number.begin()->first;
    for (auto& [number, name] : by_number) {
        if (number != expected)
            fail("slices are missing: number " + std::to_string(expected - 1) + " is followed by " +
                 std::to_string(number));
        ++expected;
        order.push_back(std::move(name));
    }
    return order;
}

PngStack read_png_stack(const fs::path& folder, const Vec3& spacing_mm) {
    const std::string attempt = "read the images in " + folder.string();
    std::vector<std::string> names;
    for (const fs::directory_entry& entry : fs::directory_iterator(folder))
        if (entry.is_regular_file()) names.push_back(entry.path().filename().string());
    names = stack_order(std::move(names), attempt);
    PngStack stack;
    ScanAxes axes;
    bool colour = false;
    use_png(folder, names[0], attempt, [&](const PngReader& first) {
        axes.size = {first.width_px(), first.height_px(), names.size()};
        colour = first.colour();
    });
    for (int a = 0; a < 3; ++a) axes.step_mm[static_cast<std::size_t>(a)][a] = spacing_mm[a];
    std::vector<std::uint32_t> order;
    stack.scan = scan_of(axes, attempt, order);
    stack.scan.format = colour ? "PNG images, one colour per structure" : "PNG images, grey";
    stack.scan.values = colour ? ScanValues::label : ScanValues::grey;
    if (colour) stack.palette = std::make_shared<StackPalette>();
    stack.scan.read = [folder, attempt, names = std::move(names), palette = stack.palette,
                       wide = stack.scan.columns,
                       high = stack.scan.rows](std::uint32_t slice, std::span<float> pixels) {
        const std::string& name = names.at(slice);
        const auto bytes = use_png(folder, name, attempt, [&](PngReader& picture) {
            if (picture.width_px() != wide || picture.height_px() != high)
                throw StartupError(attempt,
                                   name + " is " + std::to_string(picture.width_px()) + " x " +
                                       std::to_string(picture.height_px()) + " pixels, the others are " +
                                       std::to_string(wide) + " x " + std::to_string(high),
                                   "give a folder with the images of one stack");
            return picture.read(palette ? PngFormat::rgba : PngFormat::grey);
        });
        if (!palette) {
            std::copy(bytes.begin(), bytes.end(), pixels.begin());
            return;
        }
        std::uint32_t last = 0;
        float last_number = -1.0F;
        for (std::size_t i = 0; i < pixels.size(); ++i) {
            std::uint32_t bits = 0;
            std::memcpy(&bits, bytes.data() + 4 * i, 4);
            if (last_number < 0.0F || bits != last) {
                std::array<std::uint8_t, 4> rgba;
                std::memcpy(rgba.data(), &bits, 4);
                if (rgba[3] == 0) rgba = {};  // transparent pixels have no colour
                const auto found = std::find(palette->rgba.begin(), palette->rgba.end(), rgba);
                if (found == palette->rgba.end() && palette->rgba.size() == 256)
                    throw StartupError(
                        attempt,
                        name + ": the images have more than 256 colours, so the colours are not labels",
                        "save labels without smoothing, or a grey image");
                last = bits;
                last_number = static_cast<float>(found - palette->rgba.begin());
                if (found == palette->rgba.end()) palette->rgba.push_back(rgba);
            }
            pixels[i] = last_number;
        }
    };
    return stack;
}

}  // namespace tact
