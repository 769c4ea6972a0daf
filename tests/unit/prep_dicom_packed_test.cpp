// Compressed DICOM from scanners and archives: lossless JPEG, JPEG-LS, JPEG 2000 and run-length files give the same bone.
#include <gdcmImageChangeTransferSyntax.h>
#include <gdcmImageReader.h>
#include <gdcmImageWriter.h>
#include <gdcmTrace.h>
#include <gtest/gtest.h>

#include "ipc/base/error.hpp"
#include "prep/drilling/import_bone.hpp"
#include "tests/support/library_leaks.hpp"
#include "tests/support/says.hpp"
#include "tests/unit/prep_scan_samples.hpp"

namespace tact {
namespace {

namespace fs = std::filesystem;
using gdcm::TransferSyntax;

// Compresses a plain file with GDCM's encoder. Returns false if it cannot.
bool pack(const fs::path& from, const fs::path& to, TransferSyntax::TSType syntax) {
    gdcm::Trace::WarningOff();
    gdcm::Trace::ErrorOff();
    gdcm::ImageReader reader;
    reader.SetFileName(from.c_str());
    if (!reader.Read()) return false;
    gdcm::ImageChangeTransferSyntax change;
    change.SetTransferSyntax(TransferSyntax(syntax));
    change.SetInput(reader.GetImage());
    if (!change.Change()) return false;
    gdcm::ImageWriter writer;
    writer.SetFileName(to.c_str());
    writer.SetFile(reader.GetFile());
    writer.SetImage(change.GetOutput());
    return writer.Write();
}

// The slice with each pixel repeated `times` times along both axes.
sample::DicomSample enlarged(const sample::DicomSample& from, int times) {
    sample::DicomSample to = from;
    to.columns = static_cast<std::uint16_t>(from.columns * times);
    to.rows = static_cast<std::uint16_t>(from.rows * times);
    to.pixels.clear();
    for (int row = 0; row < to.rows; ++row)
        for (int column = 0; column < to.columns; ++column)
            to.pixels.push_back(
                from.pixels[static_cast<std::size_t>(row / times * from.columns + column / times)]);
    return to;
}

class PackedDicom : public testing::TestWithParam<TransferSyntax::TSType> {
protected:
    // GDCM 3.0's JPEG 2000 encoder crashes on images of a few pixels.
    static int times() { return GetParam() == TransferSyntax::JPEG2000Lossless ? 16 : 1; }
    void SetUp() override {
        for (int u = 0; u < sample::kUp; ++u) {
            sample::DicomSample slice = enlarged(sample::bone_slice(u), times());
            for (std::uint16_t& p : slice.pixels)
                p &= 0x0FFF;  // no overlay bits next to the compressed pixels
            plain_.write("s", sample::dicom_bytes(slice));
            std::string name = "s";
            name += std::to_string(u);
            ASSERT_TRUE(pack(plain_.path / "s", packed_.path / (name + ".dcm"), GetParam())) << u;
        }
    }
    [[nodiscard]] std::string refusal() const {
        BoneImport o;
        o.scan = packed_.path;
        try {
            (void)import_bone(o);
        } catch (const StartupError& error) {
            return error.what();
        }
        return "no error";
    }
    sample::ScanFolder plain_, packed_;
};

TEST_P(PackedDicom, gives_the_same_bone) {
    BoneImport o;
    o.scan = packed_.path;
    const BoneData bone = import_bone(o).bone;
    const int left = sample::kLeft * times(), back = sample::kBack * times();
    ASSERT_EQ(bone.bricks.size, (std::array<std::uint32_t, 3>{static_cast<std::uint32_t>(left), sample::kUp,
                                                              static_cast<std::uint32_t>(back)}));
    for (int l = 0; l < left; ++l)
        for (int b = 0; b < back; ++b)
            for (int u = 0; u < sample::kUp; ++u)
                ASSERT_EQ(bone.density[bone.bricks.voxel(static_cast<std::uint32_t>(l),
                                                         static_cast<std::uint32_t>(u),
                                                         static_cast<std::uint32_t>(back - 1 - b))],
                          sample::bone_density(l / times(), b / times(), u))
                    << l << ' ' << b << ' ' << u;
}

TEST_P(PackedDicom, a_truncated_slice_is_named) {
    const fs::path cut = packed_.path / "s2.dcm";
    const auto bytes = fs::file_size(cut);
    fs::resize_file(cut, bytes - 40);
    EXPECT_TRUE(says(refusal(), {"s2.dcm", "fix:"}));
}

std::string name_of(const testing::TestParamInfo<TransferSyntax::TSType>& info) {
    switch (info.param) {
        case TransferSyntax::JPEGLosslessProcess14_1:
            return "JpegLossless";
        case TransferSyntax::JPEGLSLossless:
            return "JpegLs";
        case TransferSyntax::JPEG2000Lossless:
            return "Jpeg2000";
        default:
            return "Rle";
    }
}

INSTANTIATE_TEST_SUITE_P(Lossless, PackedDicom,
                         testing::Values(TransferSyntax::JPEGLosslessProcess14_1,
                                         TransferSyntax::JPEGLSLossless, TransferSyntax::JPEG2000Lossless,
                                         TransferSyntax::RLELossless),
                         name_of);

}  // namespace
}  // namespace tact
