#include "host/render/checkpoint/work_checkpoint.h"

#include "host/base/atomic_file.h"
#include "host/base/regular_file.h"
#include "host/scene/model/sha256.h"
#include "reradiant/error.h"

#include <string>
#include <string_view>

namespace reradiant {

namespace fs = std::filesystem;
using Json = nlohmann::json;

namespace {

constexpr std::string_view format_name = "reradiant work checkpoint 1\n";
constexpr std::size_t digest_characters = 64;
constexpr std::uintmax_t most_bytes = std::uintmax_t{1} << 30;
/// States have a dozen. The parser of CBOR calls itself for every one.
constexpr int most_nesting = 64;

[[noreturn]] void refuse(const fs::path& file, const std::string& why) {
    throw_input_error({file.string()}, "is no whole checkpoint: " + why,
                      "remove it and begin anew");
}

std::string sha256_of(std::string_view bytes) {
    Sha256 sha;
    sha.update(bytes);
    return sha.hex();
}

std::string whole_file(const fs::path& file) {
    std::ifstream stream = open_regular_file(file);
    std::error_code code;
    const std::uintmax_t size = fs::file_size(file, code);
    if (!stream || code)
        throw_input_error({file.string()}, "the checkpoint cannot be read",
                          "check its permissions, or leave --resume away");
    if (size > most_bytes)
        refuse(file, "it is larger than any");
    std::string bytes(size, ' ');
    stream.read(bytes.data(), static_cast<std::streamsize>(size));
    bytes.resize(static_cast<std::size_t>(stream.gcount()));
    return bytes;
}

/// Hears what a parser finds and stops it where containers are nested too deep.
class NestingCheck : public nlohmann::json_sax<Json> {
public:
    bool null() override { return true; }
    bool boolean(bool) override { return true; }
    bool number_integer(number_integer_t) override { return true; }
    bool number_unsigned(number_unsigned_t) override { return true; }
    bool number_float(number_float_t, const string_t&) override { return true; }
    bool string(string_t&) override { return true; }
    bool binary(binary_t&) override { return true; }
    bool key(string_t&) override { return true; }
    bool start_object(std::size_t) override { return ++nesting_ <= most_nesting; }
    bool start_array(std::size_t) override { return ++nesting_ <= most_nesting; }
    bool end_object() override { return leave(); }
    bool end_array() override { return leave(); }
    bool parse_error(std::size_t, const std::string&, const nlohmann::detail::exception&) override {
        return false;
    }

private:
    bool leave() {
        --nesting_;
        return true;
    }

    int nesting_ = 0;
};

Json parsed(const fs::path& file, std::string_view cbor) {
    NestingCheck check;
    if (!Json::sax_parse(cbor.begin(), cbor.end(), &check, Json::input_format_t::cbor))
        refuse(file, "it is nested too deep or no CBOR");
    return Json::from_cbor(cbor.begin(), cbor.end());
}

} // namespace

void write_work_checkpoint(const fs::path& file, const SampleIdentity& identity,
                           const Json& state) {
    const std::vector<std::uint8_t> cbor =
        Json::to_cbor({{"identity", identity}, {"state", state}});
    std::string text(format_name);
    text.append(cbor.begin(), cbor.end());
    write_text_atomically(file, text + sha256_of(text));
}

Json read_work_checkpoint(const fs::path& file, const SampleIdentity& identity) {
    const std::string bytes = whole_file(file);
    if (!bytes.starts_with(format_name) || bytes.size() < format_name.size() + digest_characters)
        refuse(file, "it does not begin like one of this version, or is cut off");
    const std::string_view text(bytes.data(), bytes.size() - digest_characters);
    if (sha256_of(text) != std::string_view(bytes).substr(text.size()))
        refuse(file, "its checksum is wrong");
    try {
        Json json = parsed(file, text.substr(format_name.size()));
        if (const auto difference =
                identity_difference(identity, json.at("identity").get<SampleIdentity>()))
            throw_input_error({file.string()}, "the checkpoint is of other work: " + *difference,
                              "go on with what it was made with, or leave --resume away");
        return std::move(json.at("state"));
    } catch (const Json::exception& error) {
        refuse(file, error.what());
    }
}

} // namespace reradiant
