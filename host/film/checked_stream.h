#pragma once

#include <ImfIO.h>

#include <cstdint>
#include <cstdio>
#include <filesystem>

namespace reradiant {

/// Output stream for OpenEXR that remembers a failed write. OpenEXR's own stream loses what
/// fails in the destructor of the file: a full disk would go unnoticed.
class CheckedStream : public Imf::OStream {
public:
    /// Throws a run-time Error when the file cannot be created.
    explicit CheckedStream(const std::filesystem::path& file);
    ~CheckedStream() override;

    void write(const char bytes[], int count) override;
    std::uint64_t tellp() override;
    void seekp(std::uint64_t position) override;
    /// Flushes and closes; throws a run-time Error when anything since the start has failed.
    void finish();

private:
    void fail();

    std::FILE* stream_ = nullptr;
    int error_number_ = 0;
};

} // namespace reradiant
