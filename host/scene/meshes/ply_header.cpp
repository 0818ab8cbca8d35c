#include "host/scene/meshes/ply_header.h"

#include "reradiant/error.h"

#include <charconv>
#include <sstream>

#include <fmt/core.h>

namespace reradiant {

namespace {

constexpr std::size_t MAX_HEADER_LINES = 1000, MAX_LINE_LENGTH = 1000;

bool type_from_name(const std::string& name, PlyType& type) {
    static const std::vector<std::pair<const char*, PlyType>> names{
        {"char", PlyType::Int8},      {"int8", PlyType::Int8},       {"uchar", PlyType::Uint8},
        {"uint8", PlyType::Uint8},    {"short", PlyType::Int16},     {"int16", PlyType::Int16},
        {"ushort", PlyType::Uint16},  {"uint16", PlyType::Uint16},   {"int", PlyType::Int32},
        {"int32", PlyType::Int32},    {"uint", PlyType::Uint32},     {"uint32", PlyType::Uint32},
        {"float", PlyType::Float32},  {"float32", PlyType::Float32}, {"double", PlyType::Float64},
        {"float64", PlyType::Float64}};
    for (const auto& [known, value] : names)
        if (name == known) {
            type = value;
            return true;
        }
    return false;
}

/// The first line says how lines end. Where it is CR LF the header may not end at its CR: the LF
/// would become the first byte of binary data.
char line_end_of(std::string_view bytes) {
    const std::size_t end = bytes.find_first_of("\r\n");
    const bool is_cr_only = end != std::string_view::npos && bytes[end] == '\r' &&
                            !bytes.substr(end).starts_with("\r\n");
    return is_cr_only ? '\r' : '\n';
}

class HeaderReader {
public:
    HeaderReader(const std::filesystem::path& file, std::string_view bytes)
        : file_(file.string()), bytes_(bytes), line_end_(line_end_of(bytes)) {}

    PlyHeader read();

private:
    std::vector<std::string> next_line();
    void read_format(const std::vector<std::string>& words);
    void read_element(const std::vector<std::string>& words);
    void read_property(const std::vector<std::string>& words);
    void check_counts() const;
    [[noreturn]] void fail(const std::string& wrong, const std::string& remedy) const {
        throw_input_error({file_, header_.line_count, 1}, wrong, remedy);
    }

    std::string file_;
    std::string_view bytes_;
    char line_end_;
    PlyHeader header_;
};

std::vector<std::string> HeaderReader::next_line() {
    ++header_.line_count;
    const std::string_view rest = bytes_.substr(header_.size);
    const std::size_t length = rest.substr(0, MAX_LINE_LENGTH).find(line_end_);
    if (length == std::string_view::npos || header_.line_count > static_cast<int>(MAX_HEADER_LINES))
        fail("the PLY header does not end", "it ends with a line end_header");
    header_.size += length + 1;
    std::istringstream line{std::string(rest.substr(0, length))};
    std::vector<std::string> words;
    for (std::string word; line >> word;)
        words.push_back(word);
    return words;
}

void HeaderReader::read_format(const std::vector<std::string>& words) {
    const std::string name = words.size() == 3 && words[2] == "1.0" ? words[1] : "";
    if (name == "ascii")
        header_.format = PlyFormat::Ascii;
    else if (name == "binary_little_endian")
        header_.format = PlyFormat::LittleEndian;
    else if (name == "binary_big_endian")
        header_.format = PlyFormat::BigEndian;
    else
        fail("the PLY format is not known",
             "write format ascii, binary_little_endian or binary_big_endian, then 1.0");
}

void HeaderReader::read_element(const std::vector<std::string>& words) {
    PlyElement element;
    element.line = header_.line_count;
    if (words.size() != 3)
        fail("an element line has not three words", "write element NAME COUNT");
    element.name = words[1];
    const char* end = words[2].data() + words[2].size();
    const auto result = std::from_chars(words[2].data(), end, element.count);
    if (result.ec != std::errc() || result.ptr != end)
        fail(fmt::format("the count of element {} is \"{}\"", element.name, words[2]),
             "write a whole number that is not negative");
    header_.elements.push_back(element);
}

void HeaderReader::read_property(const std::vector<std::string>& words) {
    if (header_.elements.empty())
        fail("a property stands before the first element", "write element NAME COUNT before it");
    PlyProperty property;
    property.is_list = words.size() == 5 && words[1] == "list";
    if (!property.is_list && words.size() != 3)
        fail("a property line is not understood",
             "write property TYPE NAME or property list TYPE TYPE NAME");
    property.name = words.back();
    const std::string& type = words[words.size() - 2];
    if (!type_from_name(type, property.type))
        fail(fmt::format("\"{}\" is no PLY type", type), "use int, uint, float, double, ...");
    if (property.is_list &&
        (!type_from_name(words[2], property.count_type) ||
         property.count_type == PlyType::Float32 || property.count_type == PlyType::Float64))
        fail(fmt::format("\"{}\" is no type for a count", words[2]), "use an integer type");
    header_.elements.back().properties.push_back(property);
}

/// Memory and time later follow the counts, so they must be such as the file can hold.
void HeaderReader::check_counts() const {
    std::uint64_t available = bytes_.size() - header_.size;
    // The last value of an ascii file needs no separator after it.
    if (header_.format == PlyFormat::Ascii)
        ++available;
    for (const PlyElement& element : header_.elements) {
        std::uint64_t smallest = 0;
        for (const PlyProperty& property : element.properties)
            smallest += header_.format == PlyFormat::Ascii ? 2
                        : property.is_list                 ? ply_type_size(property.count_type)
                                                           : ply_type_size(property.type);
        if (smallest != 0 && element.count > available / smallest)
            throw_input_error({file_, element.line, 1},
                              fmt::format("{} elements {} do not fit in the {} bytes left",
                                          element.count, element.name, available),
                              "the file is truncated or the count is wrong");
        available -= element.count * smallest;
    }
}

PlyHeader HeaderReader::read() {
    if (next_line() != std::vector<std::string>{"ply"})
        fail("this is not a PLY file", "its first line is ply");
    bool has_format = false;
    for (auto words = next_line(); words != std::vector<std::string>{"end_header"};
         words = next_line()) {
        if (words.empty() || words[0] == "comment" || words[0] == "obj_info")
            continue;
        if (words[0] == "format") {
            read_format(words);
            has_format = true;
        } else if (words[0] == "element") {
            read_element(words);
        } else if (words[0] == "property") {
            read_property(words);
        } else {
            fail(fmt::format("\"{}\" is no line of a PLY header", words[0].substr(0, 40)),
                 "use format, comment, element, property, end_header");
        }
    }
    if (!has_format)
        fail("the PLY header has no format line", "write format ascii 1.0");
    check_counts();
    return header_;
}

} // namespace

std::size_t ply_type_size(PlyType type) {
    switch (type) {
    case PlyType::Int8:
    case PlyType::Uint8:
        return 1;
    case PlyType::Int16:
    case PlyType::Uint16:
        return 2;
    case PlyType::Float64:
        return 8;
    default:
        return 4;
    }
}

int PlyElement::index_of(std::string_view property) const {
    for (std::size_t i = 0; i < properties.size(); ++i)
        if (properties[i].name == property)
            return static_cast<int>(i);
    return -1;
}

PlyHeader read_ply_header(const std::filesystem::path& file, std::string_view bytes) {
    return HeaderReader(file, bytes).read();
}

} // namespace reradiant
