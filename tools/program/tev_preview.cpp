#include "tools/program/tev_preview.h"

#include "host/base/logging.h"
#include "reradiant/error.h"

#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cerrno>
#include <charconv>
#include <cstdint>
#include <cstring>
#include <memory>
#include <netdb.h>
#include <sys/socket.h>
#include <sys/time.h>
#include <unistd.h>
#include <vector>

namespace reradiant {

namespace {

constexpr char create_image = 4, update_image = 3;
constexpr std::array<const char*, 3> channels = {"R", "G", "B"};
constexpr int tile_size = 128;
/// A viewer that hangs must not hold up the render.
constexpr timeval patience{2, 0};

/// A message: its length (with these four bytes), its kind, then its fields, little endian.
class Message {
public:
    Message(char kind, const std::string& image) : bytes_(4, '\0') {
        bytes_ += kind;
        bytes_ += '\0'; // do not take the focus
        add(image);
    }
    Message& add(const std::string& text) {
        bytes_.append(text.c_str(), text.size() + 1);
        return *this;
    }
    Message& add(std::uint32_t value) {
        append(value);
        return *this;
    }
    Message& add(float value) { return add(std::bit_cast<std::uint32_t>(value)); }

    std::string finished() const {
        Message length(bytes_.size());
        return length.bytes_ + bytes_.substr(4);
    }

private:
    explicit Message(std::size_t size) { append(static_cast<std::uint32_t>(size)); }
    void append(std::uint32_t value) {
        for (int shift = 0; shift < 32; shift += 8)
            bytes_ += static_cast<char>((value >> shift) & 0xffu);
    }
    std::string bytes_;
};

std::string creation(const std::string& name, const SpectralImage& image) {
    Message message(create_image, name);
    message.add(static_cast<std::uint32_t>(image.width))
        .add(static_cast<std::uint32_t>(image.height))
        .add(static_cast<std::uint32_t>(channels.size()));
    for (const char* channel : channels)
        message.add(std::string(channel));
    return message.finished();
}

/// One channel of a tile whose upper left corner is (x, y).
std::string tile(const std::string& name, const std::vector<float>& rgb, int image_width,
                 std::size_t channel, int x, int y, int width, int height) {
    Message message(update_image, name);
    message.add(std::string(channels[channel]));
    for (const int value : {x, y, width, height})
        message.add(static_cast<std::uint32_t>(value));
    for (int row = y; row < y + height; ++row)
        for (int column = x; column < x + width; ++column)
            message.add(rgb[static_cast<std::size_t>(row * image_width + column) * channels.size() +
                            channel]);
    return message.finished();
}

} // namespace

void check_tev_address(const std::string& address) {
    if (address.empty())
        return;
    const std::size_t colon = address.rfind(':');
    unsigned port = 0;
    const char* const end = address.data() + address.size();
    const bool has_port = colon != std::string::npos && colon > 0 && colon + 1 < address.size();
    const auto parsed = std::from_chars(address.data() + (has_port ? colon + 1 : 0), end, port);
    if (!has_port || parsed.ec != std::errc{} || parsed.ptr != end || port < 1 || port > 65535)
        throw_input_error({}, fmt::format("--tev '{}' is not an address", address),
                          "write HOST:PORT, like localhost:14158");
}

TevPreview::TevPreview(const std::string& address, std::string name)
    : name_(std::move(name)), address_(address) {
    check_tev_address(address);
    if (address.empty())
        return;
    const std::size_t colon = address.rfind(':');
    connect_to(address.substr(0, colon), address.substr(colon + 1));
}

TevPreview::~TevPreview() {
    if (socket_ >= 0)
        ::close(socket_);
}

void TevPreview::connect_to(const std::string& host, const std::string& port) {
    addrinfo wanted{};
    wanted.ai_socktype = SOCK_STREAM;
    addrinfo* found = nullptr;
    if (const int failure = ::getaddrinfo(host.c_str(), port.c_str(), &wanted, &found)) {
        give_up(::gai_strerror(failure));
        return;
    }
    const std::unique_ptr<addrinfo, decltype(&::freeaddrinfo)> addresses(found, ::freeaddrinfo);
    int reason = 0;
    for (const addrinfo* a = found; a != nullptr && socket_ < 0; a = a->ai_next) {
        const int opened = ::socket(a->ai_family, a->ai_socktype, a->ai_protocol);
        if (opened < 0)
            continue;
        ::setsockopt(opened, SOL_SOCKET, SO_SNDTIMEO, &patience, sizeof patience);
        if (::connect(opened, a->ai_addr, a->ai_addrlen) == 0) {
            socket_ = opened;
        } else {
            reason = errno;
            ::close(opened);
        }
    }
    if (socket_ < 0)
        give_up(std::strerror(reason));
}

bool TevPreview::send(const std::string& message) {
    for (std::size_t sent = 0; sent < message.size();) {
        const ssize_t now =
            ::send(socket_, message.data() + sent, message.size() - sent, MSG_NOSIGNAL);
        if (now <= 0) {
            give_up(std::strerror(errno));
            return false;
        }
        sent += static_cast<std::size_t>(now);
    }
    return true;
}

void TevPreview::give_up(const std::string& why) {
    logging::warn("--tev {}: {}; the render goes on without a preview", address_, why);
    if (socket_ >= 0)
        ::close(socket_);
    socket_ = -1;
}

void TevPreview::update(const SpectralImage& image) {
    if (!is_open())
        return;
    if (!created_ && !send(creation(name_, image)))
        return;
    created_ = true;
    const std::vector<float> rgb = linear_srgb(image);
    for (int y = 0; y < image.height; y += tile_size)
        for (int x = 0; x < image.width; x += tile_size)
            for (std::size_t channel = 0; channel < channels.size(); ++channel)
                if (!send(tile(name_, rgb, image.width, channel, x, y,
                               std::min(tile_size, image.width - x),
                               std::min(tile_size, image.height - y))))
                    return;
}

} // namespace reradiant
