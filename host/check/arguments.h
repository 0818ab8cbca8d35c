#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

namespace reradiant {

/// Counter-based numbers (splitmix64, Steele, Lea and Flood 2014), so that item i of a function has
/// the same inputs whatever the number of items and of threads.
class InputRandom {
public:
    InputRandom(std::uint64_t stream, std::uint64_t item)
        : state_(stream + item * 0x9e3779b97f4a7c15u * 64u) {}
    double uniform(double from, double to);

private:
    std::uint64_t state_;
};

/// One argument of a checked function: what its random inputs look like, and the hard values.
struct Argument {
    enum class Kind {
        Uniform,     ///< between `from` and `to`
        Logarithmic, ///< the logarithm uniform
        Cosine,      ///< 0..1, one in five near 0
        NearOne,     ///< uniform, one in five close to 1: 1 +- 1e-7 to 0.1
        Direction,   ///< three numbers: unit vector of the upper hemisphere, one in five grazing
        Sphere,      ///< three numbers: any unit vector
        Integer      ///< from .. to - 1
    };
    Kind kind = Kind::Uniform;
    double from = 0.0, to = 1.0;
    std::vector<float> hard; ///< values one after the other (directions: three each)

    std::size_t width() const { return kind == Kind::Direction || kind == Kind::Sphere ? 3 : 1; }
    std::size_t hard_count() const { return hard.size() / width(); }
    void draw(InputRandom& random, float* out) const;
};

using Arguments = std::vector<Argument>;

std::size_t width_of(const Arguments& arguments);

/// Inputs of a function: first combinations of hard values (all of them, or so many chosen at
/// random), then random ones.
class InputSequence {
public:
    InputSequence(const std::string& name, const Arguments& arguments);
    std::size_t hard_count() const { return hard_count_; }
    std::size_t width() const { return width_; }
    void fill(std::uint64_t first, std::span<float> inputs) const;

private:
    void fill_hard(std::uint64_t item, float* out) const;

    const Arguments& arguments_;
    std::uint64_t stream_;
    std::size_t width_;
    std::uint64_t combinations_, hard_count_;
};

} // namespace reradiant
