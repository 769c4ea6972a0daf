// The only file that includes GDCM. It reads few elements and the pixels; GDCM's exceptions and output stay here.
#include <gdcmAttribute.h>
#include <gdcmImageReader.h>
#include <gdcmReader.h>
#include <gdcmTrace.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstring>
#include <fstream>
#include <set>

#include "ipc/base/error.hpp"
#include "prep/input/input_bytes.hpp"
#include "prep/volume/dicom.hpp"

namespace tact {
namespace {

namespace fs = std::filesystem;
constexpr std::size_t kFilesMax = 20000;
constexpr std::uint64_t kFileBytesMax = std::uint64_t{1} << 30;

const gdcm::Tag kModality(0x0008, 0x0060), kMaker(0x0008, 0x0070), kModel(0x0008, 0x1090),
    kSeries(0x0020, 0x000e), kNumber(0x0020, 0x0011), kPosition(0x0020, 0x0032), kOrientation(0x0020, 0x0037),
    kSamples(0x0028, 0x0002), kPhotometric(0x0028, 0x0004), kFrames(0x0028, 0x0008), kRows(0x0028, 0x0010),
    kColumns(0x0028, 0x0011), kSpacing(0x0028, 0x0030), kIntercept(0x0028, 0x1052), kSlope(0x0028, 0x1053),
    kRescaleType(0x0028, 0x1054);
const gdcm::Tag kPadding(0x0028, 0x0120);

void quiet() {
    gdcm::Trace::WarningOff();
    gdcm::Trace::ErrorOff();
    gdcm::Trace::DebugOff();
}

std::string dicom_text(const gdcm::DataSet& set, const gdcm::Tag& tag) {
    if (!set.FindDataElement(tag)) return {};
    const gdcm::ByteValue* const value = set.GetDataElement(tag).GetByteValue();
    if (value == nullptr || value->GetPointer() == nullptr) return {};
    std::string text(value->GetPointer(), std::min<std::size_t>(value->GetLength(), 1024));
    text = text.substr(0, text.find('\0'));
    const std::size_t begin = text.find_first_not_of(' ');
    if (begin == std::string::npos) return {};
    return text.substr(begin, text.find_last_not_of(' ') + 1 - begin);
}

// All numbers of a list separated by backslashes; empty if one is not a number.
std::vector<double> dicom_numbers(const gdcm::DataSet& set, const gdcm::Tag& tag) {
    const std::string text = dicom_text(set, tag);
    std::vector<double> out;
    for (std::size_t at = 0; at < text.size();) {
        std::size_t end = std::min(text.find('\\', at), text.size());
        std::size_t from = text.find_first_not_of(" +", at);
        if (from >= end) return {};
        double value = 0.0;
        const auto parsed = std::from_chars(text.data() + from, text.data() + end, value);
        if (parsed.ec != std::errc{} || !std::isfinite(value)) return {};
        out.push_back(value);
        at = end + 1;
    }
    return out;
}

std::uint32_t dicom_short(const gdcm::DataSet& set, const gdcm::Tag& tag, std::uint32_t otherwise) {
    if (!set.FindDataElement(tag)) return otherwise;
    const gdcm::ByteValue* const value = set.GetDataElement(tag).GetByteValue();
    if (value == nullptr || value->GetLength() < 2) return otherwise;
    const auto* const b = reinterpret_cast<const unsigned char*>(value->GetPointer());
    return static_cast<std::uint32_t>(b[0] | b[1] << 8);
}

// False if the file is not an image.
bool look_at(const fs::path& path, DicomSlice& s) {
    static const std::set<gdcm::Tag> kWanted{
        kModality,    kMaker,  kModel, kSeries,  kNumber,  kPosition,  kOrientation, kSamples,
        kPhotometric, kFrames, kRows,  kColumns, kSpacing, kIntercept, kSlope,       kRescaleType};
    gdcm::Reader reader;
    reader.SetFileName(path.c_str());
    if (!reader.ReadSelectedTags(kWanted)) return false;
    const gdcm::DataSet& set = reader.GetFile().GetDataSet();
    s.path = path;
    s.rows = dicom_short(set, kRows, 0);
    s.columns = dicom_short(set, kColumns, 0);
    if (s.rows == 0 || s.columns == 0) return false;
    s.samples = dicom_short(set, kSamples, 1);
    s.series_uid = dicom_text(set, kSeries);
    s.modality = dicom_text(set, kModality);
    s.photometric = dicom_text(set, kPhotometric);
    s.rescale_type = dicom_text(set, kRescaleType);
    s.maker = dicom_text(set, kMaker) + " " + dicom_text(set, kModel);
    for (char& c : s.maker)
        if (c >= 'A' && c <= 'Z') c = static_cast<char>(c - 'A' + 'a');
    const auto one = [&](const gdcm::Tag& tag, double otherwise) {
        const auto numbers = dicom_numbers(set, tag);
        return numbers.empty() ? otherwise : numbers[0];
    };
    s.series_number = static_cast<int>(std::clamp(one(kNumber, 0.0), -1e9, 1e9));
    s.frames = static_cast<std::uint32_t>(std::clamp(one(kFrames, 1.0), 1.0, 1e9));
    s.slope = one(kSlope, 1.0);
    s.intercept = one(kIntercept, 0.0);
    const auto position = dicom_numbers(set, kPosition), orientation = dicom_numbers(set, kOrientation),
               spacing = dicom_numbers(set, kSpacing);
    if (position.size() == 3 && orientation.size() == 6 && spacing.size() == 2) {
        s.position_mm = Vec3(position[0], position[1], position[2]);
        s.along_row = Vec3(orientation[0], orientation[1], orientation[2]);
        s.down_rows = Vec3(orientation[3], orientation[4], orientation[5]);
        s.row_mm = spacing[0];  // the spacing between rows comes first
        s.column_mm = spacing[1];
        s.placed = std::abs(s.along_row.norm() - 1.0) < 1e-2 && std::abs(s.down_rows.norm() - 1.0) < 1e-2;
        if (s.placed) {
            s.along_row.normalize();
            s.down_rows.normalize();
        }
    }
    return true;
}

// GDCM reads truncated pixels as zeros. True if uncompressed pixels of `size` bytes are declared but cut off.
bool cut_off(const fs::path& path, std::size_t size) {
    const InputBytes input(path, kFileBytesMax, kFileBytesMax);
    const std::string_view bytes = input.view();
    for (const bool big : {false, true}) {
        const std::string_view tag =
            big ? std::string_view("\x7f\xe0\x00\x10", 4) : std::string_view("\xe0\x7f\x10\x00", 4);
        for (std::size_t at = bytes.find(tag); at != std::string_view::npos; at = bytes.find(tag, at + 1)) {
            for (const std::size_t head : {8U, 12U}) {  // without and with a value representation
                if (at + head > bytes.size()) continue;
                std::size_t declared = 0;
                for (std::size_t i = 0; i < 4; ++i)
                    declared |=
                        std::size_t{static_cast<unsigned char>(bytes[at + head - (big ? 1 + i : 4 - i)])}
                        << 8 * i;
                if (declared == size || declared == size + 1) return bytes.size() - at - head < size;
            }
        }
    }
    return false;
}

template <class T>
void scaled(const std::vector<char>& bytes, const gdcm::PixelFormat& format, const DicomSlice& s,
            double padding, std::span<float> out) {
    // The bits above the stored ones are undefined.
    const unsigned stored = format.GetBitsStored(), all = 8 * sizeof(T);
    const unsigned unused = stored > 0 && stored < all ? all - stored : 0;
    for (std::size_t i = 0; i < out.size(); ++i) {
        T value;
        std::memcpy(&value, bytes.data() + i * sizeof(T), sizeof(T));
        using Unsigned = std::make_unsigned_t<T>;
        value = static_cast<T>(
            static_cast<T>(static_cast<Unsigned>(static_cast<Unsigned>(value) << unused)) >> unused);
        out[i] = static_cast<double>(value) == padding
                     ? -1024.0F
                     : static_cast<float>(s.slope * static_cast<double>(value) + s.intercept);
    }
}

}  // namespace

bool is_dicom(const fs::path& file) {
    std::ifstream in(file, std::ios::binary);
    char head[132] = {};
    return in.read(head, sizeof head) && std::equal(head + 128, head + 132, "DICM");
}

std::vector<DicomSlice> list_dicom(const fs::path& folder, const Progress& progress) {
    quiet();
    std::vector<DicomSlice> slices;
    std::size_t files = 0;
    std::error_code ignored;
    for (auto at = fs::recursive_directory_iterator(folder, fs::directory_options::skip_permission_denied);
         at != fs::recursive_directory_iterator(); at.increment(ignored)) {
        if (at.depth() > 8) at.disable_recursion_pending();
        if (!at->is_regular_file(ignored) || at->file_size(ignored) > kFileBytesMax || !is_dicom(at->path()))
            continue;
        if (++files > kFilesMax)
            throw StartupError("read DICOM in " + folder.string(), "the folder holds more than 20000 files",
                               "give the folder of one examination");
        if (files % 16 == 0) report(progress, 0.0, "reading DICOM headers");
        DicomSlice slice;
        try {
            if (look_at(at->path(), slice)) slices.push_back(std::move(slice));
        } catch (const Cancelled&) {
            throw;
        } catch (const std::exception&) {
            // A broken file counts as no image; the check of gaps reports the missing slice.
        }
    }
    return slices;
}

void read_dicom_pixels(const DicomSlice& s, std::span<float> pixels) {
    const auto fail = [&](const std::string& why) {
        throw StartupError("read " + s.path.string(), why,
                           "export the series again, without compression if necessary");
    };
    quiet();
    std::vector<char> bytes;
    gdcm::PixelFormat format;
    double padding = std::nan("");
    try {
        gdcm::ImageReader reader;
        reader.SetFileName(s.path.c_str());
        if (!reader.Read())
            fail("the pixels cannot be read: the file is damaged, or its compression is not supported");
        const gdcm::Image& image = reader.GetImage();
        format = image.GetPixelFormat();
        if (image.GetNumberOfDimensions() < 2 || image.GetDimension(0) != s.columns ||
            image.GetDimension(1) != s.rows || format.GetSamplesPerPixel() != 1)
            fail("the pixels contradict the header");
        const std::size_t size = pixels.size() * format.GetPixelSize();
        if (format.GetPixelSize() < 1 || format.GetPixelSize() > 4 || image.GetBufferLength() != size)
            fail("the file has " + std::to_string(image.GetBufferLength()) + " bytes of pixels instead of " +
                 std::to_string(size));
        if (cut_off(s.path, size)) fail("the file is truncated: pixels are missing at the end");
        bytes.resize(size);
        if (!image.GetBuffer(bytes.data())) fail("the pixels cannot be decompressed");
        const gdcm::DataSet& set = reader.GetFile().GetDataSet();
        if (set.FindDataElement(kPadding)) {
            const std::uint32_t raw = dicom_short(set, kPadding, 0);
            padding = format.GetPixelRepresentation() == 1
                          ? static_cast<double>(static_cast<std::int16_t>(raw))
                          : raw;
        }
    } catch (const StartupError&) {
        throw;
    } catch (const std::exception& error) {
        fail(error.what());
    }
    const bool is_signed = format.GetPixelRepresentation() == 1;
    switch (format.GetPixelSize()) {
        case 1:
            return is_signed ? scaled<std::int8_t>(bytes, format, s, padding, pixels)
                             : scaled<std::uint8_t>(bytes, format, s, padding, pixels);
        case 2:
            return is_signed ? scaled<std::int16_t>(bytes, format, s, padding, pixels)
                             : scaled<std::uint16_t>(bytes, format, s, padding, pixels);
        case 4:
            return is_signed ? scaled<std::int32_t>(bytes, format, s, padding, pixels)
                             : scaled<std::uint32_t>(bytes, format, s, padding, pixels);
        default:
            fail("pixels of " + std::to_string(format.GetPixelSize()) + " bytes are not supported");
    }
}

}  // namespace tact
