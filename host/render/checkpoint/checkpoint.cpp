#include "host/render/checkpoint/checkpoint.h"

#include "host/base/atomic_file.h"
#include "host/base/json_numbers.h"
#include "host/base/regular_file.h"
#include "host/scene/model/sha256.h"
#include "reradiant/error.h"

#include <fmt/core.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <bit>
#include <cerrno>
#include <cmath>
#include <cstring>
#include <fstream>
#include <span>
#include <string_view>

namespace reradiant {

namespace fs = std::filesystem;

namespace {

static_assert(std::endian::native == std::endian::little,
              "checkpoints hold the floats as they are");

constexpr const char* format_name = "reradiant render checkpoint 2";
constexpr std::uint64_t most_header_bytes = 1u << 20;
constexpr std::uint64_t digest_bytes = 64;

/// Infinity has no name in JSON.
nlohmann::json pass_json(const RenderProgress& pass) {
    const auto finite_or_null = [](double value) {
        return std::isfinite(value) ? nlohmann::json(value) : nlohmann::json();
    };
    return {pass.samples, pass.seconds, finite_or_null(pass.relmse), pass.relmse_low,
            finite_or_null(pass.relmse_high)};
}

RenderProgress pass_from(const nlohmann::json& json) {
    RenderProgress pass;
    pass.samples = whole_number<std::uint32_t>(json.at(0));
    pass.seconds = json.at(1).get<double>();
    if (!json.at(2).is_null())
        pass.relmse = json.at(2).get<double>();
    pass.relmse_low = json.at(3).get<double>();
    if (!json.at(4).is_null())
        pass.relmse_high = json.at(4).get<double>();
    return pass;
}

std::string header_text(const RenderCheckpoint& head, FilmSums films) {
    std::size_t sums = 0, statistics = 0;
    for (const FilmStrip& strip : films) {
        sums += strip.sums.size();
        statistics += strip.statistics.size();
    }
    nlohmann::json passes = nlohmann::json::array();
    for (const RenderProgress& pass : head.passes)
        passes.push_back(pass_json(pass));
    const nlohmann::json json = {
        {"identity", head.identity}, {"passes", passes}, {"paths", head.paths},
        {"rays", head.rays},         {"sums", sums},     {"statistics", statistics}};
    return fmt::format("{}\n{}\n", format_name, json.dump());
}

[[noreturn]] void refuse(const fs::path& file, const std::string& why) {
    throw_input_error({file.string()}, "is no whole checkpoint: " + why,
                      "remove it and render from the start");
}

std::string_view bytes_of(std::span<const float> values) {
    return {reinterpret_cast<const char*>(values.data()), values.size_bytes()};
}

/// A file that is read piece by piece while its digest is made.
class DigestedInput {
public:
    explicit DigestedInput(const fs::path& file) : file_(file), stream_(open_regular_file(file)) {
        std::error_code code;
        size_ = fs::file_size(file, code);
        if (!stream_ || code)
            throw_input_error({file.string()}, "the checkpoint cannot be read",
                              "check its permissions, or leave --resume away");
    }
    std::string line() {
        std::string text;
        for (char c; stream_.get(c) && text.size() < most_header_bytes;) {
            text += c;
            if (c == '\n') {
                sha_.update(text);
                text.pop_back();
                return text;
            }
        }
        refuse(file_, "its header has no end");
    }
    void floats(std::vector<float>& values) {
        stream_.read(reinterpret_cast<char*>(values.data()),
                     static_cast<std::streamsize>(values.size() * sizeof(float)));
        if (!stream_)
            refuse(file_, "it is cut off");
        sha_.update(bytes_of(values));
    }
    void check_digest() {
        std::string digest(digest_bytes, ' ');
        stream_.read(digest.data(), static_cast<std::streamsize>(digest.size()));
        if (!stream_ || digest != sha_.hex())
            refuse(file_, "its checksum is wrong");
    }
    std::uint64_t left() {
        return size_ - static_cast<std::uint64_t>(std::max<std::streamoff>(stream_.tellg(), 0));
    }

private:
    fs::path file_;
    std::ifstream stream_;
    std::uint64_t size_ = 0;
    Sha256 sha_;
};

struct CheckpointSizes {
    std::uint64_t sums = 0, statistics = 0;
};

CheckpointSizes parse_header(const fs::path& file, const std::string& text,
                             RenderCheckpoint& checkpoint) {
    try {
        const nlohmann::json json = nlohmann::json::parse(text);
        checkpoint.identity = json.at("identity").get<SampleIdentity>();
        for (const nlohmann::json& pass : json.at("passes"))
            checkpoint.passes.push_back(pass_from(pass));
        checkpoint.paths = whole_number<std::uint64_t>(json.at("paths"));
        checkpoint.rays = whole_number<std::uint64_t>(json.at("rays"));
        return {whole_number<std::uint64_t>(json.at("sums")),
                whole_number<std::uint64_t>(json.at("statistics"))};
    } catch (const nlohmann::json::exception& error) {
        refuse(file, error.what());
    }
}

} // namespace

std::uint64_t write_checkpoint(const fs::path& file, const RenderCheckpoint& head, FilmSums films) {
    std::uint64_t bytes = 0;
    write_atomically(file, [&](const fs::path& target) {
        std::ofstream stream(target, std::ios::binary);
        Sha256 sha;
        const auto write = [&](std::string_view piece) {
            stream.write(piece.data(), static_cast<std::streamsize>(piece.size()));
            sha.update(piece);
            bytes += piece.size();
        };
        write(header_text(head, films));
        for (const FilmStrip& strip : films)
            write(bytes_of(strip.sums));
        for (const FilmStrip& strip : films)
            write(bytes_of(strip.statistics));
        write(sha.hex());
        stream.close();
        if (!stream)
            throw_runtime_error(std::strerror(errno));
    });
    return bytes;
}

RenderCheckpoint read_checkpoint(const fs::path& file, const SampleIdentity& identity,
                                 std::uint64_t floats) {
    DigestedInput input(file);
    if (input.line() != format_name)
        refuse(file, "it does not begin like one of this version");
    RenderCheckpoint checkpoint;
    const CheckpointSizes sizes = parse_header(file, input.line(), checkpoint);
    if (const auto difference = identity_difference(identity, checkpoint.identity))
        throw_input_error({file.string()}, "the checkpoint is of another render: " + *difference,
                          "render with what it was made with, or leave --resume away");
    const bool fits = sizes.sums <= floats && sizes.statistics == floats - sizes.sums;
    if (!fits || input.left() != floats * sizeof(float) + digest_bytes)
        refuse(file, "it is not as long as it must be");
    if (checkpoint.passes.empty())
        refuse(file, "it holds no pass");
    checkpoint.sums.resize(sizes.sums);
    checkpoint.statistics.resize(sizes.statistics);
    input.floats(checkpoint.sums);
    input.floats(checkpoint.statistics);
    input.check_digest();
    return checkpoint;
}

} // namespace reradiant
