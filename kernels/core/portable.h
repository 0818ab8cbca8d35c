// Lets the headers of the kernels compile both as OpenCL C 1.2 (single precision, on the device)
// and as C++ (double precision, for host tables, tests and debuggers). They keep to the common
// subset: no operators on vectors, no overloads, no templates.
#ifndef RERADIANT_PORTABLE_H
#define RERADIANT_PORTABLE_H

#ifdef __OPENCL_VERSION__

// `check --double` and `render --double` ask what single precision costs in digits and saves in
// time.
#ifdef KERNELS_IN_DOUBLE
#pragma OPENCL EXTENSION cl_khr_fp64 : enable
typedef double real;
#define REAL(x) x
#else
typedef float real;
#define REAL(x) x##f
#endif
#define DEVICE_FUNCTION
#define GLOBAL_CONST __global const
#define KERNELS_BEGIN
#define KERNELS_END

#else

#include <cmath>
#include <cstdint>

#define REAL(x) real(x)
#define DEVICE_FUNCTION inline
#define GLOBAL_CONST const
#define KERNELS_BEGIN namespace reradiant::KERNELS_NAMESPACE {
#define KERNELS_END }

// Who defines KERNELS_NAMESPACE first gives that namespace a `real` of its own and its functions
// (host/check/tracked.h).
#ifndef KERNELS_NAMESPACE
#define KERNELS_NAMESPACE kernels
namespace reradiant::kernels {
using real = double;
using uint = std::uint32_t;
using std::atan2;
using std::cos;
using std::erf;
using std::erfc;
using std::exp;
using std::expm1;
using std::fabs;
using std::floor;
using std::log;
using std::log1p;
using std::sin;
using std::sqrt;
/// The library's are calls, which cost more than what they do.
inline double fmax(double a, double b) {
    return a < b || a != a ? b : a;
}
inline double fmin(double a, double b) {
    return b < a || a != a ? b : a;
}
} // namespace reradiant::kernels
#endif

#endif

KERNELS_BEGIN

#define PI_REAL REAL(3.14159265358979323846)
#define INV_PI_REAL REAL(0.31830988618379067154)

/// A direction or point. Local frames have the shading normal along z.
typedef struct {
    real x, y, z;
} Vec3;

DEVICE_FUNCTION Vec3 vec3(real x, real y, real z) {
    Vec3 v;
    v.x = x;
    v.y = y;
    v.z = z;
    return v;
}
DEVICE_FUNCTION Vec3 vec3_add(Vec3 a, Vec3 b) {
    return vec3(a.x + b.x, a.y + b.y, a.z + b.z);
}
DEVICE_FUNCTION Vec3 vec3_sub(Vec3 a, Vec3 b) {
    return vec3(a.x - b.x, a.y - b.y, a.z - b.z);
}
DEVICE_FUNCTION Vec3 vec3_scale(Vec3 a, real s) {
    return vec3(a.x * s, a.y * s, a.z * s);
}
DEVICE_FUNCTION real vec3_dot(Vec3 a, Vec3 b) {
    return a.x * b.x + a.y * b.y + a.z * b.z;
}
DEVICE_FUNCTION Vec3 vec3_cross(Vec3 a, Vec3 b) {
    return vec3(a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x);
}
/// Unit vector; the argument must not be zero.
DEVICE_FUNCTION Vec3 vec3_normalise(Vec3 a) {
    return vec3_scale(a, REAL(1.0) / sqrt(vec3_dot(a, a)));
}
DEVICE_FUNCTION real square(real x) {
    return x * x;
}

KERNELS_END

#endif
