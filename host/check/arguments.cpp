#include "host/check/arguments.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace reradiant {

namespace {

/// Combinations of hard values beyond this many are sampled.
constexpr std::uint64_t most_hard_items = 20000;

void put_direction(double z, double phi, float* out) {
    const double s = std::sqrt((1.0 - z) * (1.0 + z));
    out[0] = static_cast<float>(s * std::cos(phi));
    out[1] = static_cast<float>(s * std::sin(phi));
    out[2] = static_cast<float>(z);
}

/// FNV-1a of a name: its stream of random numbers.
std::uint64_t stream_of(const std::string& name) {
    std::uint64_t hash = 14695981039346656037u;
    for (const char c : name)
        hash = (hash ^ static_cast<unsigned char>(c)) * 1099511628211u;
    return hash;
}

} // namespace

double InputRandom::uniform(double from, double to) {
    state_ += 0x9e3779b97f4a7c15u;
    std::uint64_t z = state_;
    z = (z ^ (z >> 30U)) * 0xbf58476d1ce4e5b9u;
    z = (z ^ (z >> 27U)) * 0x94d049bb133111ebu;
    z ^= z >> 31U;
    return from + (to - from) * static_cast<double>(z >> 11U) * 0x1p-53;
}

void Argument::draw(InputRandom& random, float* out) const {
    const auto any = [&] { return random.uniform(from, to); };
    const bool near_edge = random.uniform(0.0, 1.0) < 0.2;
    switch (kind) {
    case Kind::Uniform:
        *out = std::min(static_cast<float>(any()), std::nextafterf(static_cast<float>(to), -1e38f));
        return;
    case Kind::Logarithmic:
        *out = static_cast<float>(std::exp(random.uniform(std::log(from), std::log(to))));
        return;
    case Kind::Cosine:
        *out = static_cast<float>(near_edge ? std::pow(10.0, random.uniform(-8.0, 0.0)) : any());
        return;
    case Kind::NearOne: {
        const double off = std::pow(10.0, random.uniform(-7.0, -1.0));
        *out = static_cast<float>(near_edge ? 1.0 + std::copysign(off, random.uniform(-1.0, 1.0))
                                            : any());
        return;
    }
    case Kind::Direction:
        put_direction(near_edge ? std::pow(10.0, random.uniform(-6.0, 0.0))
                                : random.uniform(1e-6, 1.0),
                      random.uniform(0.0, 2.0 * std::numbers::pi), out);
        return;
    case Kind::Sphere:
        put_direction(random.uniform(-1.0, 1.0), random.uniform(0.0, 2.0 * std::numbers::pi), out);
        return;
    case Kind::Integer:
        *out = static_cast<float>(std::floor(any()));
        return;
    }
}

std::size_t width_of(const Arguments& arguments) {
    std::size_t width = 0;
    for (const Argument& argument : arguments)
        width += argument.width();
    return width;
}

InputSequence::InputSequence(const std::string& name, const Arguments& arguments)
    : arguments_(arguments), stream_(stream_of(name)), width_(width_of(arguments)),
      combinations_(1) {
    for (const Argument& argument : arguments)
        combinations_ *= std::min<std::uint64_t>(argument.hard_count(), 1U << 10U);
    hard_count_ = std::min(combinations_, most_hard_items);
}

void InputSequence::fill_hard(std::uint64_t item, float* out) const {
    InputRandom random(~stream_, item);
    std::uint64_t rest = item;
    for (const Argument& argument : arguments_) {
        const std::uint64_t count = argument.hard_count();
        const std::uint64_t choice =
            combinations_ > hard_count_
                ? static_cast<std::uint64_t>(random.uniform(0.0, static_cast<double>(count)))
                : rest % count;
        rest /= count;
        std::copy_n(argument.hard.begin() + static_cast<long>(choice * argument.width()),
                    argument.width(), out);
        out += argument.width();
    }
}

void InputSequence::fill(std::uint64_t first, std::span<float> inputs) const {
    for (std::size_t i = 0; i < inputs.size() / width_; ++i) {
        float* out = inputs.data() + i * width_;
        if (first + i < hard_count_) {
            fill_hard(first + i, out);
            continue;
        }
        InputRandom random(stream_, first + i);
        for (const Argument& argument : arguments_) {
            argument.draw(random, out);
            out += argument.width();
        }
    }
}

} // namespace reradiant
