// The part of the Force Dimension SDK that is used: types, numbers and functions, without its headers.
//
// Source   the library's published programming interface (DHD and DRD, versions 3.7 to 3.17). The argument
//          types are those of the 64-bit Linux library, whose bool and unsigned char are one byte; the tests
//          build their own library against this file.
// Units    metres, newtons, newton metres, radians; frame: x to the user, y right, z up
// Errors   a negative result; dhdErrorGetLast() of the same thread has the code. Results 1 (TimeGuard: the
//          data of the last communication) and 2 (a motor saturated) are no errors.
#pragma once

#include <cstddef>

namespace tact::fd {

inline constexpr int kOn = 1, kOff = 0;
inline constexpr int kTimeGuard = 1, kMotorSaturated = 2;
inline constexpr int kTimeGuardDefault = -1;
// dhdGetStatus writes 16 or 17 numbers, depending on the version; the buffer has room for more.
inline constexpr std::size_t kStatusRoom = 32;
// Reset: 1 while the device waits to be initialized.
inline constexpr std::size_t kStatusPower = 0, kStatusConnected = 1, kStatusReset = 3, kStatusForce = 5,
                             kStatusWristDetected = 8, kStatusError = 9, kStatusWristInit = 12,
                             kStatusForceOffCause = 14;
inline constexpr int kForceOffNone = 0, kForceOffButton = 1, kForceOffVelocity = 2, kForceOffWatchdog = 3,
                     kForceOffSoftware = 4, kForceOffUsb = 5, kForceOffDeadMan = 6;
inline constexpr int kVelocityWindowing = 0;

// Error codes.
inline constexpr int kNoError = 0, kError = 1, kErrorCom = 2, kErrorBusy = 3, kErrorNoDriver = 4,
                     kErrorNoDevice = 5, kErrorNotAvailable = 6, kErrorTimeout = 7, kErrorGeometry = 8,
                     kErrorExpertMode = 9, kErrorNotReady = 12, kErrorConfiguration = 14,
                     kErrorRedundantFail = 18, kErrorNotEnabled = 19, kErrorInUse = 20;

// One row per function: X(return type, name, arguments). The only list of them.
#define TACT_FD_FUNCTIONS(X)                                                                                \
    X(int, dhdErrorGetLast, ())                                                                             \
    X(const char*, dhdErrorGetLastStr, ())                                                                  \
    X(void, dhdGetSDKVersion, (int* major, int* minor, int* release, int* revision))                        \
    X(int, dhdGetDeviceCount, ())                                                                           \
    X(int, dhdOpenID, (char index))                                                                         \
    X(int, dhdClose, (char id))                                                                             \
    X(int, dhdStop, (char id))                                                                              \
    X(int, dhdGetSystemType, (char id))                                                                     \
    X(const char*, dhdGetSystemName, (char id))                                                             \
    X(int, dhdGetSerialNumber, (unsigned short* serial, char id))                                           \
    X(int, dhdGetStatus, (int* status, char id))                                                            \
    X(bool, dhdIsLeftHanded, (char id))                                                                     \
    X(bool, dhdHasWrist, (char id))                                                                         \
    X(bool, dhdHasActiveWrist, (char id))                                                                   \
    X(bool, dhdHasGripper, (char id))                                                                       \
    X(int, dhdEnableExpertMode, ())                                                                         \
    X(int, dhdSetTimeGuard, (int microseconds, char id))                                                    \
    X(int, dhdSetWatchdog, (unsigned char eighths_of_a_ms, char id))                                        \
    X(int, dhdSetGravityCompensation, (int on, char id))                                                    \
    X(int, dhdSetBrakes, (int on, char id))                                                                 \
    X(int, dhdEnableForce, (unsigned char on, char id))                                                     \
    X(int, dhdConfigLinearVelocity, (int ms, int mode, char id))                                            \
    X(int, dhdConfigAngularVelocity, (int ms, int mode, char id))                                           \
    X(int, dhdGetPosition, (double* px, double* py, double* pz, char id))                                   \
    X(int, dhdGetPositionAndOrientationFrame, (double* px, double* py, double* pz, double(*r)[3], char id)) \
    X(int, dhdGetLinearVelocity, (double* vx, double* vy, double* vz, char id))                             \
    X(int, dhdGetAngularVelocityRad, (double* wx, double* wy, double* wz, char id))                         \
    X(int, dhdGetGripperAngleRad, (double* angle, char id))                                                 \
    X(unsigned, dhdGetButtonMask, (char id))                                                                \
    X(double, dhdGetComFreq, (char id))                                                                     \
    X(int, dhdSetForceAndTorqueAndGripperForce,                                                             \
      (double fx, double fy, double fz, double tx, double ty, double tz, double gripper, char id))

// Of libdrd alone, which contains libdhd: all or none of them are there.
#define TACT_FD_ROBOT_FUNCTIONS(X)       \
    X(int, drdOpenID, (char index))      \
    X(int, drdClose, (char id))          \
    X(bool, drdIsInitialized, (char id)) \
    X(int, drdAutoInit, (char id))       \
    X(int, drdStop, (bool force, char id))

struct Api {
// NOLINTNEXTLINE(bugprone-macro-parentheses): a declaration has no parentheses here
#define TACT_FD_POINTER(type, name, arguments) type(*name) arguments = nullptr;
    TACT_FD_FUNCTIONS(TACT_FD_POINTER)
    TACT_FD_ROBOT_FUNCTIONS(TACT_FD_POINTER)
#undef TACT_FD_POINTER
    bool robot = false;  // the functions of libdrd are there
};

}  // namespace tact::fd
