// NRRD, versions 1 to 5, also with a detached header: https://teem.sourceforge.net/nrrd/format.html.
#include <map>

#include "prep/volume/header_text.hpp"
#include "prep/volume/raw_scan.hpp"

namespace tact {
namespace {

struct NrrdFields {
    std::map<std::string, std::string, std::less<>> field;  // keys in lower case
    std::map<std::string, std::string, std::less<>> pair;   // key:=value, unchanged
    std::size_t end = 0;
    [[nodiscard]] std::string_view of(std::string_view name) const {
        const auto found = field.find(name);
        return found == field.end() ? std::string_view{} : std::string_view(found->second);
    }
};

NrrdFields read_fields(HeaderText& in) {
    NrrdFields out;
    std::string_view line;
    while (in.line(line)) {
        if (line.empty()) break;
        if (line.front() == '#') continue;
        const std::size_t pair = line.find(":="), colon = line.find(": ");
        if (pair != std::string_view::npos && (colon == std::string_view::npos || pair < colon))
            out.pair.emplace(line.substr(0, pair), line.substr(pair + 2));
        else if (colon != std::string_view::npos)
            out.field.emplace(HeaderText::lower(line.substr(0, colon)),
                              HeaderText::trimmed(line.substr(colon + 2)));
    }
    out.end = in.position();
    return out;
}

RawType nrrd_type(const HeaderText& in, std::string_view name) {
    static const std::map<std::string_view, RawType, std::less<>> kTypes{
        {"signed char", RawType::i8},   {"int8", RawType::i8},
        {"int8_t", RawType::i8},        {"uchar", RawType::u8},
        {"unsigned char", RawType::u8}, {"uint8", RawType::u8},
        {"uint8_t", RawType::u8},       {"short", RawType::i16},
        {"short int", RawType::i16},    {"signed short", RawType::i16},
        {"int16", RawType::i16},        {"int16_t", RawType::i16},
        {"ushort", RawType::u16},       {"unsigned short", RawType::u16},
        {"uint16", RawType::u16},       {"uint16_t", RawType::u16},
        {"int", RawType::i32},          {"signed int", RawType::i32},
        {"int32", RawType::i32},        {"int32_t", RawType::i32},
        {"uint", RawType::u32},         {"unsigned int", RawType::u32},
        {"uint32", RawType::u32},       {"uint32_t", RawType::u32},
        {"float", RawType::f32},        {"double", RawType::f64}};
    const auto found = kTypes.find(name);
    if (found == kTypes.end())
        in.fail("the type is \"" + std::string(name.substr(0, 40)) + "\", which is not supported");
    return found->second;
}

Vec3 nrrd_vector(const HeaderText& in, std::string_view text, const char* what) {
    text = HeaderText::trimmed(text);
    if (text.size() < 2 || text.front() != '(' || text.back() != ')')
        in.fail(std::string(what) + " is not a vector in parentheses");
    const auto words = HeaderText::words(text.substr(1, text.size() - 2), ", \t");
    if (words.size() != 3) in.fail(std::string(what) + " does not have three numbers");
    return {in.number(words[0], what), in.number(words[1], what), in.number(words[2], what)};
}

void nrrd_axes(const HeaderText& in, const NrrdFields& f, double unit_mm, ScanAxes& axes) {
    const auto sizes = HeaderText::words(f.of("sizes"));
    if (f.of("dimension") != "3" || sizes.size() != 3)
        in.fail("the volume has " + std::string(f.of("dimension").substr(0, 10)) + " axes instead of 3");
    for (std::size_t a = 0; a < 3; ++a) axes.size[a] = in.whole(sizes[a], "a size");
    const std::string space = HeaderText::lower(f.of("space"));
    Vec3 to_lps(1, 1, 1);
    axes.oriented = true;
    if (space == "right-anterior-superior" || space == "ras")
        to_lps = Vec3(-1, -1, 1);
    else if (space == "left-anterior-superior" || space == "las")
        to_lps = Vec3(1, -1, 1);
    else if (space != "left-posterior-superior" && space != "lps")
        axes.oriented = false;
    const std::string_view directions = f.of("space directions"), spacings = f.of("spacings");
    if (!directions.empty()) {
        std::size_t from = 0;
        for (std::size_t a = 0; a < 3; ++a) {
            const std::size_t end = directions.find(')', from);
            if (end == std::string_view::npos) in.fail("the space directions are not three vectors");
            axes.step_mm[a] =
                unit_mm * nrrd_vector(in, directions.substr(from, end + 1 - from), "a space direction")
                              .cwiseProduct(to_lps);
            from = end + 1;
        }
        if (const std::string_view origin = f.of("space origin"); !origin.empty())
            axes.origin_mm = unit_mm * nrrd_vector(in, origin, "the space origin").cwiseProduct(to_lps);
    } else {
        axes.oriented = false;
        const auto words = HeaderText::words(spacings);
        if (words.size() != 3) in.fail("the header has no voxel spacing (spacings, space directions)");
        for (std::size_t a = 0; a < 3; ++a) {
            axes.step_mm[a] = Vec3::Zero();
            axes.step_mm[a][static_cast<int>(a)] = unit_mm * std::abs(in.number(words[a], "a spacing"));
        }
    }
}

// Names and colours of the segments that 3D Slicer writes.
std::vector<ScanLabel> nrrd_labels(const HeaderText& in, const NrrdFields& f) {
    std::vector<ScanLabel> labels;
    for (int i = 0; i < 255; ++i) {
        std::string key = "Segment";
        key += std::to_string(i);
        const auto name = f.pair.find(key + "_Name"), value = f.pair.find(key + "_LabelValue");
        if (name == f.pair.end() || value == f.pair.end()) continue;
        const std::uint64_t number = in.whole(HeaderText::trimmed(value->second), "a label");
        if (number == 0 || number > 255)
            in.fail("a segment has label " + std::to_string(number) + ", outside 1 to 255");
        ScanLabel label{static_cast<std::uint8_t>(number), name->second, {200, 200, 200, 255}, {}};
        if (const auto color = f.pair.find(key + "_Color"); color != f.pair.end()) {
            const auto words = HeaderText::words(color->second);
            for (std::size_t c = 0; c < 3 && words.size() == 3; ++c)
                label.rgba[c] = static_cast<std::uint8_t>(
                    255.0 * std::min(1.0, std::max(0.0, in.number(words[c], "a colour"))));
        }
        labels.push_back(std::move(label));
    }
    return labels;
}

}  // namespace

RawHeader nrrd_header(std::string_view bytes, const std::string& attempt, double unit_mm) {
    HeaderText in(bytes, attempt);
    std::string_view magic;
    if (!in.line(magic) || !magic.starts_with("NRRD000")) in.fail("the file does not begin with NRRD000");
    const NrrdFields f = read_fields(in);
    RawHeader h;
    h.type = nrrd_type(in, HeaderText::lower(f.of("type")));
    nrrd_axes(in, f, unit_mm, h.axes);
    h.label = nrrd_labels(in, f);
    const std::string endian = HeaderText::lower(f.of("endian"));
    if (endian.empty() && h.type != RawType::i8 && h.type != RawType::u8)
        in.fail("the header does not declare the byte order");
    h.big_endian = endian == "big";
    const std::string encoding = HeaderText::lower(f.of("encoding"));
    if (encoding == "gzip" || encoding == "gz")
        h.packing = RawPacking::deflate;
    else if (encoding != "raw")
        in.fail("the encoding is \"" + encoding.substr(0, 40) + "\"; only raw and gzip are supported");
    std::string_view file = f.of("data file");
    if (file.empty()) file = f.of("datafile");
    h.data_file = file;
    if (file.empty()) h.offset = f.end;
    const std::string_view skip = f.of("byte skip").empty() ? f.of("byteskip") : f.of("byte skip");
    if (skip == "-1")
        h.from_end = true;
    else if (!skip.empty())
        h.offset += std::min<std::uint64_t>(in.whole(skip, "byte skip"), kScanBytesMax);
    for (const char* field : {"line skip", "lineskip"})
        if (!f.of(field).empty() && f.of(field) != "0")
            in.fail("lines between header and data are not supported");
    return h;
}

}  // namespace tact
