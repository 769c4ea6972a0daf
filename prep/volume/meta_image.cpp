// MetaImage (.mha, .mhd): https://itk.org/Wiki/MetaIO/Documentation.
#include <map>

#include "prep/volume/header_text.hpp"
#include "prep/volume/raw_scan.hpp"

namespace tact {

RawHeader meta_image_header(std::string_view bytes, const std::string& attempt, double unit_mm) {
    HeaderText in(bytes, attempt);
    RawHeader h;
    std::map<std::string, std::string, std::less<>> field;
    std::string_view line;
    while (in.line(line)) {
        const std::size_t equals = line.find('=');
        if (equals == std::string_view::npos) in.fail("a line of the header is not \"key = value\"");
        const std::string key = HeaderText::lower(HeaderText::trimmed(line.substr(0, equals)));
        field[key] = HeaderText::trimmed(line.substr(equals + 1));
        if (key == "elementdatafile") break;  // the last key
    }
    const auto of = [&](std::initializer_list<const char*> names) -> std::string_view {
        for (const char* name : names)
            if (const auto found = field.find(name); found != field.end()) return found->second;
        return {};
    };
    const auto numbers = [&](std::string_view text, std::size_t count, const char* what) {
        const auto words = HeaderText::words(text);
        if (words.size() != count)
            in.fail(std::string(what) + " does not have " + std::to_string(count) + " numbers");
        std::vector<double> out;
        for (const std::string_view word : words) out.push_back(in.number(word, what));
        return out;
    };
    const auto yes = [](std::string_view v) { return HeaderText::lower(v) == "true" || v == "1"; };
    if (of({"ndims"}) != "3") in.fail("the volume does not have three axes (NDims)");
    const auto sizes = HeaderText::words(of({"dimsize"}));
    if (sizes.size() != 3) in.fail("DimSize does not have three numbers");
    for (std::size_t a = 0; a < 3; ++a) h.axes.size[a] = in.whole(sizes[a], "DimSize");
    const std::string_view spacing = of({"elementspacing", "elementsize"});
    if (spacing.empty()) in.fail("the header has no voxel spacing (ElementSpacing)");
    const auto steps = numbers(spacing, 3, "ElementSpacing");
    const std::string_view matrix = of({"transformmatrix", "rotation", "orientation"});
    h.axes.oriented = !matrix.empty();
    std::vector<double> m{1, 0, 0, 0, 1, 0, 0, 0, 1};
    if (h.axes.oriented) m = numbers(matrix, 9, "TransformMatrix");
    for (std::size_t a = 0; a < 3; ++a) {
        const Vec3 direction(m[3 * a], m[3 * a + 1], m[3 * a + 2]);
        if (std::abs(direction.norm() - 1.0) > 1e-3)
            in.fail("an axis of TransformMatrix does not have length 1");
        h.axes.step_mm[a] = unit_mm * std::abs(steps[a]) * direction;
    }
    if (const std::string_view origin = of({"offset", "position", "origin"}); !origin.empty()) {
        const auto o = numbers(origin, 3, "Offset");
        h.axes.origin_mm = unit_mm * Vec3(o[0], o[1], o[2]);
    }
    static const std::map<std::string_view, RawType, std::less<>> kTypes{
        {"MET_CHAR", RawType::i8},    {"MET_UCHAR", RawType::u8},  {"MET_SHORT", RawType::i16},
        {"MET_USHORT", RawType::u16}, {"MET_INT", RawType::i32},   {"MET_UINT", RawType::u32},
        {"MET_FLOAT", RawType::f32},  {"MET_DOUBLE", RawType::f64}};
    const auto type = kTypes.find(of({"elementtype"}));
    if (type == kTypes.end())
        in.fail("ElementType is \"" + std::string(of({"elementtype"}).substr(0, 40)) +
                "\", which is not supported");
    h.type = type->second;
    if (!of({"elementnumberofchannels"}).empty() && of({"elementnumberofchannels"}) != "1")
        in.fail("voxels with more than one value are not supported");
    if (!of({"binarydata"}).empty() && !yes(of({"binarydata"}))) in.fail("voxels as text are not supported");
    h.big_endian = yes(of({"binarydatabyteordermsb", "elementbyteordermsb"}));
    if (yes(of({"compresseddata"}))) h.packing = RawPacking::deflate;
    const std::string_view skip = of({"headersize"});
    const std::string_view file = of({"elementdatafile"});
    if (file.empty()) in.fail("the header does not name the file of the voxels (ElementDataFile)");
    if (HeaderText::lower(file) == "local")
        h.offset = in.position();
    else
        h.data_file = file;
    if (skip == "-1")
        h.from_end = true;
    else if (!skip.empty() && !h.data_file.empty())
        h.offset += std::min<std::uint64_t>(in.whole(skip, "HeaderSize"), kScanBytesMax);
    return h;
}

}  // namespace tact
