#include "ipc/igtl/encode.hpp"

#include <igtlSensorMessage.h>
#include <igtlStatusMessage.h>
#include <igtlStringMessage.h>
#include <igtlTrackingDataMessage.h>
#include <igtlTransformMessage.h>
#include <igtlUnit.h>

#include <algorithm>

namespace tact {

namespace {

std::string igtl_name(std::string_view name) { return std::string(name.substr(0, kIgtlNameMax)); }

template <class Message>
typename Message::Pointer igtl_message(std::string_view device, std::int64_t time_ns) {
    typename Message::Pointer m = Message::New();
    m->SetDeviceName(igtl_name(device).c_str());
    const auto ns = static_cast<std::uint64_t>(std::max<std::int64_t>(time_ns, 0));
    // Rounded up, so that the decoder's rounding down gives the same nanosecond; the library's own function is 1 ns off.
    const std::uint64_t fraction = (((ns % 1'000'000'000U) << 32U) + 999'999'999U) / 1'000'000'000U;
    m->SetTimeStamp(static_cast<unsigned>(ns / 1'000'000'000U), static_cast<unsigned>(fraction));
    return m;
}

void append_packed(IgtlBytes& out, igtl::MessageBase& m) {
    m.Pack();
    const auto* const bytes = static_cast<const std::byte*>(m.GetPackPointer());
    out.insert(out.end(), bytes, bytes + m.GetPackSize());
}

void igtl_matrix(const Pose& T, igtl::Matrix4x4& m) {
    const Eigen::Matrix3d R = T.q.toRotationMatrix();
    for (int row = 0; row < 3; ++row) {
        for (int column = 0; column < 3; ++column) m[row][column] = static_cast<float>(R(row, column));
        m[row][3] = static_cast<float>(1e3 * T.p_m[row]);
        m[3][row] = 0.0F;
    }
    m[3][3] = 1.0F;
}

igtl::igtlUnit igtl_unit_of(IgtlUnit unit) {
    const igtl::Unit::Pointer u = igtl::Unit::New();
    u->Init();
    if (unit == IgtlUnit::newton || unit == IgtlUnit::newton_metre)
        u->Append(igtl::Unit::SI_DERIVED_NEWTON, 1);
    if (unit == IgtlUnit::newton_metre || unit == IgtlUnit::millimetre)
        u->Append(igtl::Unit::SI_BASE_METER, 1);
    if (unit == IgtlUnit::millimetre) u->SetPrefix(igtl::Unit::SI_PREFIX_MILLI);
    return u->Pack();
}

}  // namespace

void append_transform(IgtlBytes& out, std::string_view device, const Pose& T, std::int64_t time_ns) {
    const auto m = igtl_message<igtl::TransformMessage>(device, time_ns);
    igtl::Matrix4x4 matrix;
    igtl_matrix(T, matrix);
    m->SetMatrix(matrix);
    append_packed(out, *m);
}

void append_tdata(IgtlBytes& out, std::string_view device, std::span<const IgtlNamedPose> poses,
                  std::int64_t time_ns) {
    const auto m = igtl_message<igtl::TrackingDataMessage>(device, time_ns);
    for (const IgtlNamedPose& p : poses.first(std::min(poses.size(), kIgtlPosesMax))) {
        igtl::TrackingDataElement::Pointer element = igtl::TrackingDataElement::New();
        element->SetName(igtl_name(p.name).c_str());
        element->SetType(igtl::TrackingDataElement::TYPE_6D);
        igtl::Matrix4x4 matrix;
        igtl_matrix(p.T, matrix);
        element->SetMatrix(matrix);
        m->AddTrackingDataElement(element);
    }
    append_packed(out, *m);
}

void append_sensor(IgtlBytes& out, std::string_view device, std::span<const double> values, IgtlUnit unit,
                   std::int64_t time_ns) {
    const auto m = igtl_message<igtl::SensorMessage>(device, time_ns);
    const std::size_t count = std::min<std::size_t>(values.size(), 255);
    m->SetLength(static_cast<unsigned>(count));
    m->SetUnit(igtl_unit_of(unit));
    for (std::size_t i = 0; i < count; ++i) m->SetValue(static_cast<unsigned>(i), values[i]);
    append_packed(out, *m);
}

void append_status(IgtlBytes& out, std::string_view device, IgtlStatus code, std::int64_t subcode,
                   std::string_view name, std::string_view text, std::int64_t time_ns) {
    const auto m = igtl_message<igtl::StatusMessage>(device, time_ns);
    m->SetCode(static_cast<int>(code));
    m->SetSubCode(static_cast<igtlInt64>(subcode));
    m->SetErrorName(igtl_name(name).substr(0, kIgtlNameMax - 1).c_str());  // the library adds a 0
    m->SetStatusString(std::string(text).c_str());
    append_packed(out, *m);
}

void append_string(IgtlBytes& out, std::string_view device, std::string_view text, std::int64_t time_ns) {
    const auto m = igtl_message<igtl::StringMessage>(device, time_ns);
    m->SetString(std::string(text.substr(0, 0xFFFF)).c_str());
    append_packed(out, *m);
}

void append_start_tdata(IgtlBytes& out, int period_ms) {
    const auto m = igtl_message<igtl::StartTrackingDataMessage>("", 0);
    m->SetResolution(period_ms);
    m->SetCoordinateName("");
    append_packed(out, *m);
}

}  // namespace tact
