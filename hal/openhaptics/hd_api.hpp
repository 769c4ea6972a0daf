// The part of the vendor's library libHD.so that is used: types, numbers and functions, without its header.
//
// Source   the library's published programming interface. The layout of HdErrorInfo and the argument types
//          are those of the 64-bit Linux library; the tests build their own library against this file.
// Units    millimetres, newtons, millinewton metres, radians; forces go out when a frame ends
// Errors   a global stack, the last one first; empty: code 0
#pragma once

namespace tact::hd {

using Handle = unsigned;  // HHD
using Enum = unsigned;
using Boolean = unsigned char;
using SchedulerHandle = unsigned long;
using Callback = Enum (*)(void*);

struct ErrorInfo {
    unsigned code;
    int internal;
    Handle device;
};

inline constexpr Handle kInvalidDevice = 0xFFFFFFFFU;
inline constexpr Enum kCallbackDone = 0, kCallbackContinue = 1;
inline constexpr unsigned short kPriorityMax = 65535;

inline constexpr Enum kButtons = 0x2000, kInkwellSwitch = 0x2002;
inline constexpr Enum kTransform = 0x2052;  // 16 doubles, column major, mm
inline constexpr Enum kVelocity = 0x2051, kAngularVelocity = 0x2053;
inline constexpr Enum kModelType = 0x2501, kSerialNumber = 0x2504;
inline constexpr Enum kUsableWorkspace = 0x2551;  // lowest x, y, z, highest x, y, z
inline constexpr Enum kOutputDof = 0x2554, kCalibrationStyle = 0x2555, kUpdateRate = 0x2600;
inline constexpr Enum kMaxStiffness = 0x2602;  // N/mm
inline constexpr Enum kMaxForce = 0x2603, kMaxContinuousForce = 0x2604;
inline constexpr Enum kForce = 0x2700, kTorque = 0x2701;
inline constexpr Enum kForceOutput = 0x4000, kMaxForceClamping = 0x4001, kForceRamping = 0x4002;
inline constexpr Enum kCalibrationOk = 0x5000, kCalibrationNeedsUpdate = 0x5001,
                      kCalibrationNeedsManualInput = 0x5002;

// Bits of the calibration styles that a device supports.
inline constexpr int kStyleEncoderReset = 1, kStyleAutomatic = 2, kStyleInkwell = 4;

// Error codes.
inline constexpr unsigned kSuccess = 0, kInvalidEnum = 0x100, kInvalidValue = 0x101,
                          kInvalidOperation = 0x102, kInvalidInputType = 0x103, kBadHandle = 0x104,
                          kWarmMotors = 0x200, kExceededMaxForce = 0x201, kExceededImpulse = 0x202,
                          kExceededVelocity = 0x203, kForceError = 0x204, kDeviceFault = 0x300,
                          kDeviceInitiated = 0x301, kCommunication = 0x302, kTimer = 0x304,
                          kIllegalBegin = 0x400, kIllegalEnd = 0x401, kFrameError = 0x402,
                          kInvalidLicense = 0x600;

// One row per function: X(return type, name, arguments). The only list of them.
#define TACT_HD_FUNCTIONS(X)                                                      \
    X(::tact::hd::Handle, hdInitDevice, (const char* name))                       \
    X(void, hdDisableDevice, (::tact::hd::Handle device))                         \
    X(void, hdMakeCurrentDevice, (::tact::hd::Handle device))                     \
    X(void, hdBeginFrame, (::tact::hd::Handle device))                            \
    X(void, hdEndFrame, (::tact::hd::Handle device))                              \
    X(::tact::hd::ErrorInfo, hdGetError, ())                                      \
    X(const char*, hdGetErrorString, (::tact::hd::Enum code))                     \
    X(void, hdEnable, (::tact::hd::Enum capability))                              \
    X(void, hdDisable, (::tact::hd::Enum capability))                             \
    X(void, hdGetBooleanv, (::tact::hd::Enum name, ::tact::hd::Boolean * values)) \
    X(void, hdGetIntegerv, (::tact::hd::Enum name, int* values))                  \
    X(void, hdGetDoublev, (::tact::hd::Enum name, double* values))                \
    X(void, hdSetDoublev, (::tact::hd::Enum name, const double* values))          \
    X(const char*, hdGetString, (::tact::hd::Enum name))                          \
    X(::tact::hd::Enum, hdCheckCalibration, ())                                   \
    X(void, hdUpdateCalibration, (::tact::hd::Enum style))                        \
    X(void, hdStartScheduler, ())                                                 \
    X(void, hdStopScheduler, ())                                                  \
    X(void, hdSetSchedulerRate, (unsigned long rate_hz))                          \
    X(::tact::hd::SchedulerHandle, hdScheduleAsynchronous,                        \
      (::tact::hd::Callback callback, void* data, unsigned short priority))       \
    X(void, hdUnschedule, (::tact::hd::SchedulerHandle handle))

struct Api {
// NOLINTNEXTLINE(bugprone-macro-parentheses): a declaration has no parentheses here
#define TACT_HD_POINTER(type, name, arguments) type(*name) arguments = nullptr;
    TACT_HD_FUNCTIONS(TACT_HD_POINTER)
#undef TACT_HD_POINTER
};

}  // namespace tact::hd
