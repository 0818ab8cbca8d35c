#pragma once

// A number that carries a bound on how far an OpenCL device in single precision may be from it. The
// headers of kernels/ compile with it as their `real` in the namespace `tracked`, so that every
// evaluation of a device function yields, besides its value in double precision, the error that the
// OpenCL specification allows a device at that very place: a running error analysis (Wilkinson
// 1963; Higham 2002, section 3.3) with the unit errors of OpenCL 1.2, table 7.4 (full profile).
// Include this before anything of kernels/.

#include <cmath>
#include <cstdint>
#include <limits>

#ifdef KERNELS_NAMESPACE
#error "host/check/tracked.h has to come before the headers of kernels/"
#endif
#define KERNELS_NAMESPACE tracked
#define KERNELS_FOR_DEVICE // with the bounds of single precision

namespace reradiant::tracked {

using uint = std::uint32_t;

/// A device may flush what is smaller to zero.
constexpr double least_normal = 1.1754943508222875e-38;
/// One unit in the last place is at most this share of a number.
constexpr double unit_in_last_place = 0x1p-23;
constexpr double unbounded = std::numeric_limits<double>::infinity();

/// True when some comparison since it was cleared could have come out otherwise on the device.
inline thread_local bool undecided = false;

class Tracked {
public:
    double value, error;

    Tracked() = default;
    constexpr Tracked(double exact)
        : value(exact), error(static_cast<double>(static_cast<float>(exact)) == exact
                                  ? 0.0
                                  : 0.5 * unit_in_last_place * (exact < 0.0 ? -exact : exact)) {}
    constexpr Tracked(double v, double e) : value(v), error(e) {}

    explicit operator int() const { return static_cast<int>(whole()); }
    explicit operator uint() const { return static_cast<uint>(whole()); }
    explicit operator float() const { return static_cast<float>(value); }

    /// Towards zero; undecided where the error reaches over a whole number.
    double whole() const {
        const double result = std::trunc(value);
        undecided =
            undecided || std::trunc(value - error) != result || std::trunc(value + error) != result;
        return result;
    }

    Tracked& operator+=(Tracked other);
    Tracked& operator-=(Tracked other);
    Tracked& operator*=(Tracked other);
    Tracked& operator/=(Tracked other);
};

/// `value` of an operation whose inputs' errors make `propagated` of it, and which itself may be
/// wrong by `ulps`. What is exact stays exact.
inline Tracked rounded(double value, double propagated, double ulps) {
    if (propagated == 0.0 && ulps == 0.5 && static_cast<double>(static_cast<float>(value)) == value)
        return {value, 0.0};
    const double size = std::fabs(value) + propagated;
    return {value, std::isnan(propagated)
                       ? unbounded
                       : propagated + ulps * unit_in_last_place * size + least_normal};
}

inline Tracked operator-(Tracked a) {
    return {-a.value, a.error};
}
inline Tracked operator+(Tracked a, Tracked b) {
    return rounded(a.value + b.value, a.error + b.error, 0.5);
}
inline Tracked operator-(Tracked a, Tracked b) {
    return rounded(a.value - b.value, a.error + b.error, 0.5);
}
inline Tracked operator*(Tracked a, Tracked b) {
    return rounded(a.value * b.value,
                   std::fabs(a.value) * b.error + std::fabs(b.value) * a.error + a.error * b.error,
                   0.5);
}
inline Tracked operator/(Tracked a, Tracked b) {
    const double value = a.value / b.value, least = std::fabs(b.value) - b.error;
    return rounded(value, least > 0.0 ? (a.error + std::fabs(value) * b.error) / least : unbounded,
                   2.5);
}
inline Tracked& Tracked::operator+=(Tracked other) {
    return *this = *this + other;
}
inline Tracked& Tracked::operator-=(Tracked other) {
    return *this = *this - other;
}
inline Tracked& Tracked::operator*=(Tracked other) {
    return *this = *this * other;
}
inline Tracked& Tracked::operator/=(Tracked other) {
    return *this = *this / other;
}

/// a - b, where a comparison needs it.
inline double difference(Tracked a, Tracked b) {
    const double between = a.value - b.value, error = a.error + b.error;
    undecided = undecided || (error > 0.0 && std::fabs(between) <= error);
    return between;
}
inline bool operator<(Tracked a, Tracked b) {
    return difference(a, b) < 0.0;
}
inline bool operator>(Tracked a, Tracked b) {
    return difference(a, b) > 0.0;
}
inline bool operator<=(Tracked a, Tracked b) {
    return difference(a, b) <= 0.0;
}
inline bool operator>=(Tracked a, Tracked b) {
    return difference(a, b) >= 0.0;
}
inline bool operator==(Tracked a, Tracked b) {
    return difference(a, b) == 0.0;
}
inline bool operator!=(Tracked a, Tracked b) {
    return difference(a, b) != 0.0;
}

/// The larger or smaller one: neither of them can move it by more than its own error.
inline Tracked fmax(Tracked a, Tracked b) {
    const Tracked& larger = a.value >= b.value ? a : b;
    const Tracked& other = a.value >= b.value ? b : a;
    const double over = other.value + other.error - larger.value;
    return {larger.value, std::fmax(larger.error, over)};
}
inline Tracked fmin(Tracked a, Tracked b) {
    return -fmax(-a, -b);
}
inline Tracked fabs(Tracked a) {
    return {std::fabs(a.value), a.error};
}
/// A step: undecided where the error reaches over one.
inline Tracked floor(Tracked a) {
    const double result = std::floor(a.value);
    undecided = undecided || std::floor(a.value - a.error) != result ||
                std::floor(a.value + a.error) != result;
    return {result, 0.0};
}

/// Largest change of a monotonic function within the error of its argument.
template <typename Function>
double spread(Function function, double value, double low, double high) {
    return std::fmax(std::fabs(function(high) - value), std::fabs(value - function(low)));
}

inline Tracked sqrt(Tracked a) {
    const double value = std::sqrt(a.value);
    const double low = std::sqrt(std::fmax(a.value - a.error, 0.0));
    return rounded(value, std::fmax(std::sqrt(a.value + a.error) - value, value - low), 3.0);
}
inline Tracked exp(Tracked a) {
    const double value = std::exp(a.value);
    return rounded(value, value * std::expm1(a.error), 3.0);
}
inline Tracked expm1(Tracked a) {
    const double value = std::expm1(a.value);
    return rounded(value, std::exp(a.value) * std::expm1(a.error), 3.0);
}
inline Tracked log(Tracked a) {
    const double low = a.value - a.error;
    return rounded(std::log(a.value), low > 0.0 ? -std::log1p(-a.error / a.value) : unbounded, 3.0);
}
inline Tracked log1p(Tracked a) {
    const double low = a.value - a.error;
    return rounded(std::log1p(a.value),
                   low > -1.0 ? -std::log1p(-a.error / (1.0 + a.value)) : unbounded, 2.0);
}
inline Tracked sin(Tracked a) {
    return rounded(std::sin(a.value), std::fmin(a.error, 2.0), 4.0);
}
inline Tracked cos(Tracked a) {
    return rounded(std::cos(a.value), std::fmin(a.error, 2.0), 4.0);
}
inline Tracked atan2(Tracked y, Tracked x) {
    const double error = std::hypot(x.error, y.error);
    const double least = std::hypot(x.value, y.value) - error;
    return rounded(std::atan2(y.value, x.value),
                   error == 0.0 ? 0.0 : (least > 0.0 ? error / least : unbounded), 6.0);
}
inline Tracked erf(Tracked a) {
    const auto function = [](double x) { return std::erf(x); };
    const double value = std::erf(a.value);
    return rounded(value, spread(function, value, a.value - a.error, a.value + a.error), 16.0);
}
inline Tracked erfc(Tracked a) {
    const auto function = [](double x) { return std::erfc(x); };
    const double value = std::erfc(a.value);
    return rounded(value, spread(function, value, a.value - a.error, a.value + a.error), 16.0);
}

using real = Tracked;

} // namespace reradiant::tracked
