#include "host/scene/meshes/ply_values.h"

#include <algorithm>
#include <array>
#include <bit>
#include <charconv>
#include <limits>

namespace reradiant {

namespace {

/// Form feeds, and the control-Z with which old systems end a text, stand between values too.
constexpr std::string_view blanks = " \t\r\n\f\v\x1a";

} // namespace

void PlyValues::skip_blanks() {
    for (; next_ < bytes_.size() && blanks.find(bytes_[next_]) != blanks.npos; ++next_) {
        const bool ends_line = bytes_[next_] == '\n' ||
                               (bytes_[next_] == '\r' && !bytes_.substr(next_).starts_with("\r\n"));
        if (ends_line) {
            ++line_;
            line_start_ = next_ + 1;
        }
    }
    start_ = next_;
}

bool PlyValues::has_more() {
    if (format_ == PlyFormat::Ascii)
        skip_blanks();
    start_ = next_;
    return next_ < bytes_.size();
}

double PlyValues::next_ascii(const PlyItem& what) {
    skip_blanks();
    const std::size_t end = std::min(bytes_.find_first_of(blanks, next_), bytes_.size());
    const std::string_view token = bytes_.substr(start_, end - start_);
    next_ = end;
    if (token.empty())
        throw_input_error(position(), fmt::format("the file ends before {}", what.text()),
                          "the file is truncated or a count is wrong");
    double value = 0.0;
    const auto [stop, failure] = std::from_chars(token.data(), token.data() + token.size(), value);
    if (failure == std::errc::result_out_of_range)
        return std::numeric_limits<double>::infinity();
    if (failure != std::errc() || stop != token.data() + token.size())
        throw_input_error(position(), fmt::format("{} is \"{}\"", what.text(), token.substr(0, 40)),
                          "write a number");
    return value;
}

double PlyValues::next_binary(PlyType type, const PlyItem& what) {
    const std::size_t size = ply_type_size(type);
    start_ = next_;
    if (remaining() < size)
        throw_input_error({file_},
                          fmt::format("the file ends before {}{}", what.text(), byte_text()),
                          "the file is truncated or a count is wrong");
    std::array<unsigned char, 8> raw{};
    std::memcpy(raw.data(), bytes_.data() + next_, size);
    next_ += size;
    if ((format_ == PlyFormat::BigEndian) != (std::endian::native == std::endian::big))
        std::reverse(raw.begin(), raw.begin() + static_cast<std::ptrdiff_t>(size));
    switch (type) {
    case PlyType::Int8:
        return decode<std::int8_t>(raw.data());
    case PlyType::Uint8:
        return decode<std::uint8_t>(raw.data());
    case PlyType::Int16:
        return decode<std::int16_t>(raw.data());
    case PlyType::Uint16:
        return decode<std::uint16_t>(raw.data());
    case PlyType::Int32:
        return decode<std::int32_t>(raw.data());
    case PlyType::Uint32:
        return decode<std::uint32_t>(raw.data());
    case PlyType::Float32:
        return decode<float>(raw.data());
    default:
        return decode<double>(raw.data());
    }
}

} // namespace reradiant
