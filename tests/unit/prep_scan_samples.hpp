// Small scans of the same bone, written byte by byte in every format.
#pragma once

#include <unistd.h>

#include <array>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <functional>
#include <string>
#include <vector>

#include "ipc/base/pose.hpp"

namespace tact::sample {

// 6 x 5 x 4 voxels to the left, back and up, all with different densities.
inline constexpr int kLeft = 6, kBack = 5, kUp = 4;
inline int bone_density(int l, int b, int u) { return 1 + l + kLeft * (b + kBack * u); }
inline int bone_hu(int density) { return 300 + static_cast<int>(std::lround(density * 1500.0 / 255.0)); }

class ScanFolder {
public:
    ScanFolder() {
        std::string name = (std::filesystem::temp_directory_path() / "tact-scan-XXXXXX").string();
        path = ::mkdtemp(name.data());
    }
    ~ScanFolder() { std::filesystem::remove_all(path); }
    ScanFolder(const ScanFolder&) = delete;
    ScanFolder& operator=(const ScanFolder&) = delete;
    std::filesystem::path write(const std::string& name, const std::string& bytes) const {
        std::ofstream(path / name, std::ios::binary)
            .write(bytes.data(), static_cast<std::streamsize>(bytes.size()));
        return path / name;
    }
    std::filesystem::path path;
};

template <class T>
void put(std::string& out, T value, bool big = false) {
    char raw[sizeof(T)];
    std::memcpy(raw, &value, sizeof(T));
    for (std::size_t i = 0; i < sizeof(T); ++i) out += raw[big ? sizeof(T) - 1 - i : i];
}

// Hounsfield units of the bone, first axis fastest. Axes: 0 left, 1 back, 2 up; 3, 4, 5: the same reversed.
inline std::string bone_numbers(const std::array<int, 3>& axis, bool big = false) {
    const std::array<int, 3> n{kLeft, kBack, kUp};
    std::string out;
    std::array<int, 3> i{}, at{};
    for (i[2] = 0; i[2] < n[static_cast<std::size_t>(axis[2] % 3)]; ++i[2])
        for (i[1] = 0; i[1] < n[static_cast<std::size_t>(axis[1] % 3)]; ++i[1])
            for (i[0] = 0; i[0] < n[static_cast<std::size_t>(axis[0] % 3)]; ++i[0]) {
                for (std::size_t a = 0; a < 3; ++a) {
                    const auto to = static_cast<std::size_t>(axis[a] % 3);
                    at[to] = axis[a] < 3 ? i[a] : n[to] - 1 - i[a];
                }
                put(out, static_cast<std::int16_t>(bone_hu(bone_density(at[0], at[1], at[2]))), big);
            }
    return out;
}

struct DicomSample {
    Vec3 position = Vec3::Zero();
    std::uint16_t columns = kLeft, rows = kBack;
    double spacing = 1.0, slope = 1.0, intercept = -1024.0;
    int series = 1;
    std::string modality = "CT", maker = "Acme", photometric = "MONOCHROME2", series_uid = "1.2.3.1";
    std::vector<std::uint16_t> pixels;  // stored
};

inline void dicom_element(std::string& out, std::uint16_t group, std::uint16_t element, const char* vr,
                          std::string value) {
    if (value.size() % 2 != 0) value += std::strcmp(vr, "UI") == 0 ? '\0' : ' ';
    put(out, group);
    put(out, element);
    out += vr;
    if (std::strcmp(vr, "OW") == 0 || std::strcmp(vr, "OB") == 0) {
        put(out, std::uint16_t{0});
        put(out, static_cast<std::uint32_t>(value.size()));
    } else {
        put(out, static_cast<std::uint16_t>(value.size()));
    }
    out += value;
}

inline std::string dicom_bytes(const DicomSample& s) {
    const auto us = [](std::uint16_t v) {
        std::string out;
        put(out, v);
        return out;
    };
    const auto ds = [](std::initializer_list<double> values) {
        std::string out;
        char text[32];
        for (const double v : values) {
            std::snprintf(text, sizeof text, "%s%.6g", out.empty() ? "" : "\\", v);
            out += text;
        }
        return out;
    };
    std::string meta, body, pixels, out(128, '\0');
    dicom_element(meta, 2, 1, "OB", std::string("\0\1", 2));
    dicom_element(meta, 2, 2, "UI", "1.2.840.10008.5.1.4.1.1.2");
    dicom_element(meta, 2, 3, "UI", "1.2.3.4." + std::to_string(std::lround(1000.0 * s.position.norm())));
    dicom_element(meta, 2, 0x10, "UI", "1.2.840.10008.1.2.1");
    dicom_element(body, 8, 0x16, "UI", "1.2.840.10008.5.1.4.1.1.2");
    dicom_element(body, 8, 0x20, "DA", "19710203");
    dicom_element(body, 8, 0x60, "CS", s.modality);
    dicom_element(body, 8, 0x70, "LO", s.maker);
    dicom_element(body, 8, 0x80, "LO", "Hospital of Secrets");
    dicom_element(body, 0x10, 0x10, "PN", "Doe^Jane");
    dicom_element(body, 0x10, 0x20, "LO", "PID-4711");
    dicom_element(body, 0x10, 0x30, "DA", "19500607");
    dicom_element(body, 0x20, 0x0e, "UI", s.series_uid);
    dicom_element(body, 0x20, 0x11, "IS", std::to_string(s.series));
    dicom_element(body, 0x20, 0x32, "DS", ds({s.position.x(), s.position.y(), s.position.z()}));
    dicom_element(body, 0x20, 0x37, "DS", ds({1, 0, 0, 0, 1, 0}));
    dicom_element(body, 0x28, 2, "US", us(s.photometric == "RGB" ? 3 : 1));
    dicom_element(body, 0x28, 4, "CS", s.photometric);
    dicom_element(body, 0x28, 0x10, "US", us(s.rows));
    dicom_element(body, 0x28, 0x11, "US", us(s.columns));
    dicom_element(body, 0x28, 0x30, "DS", ds({s.spacing, s.spacing}));
    dicom_element(body, 0x28, 0x100, "US", us(16));
    dicom_element(body, 0x28, 0x101, "US", us(12));
    dicom_element(body, 0x28, 0x102, "US", us(11));
    dicom_element(body, 0x28, 0x103, "US", us(0));
    dicom_element(body, 0x28, 0x1052, "DS", ds({s.intercept}));
    dicom_element(body, 0x28, 0x1053, "DS", ds({s.slope}));
    dicom_element(body, 0x28, 0x1054, "LO", "HU");
    for (const std::uint16_t p : s.pixels) put(pixels, p);
    dicom_element(body, 0x7fe0, 0x10, "OW", pixels);
    out += "DICM";
    std::string length;
    put(length, static_cast<std::uint32_t>(meta.size()));
    dicom_element(out, 2, 0, "UL", length);
    return out + meta + body;
}

// Slice u of the bone, or of `density`; the upper four bits hold arbitrary overlay data.
inline DicomSample dicom_slice(double up_mm, const std::function<double(int l, int b)>& density) {
    DicomSample s;
    s.position = Vec3(10, 20, up_mm);
    for (int b = 0; b < kBack; ++b)
        for (int l = 0; l < kLeft; ++l)
            s.pixels.push_back(static_cast<std::uint16_t>(
                0xA000 + static_cast<int>(std::lround(300.0 + density(l, b) * 1500.0 / 255.0)) + 1024));
    return s;
}
inline DicomSample bone_slice(int u) {
    return dicom_slice(u, [u](int l, int b) { return bone_density(l, b, u); });
}

}  // namespace tact::sample
