#include "host/film/checked_stream.h"

#include "reradiant/error.h"

#include <cerrno>
#include <cstring>

namespace reradiant {

CheckedStream::CheckedStream(const std::filesystem::path& file)
    : Imf::OStream(file.c_str()), stream_(std::fopen(file.c_str(), "wb")) {
    if (!stream_)
        throw_runtime_error(std::strerror(errno));
}

CheckedStream::~CheckedStream() {
    if (stream_)
        std::fclose(stream_);
}

void CheckedStream::fail() {
    if (error_number_ == 0)
        error_number_ = errno != 0 ? errno : EIO;
    throw_runtime_error(std::strerror(error_number_));
}

void CheckedStream::write(const char bytes[], int count) {
    const auto size = static_cast<std::size_t>(count);
    if (std::fwrite(bytes, 1, size, stream_) != size)
        fail();
}

std::uint64_t CheckedStream::tellp() {
    const long position = std::ftell(stream_);
    if (position < 0)
        fail();
    return static_cast<std::uint64_t>(position);
}

void CheckedStream::seekp(std::uint64_t position) {
    if (std::fseek(stream_, static_cast<long>(position), SEEK_SET) != 0)
        fail();
}

void CheckedStream::finish() {
    std::FILE* const stream = stream_;
    stream_ = nullptr;
    errno = 0;
    if (std::fclose(stream) != 0 || error_number_ != 0)
        fail();
}

} // namespace reradiant
