#include "host/spectral/text/text_format.h"

#include "host/base/plain_text.h"
#include "host/base/regular_file.h"
#include "reradiant/error.h"

#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <system_error>

namespace reradiant {

namespace {

constexpr std::uintmax_t most_bytes = 64u << 20;
constexpr std::string_view blanks = " \t\r\n\f\v";

struct Signature {
    std::string_view bytes, name, remedy;
};
constexpr std::string_view save_as_csv = "save the sheet as CSV in UTF-8";
constexpr std::string_view save_as_utf8 = "save it as UTF-8";
constexpr std::string_view unpack = "unpack it first";
constexpr std::string_view give_text = "give the numbers as text";
constexpr std::string_view save_table = "save the numbers as CSV";
constexpr std::array signatures{
    Signature{"PK\x03\x04", "a Zip archive (.xlsx, .ods, .zip)", save_as_csv},
    Signature{"PK\x05\x06", "an empty Zip archive", save_as_csv},
    Signature{"\xd0\xcf\x11\xe0", "an OLE2 document (.xls, .doc)", save_as_csv},
    Signature{"%PDF", "a PDF document", give_text},
    Signature{"\x76\x2f\x31\x01", "an OpenEXR image", "name it .exr"},
    Signature{"\x89PNG", "a PNG image", give_text},
    Signature{"\xff\xd8\xff", "a JPEG image", give_text},
    Signature{"II*", "a TIFF image", give_text},
    Signature{"\x89HDF", "an HDF5 file (.h5, .mat)", give_text},
    Signature{"MATLAB", "a MATLAB file", give_text},
    Signature{"\x93NUMPY", "a numpy array (.npy)", "save it by numpy.savetxt"},
    Signature{"\x1f\x8b", "compressed by gzip", unpack},
    Signature{"BZh", "compressed by bzip2", unpack},
    Signature{"\xfd"
              "7zXZ",
              "compressed by xz", unpack},
    Signature{"7z\xbc\xaf", "a 7-Zip archive", unpack},
    Signature{"{\\rtf", "an RTF document", "save it as plain text"},
    Signature{"%!PS", "a PostScript document", give_text},
    Signature{"%%MatrixMarket", "a Matrix Market file", save_table},
    Signature{"ISO-10303-21", "a STEP file", save_table},
    Signature{"#?RADIANCE", "a Radiance image (.hdr)", give_text},
    Signature{"#?RGBE", "a Radiance image (.hdr)", give_text},
};
// These begin with NUL bytes or are told from another by them, so string literals would end early.
constexpr std::string_view utf32_marks[] = {{"\xff\xfe\0\0", 4}, {"\0\0\xfe\xff", 4}};
constexpr std::string_view utf16_marks[] = {{"\xff\xfe", 2}, {"\xfe\xff", 2}};

/// Formats that say what they are by a first line which is this and nothing else.
constexpr std::array first_lines{
    Signature{"ply", "a PLY mesh", save_table}, Signature{"OFF", "an OFF mesh", save_table},
    Signature{"P1", "a PBM image", save_table}, Signature{"P2", "a PGM image", save_table},
    Signature{"P3", "a PPM image", save_table},
};

[[noreturn]] void refuse(const std::string& name, std::string_view what, std::string_view remedy) {
    throw_input_error({name, 1, 1}, fmt::format("the file is {}, not a text of numbers", what),
                      std::string(remedy));
}

/// Refuses by name what is no text.
void refuse_binary(const std::string& name, std::string_view bytes) {
    const auto begins_with = [&](std::string_view mark) { return bytes.starts_with(mark); };
    for (const Signature& signature : signatures)
        if (begins_with(signature.bytes))
            refuse(name, signature.name, signature.remedy);
    const std::string_view first_line = bytes.substr(0, bytes.find_first_of("\r\n"));
    for (const Signature& line : first_lines)
        if (first_line == line.bytes)
            refuse(name, line.name, line.remedy);
    if (std::any_of(std::begin(utf32_marks), std::end(utf32_marks), begins_with))
        refuse(name, "UTF-32", save_as_utf8);
    if (std::any_of(std::begin(utf16_marks), std::end(utf16_marks), begins_with))
        refuse(name, "UTF-16", save_as_utf8);
    const auto zero = bytes.find('\0');
    if (zero == std::string_view::npos)
        return;
    // Numbers in UTF-16 without a mark have a NUL in every other place.
    if (zero <= 1 && bytes.size() > 3 && bytes[zero + 2 < bytes.size() ? zero + 2 : 0] == '\0')
        refuse(name, "UTF-16 without a byte order mark", save_as_utf8);
    const auto line = std::count(bytes.begin(), bytes.begin() + static_cast<long>(zero), '\n') + 1;
    throw_input_error({name, static_cast<int>(line), 0}, "the file holds NUL bytes: it is no text",
                      std::string(give_text));
}

std::string upper_case(std::string_view text) {
    std::string upper(text);
    std::transform(upper.begin(), upper.end(), upper.begin(),
                   [](unsigned char c) { return static_cast<char>(std::toupper(c)); });
    return upper;
}

TextFormat xml_format(std::string_view text) {
    constexpr std::size_t head_bytes = 4096;
    const std::string head = upper_case(text.substr(0, head_bytes));
    if (head.find("<IESTM27") != std::string::npos)
        return TextFormat::Tm27;
    if (head.find("<HTML") != std::string::npos || head.find("<!DOCTYPE HTML") == 0)
        return TextFormat::Html;
    return TextFormat::Xml;
}

/// True when some line is a record of JCAMP-DX: "##XUNITS=". Remarks of programs may stand before
/// it, and "## author=me" is a comment.
bool has_jcamp_record(std::string_view text) {
    constexpr std::array<std::string_view, 14> labels{
        "TITLE",    "JCAMPDX", "JCAMPCS",   "DATATYPE", "XUNITS", "YUNITS", "XYDATA",
        "XYPOINTS", "NPOINTS", "PEAKTABLE", "NTUPLES",  "FIRSTX", "LASTX",  "YFACTOR"};
    for (std::size_t start = 0; start < text.size();) {
        const auto end = std::min(text.find('\n', start), text.size());
        std::string_view line = text.substr(start, end - start);
        start = end + 1;
        line.remove_prefix(std::min(line.find_first_not_of(" \t"), line.size()));
        const auto equals = line.find('=');
        if (!line.starts_with("##") || equals == std::string_view::npos)
            continue;
        std::string label = upper_case(line.substr(2, equals - 2));
        std::erase_if(label, [](char c) {
            return std::string_view(" \t-/_").find(c) != std::string_view::npos;
        });
        if (std::find(labels.begin(), labels.end(), label) != labels.end())
            return true;
    }
    return false;
}

/// True when some line begins with the word BEGIN_DATA or BEGIN_DATA_FORMAT.
bool has_cgats_data(std::string_view text) {
    constexpr std::string_view word = "BEGIN_DATA";
    for (auto at = text.find(word); at != std::string_view::npos; at = text.find(word, at + 1)) {
        const auto before = text.find_last_not_of(" \t", at == 0 ? 0 : at - 1);
        if (at == 0 || before == std::string_view::npos || text[before] == '\n')
            return true;
    }
    return false;
}

} // namespace

std::string_view text_format_name(TextFormat format) {
    switch (format) {
    case TextFormat::Table:
        return "a table of numbers";
    case TextFormat::JcampDx:
        return "a JCAMP-DX spectrum";
    case TextFormat::Cgats:
        return "CGATS data";
    case TextFormat::Tm27:
        return "an IES TM-27 spectrum (.spdx)";
    case TextFormat::Bfc:
        return "a BFC-450 matrix (.bfc)";
    case TextFormat::Xml:
        return "XML";
    case TextFormat::Html:
        return "an HTML page";
    case TextFormat::Json:
        return "JSON or TOML";
    case TextFormat::IesPhotometry:
        return "IES photometry (LM-63), which holds no spectrum";
    }
    return "a text";
}

std::string read_text_file(const std::filesystem::path& file) {
    const std::string name = file.string();
    std::error_code code;
    const auto size = std::filesystem::file_size(file, code);
    if (code)
        throw_input_error({name}, fmt::format("cannot be read: {}", code.message()),
                          "name an existing file");
    if (size > most_bytes)
        throw_input_error({name}, fmt::format("{} bytes are too many", size),
                          fmt::format("at most {} are read", most_bytes));
    std::string bytes(static_cast<std::size_t>(size), '\0');
    std::ifstream stream = open_regular_file(file);
    if (!stream.read(bytes.data(), static_cast<std::streamsize>(size)))
        throw_input_error({name}, "cannot be read", "check its permissions");
    refuse_binary(name, bytes);
    return plain_text(bytes);
}

TextFormat text_format(std::string_view text) {
    const auto first = text.find_first_not_of(blanks);
    if (first == std::string_view::npos)
        return TextFormat::Table;
    text.remove_prefix(first);
    if (text.front() == '<')
        return xml_format(text);
    if (text.front() == '{' || text.front() == '[')
        return TextFormat::Json;
    if (text.starts_with("VEC_01"))
        return TextFormat::Bfc;
    if (text.starts_with("IESNA"))
        return TextFormat::IesPhotometry;
    if (has_jcamp_record(text))
        return TextFormat::JcampDx;
    if (text.starts_with("CGATS") || text.starts_with("IT8.7/") || has_cgats_data(text))
        return TextFormat::Cgats;
    return TextFormat::Table;
}

TextFormat text_format_of(const std::filesystem::path& file) {
    return text_format(read_text_file(file));
}

} // namespace reradiant
