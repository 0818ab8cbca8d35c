#include "tests/tools/program_runner.h"

#include <gtest/gtest.h>

#include <arpa/inet.h>
#include <cstdint>
#include <netinet/in.h>
#include <string>
#include <sys/socket.h>
#include <thread>
#include <unistd.h>
#include <vector>

namespace reradiant {
namespace {

constexpr const char* scene = "[film]\nwidth = 140\nheight = 8\n"
                              "[camera]\norigin = [0, 0, 3]\ntarget = [0, 0, 0]\n"
                              "[[light]]\ntype = \"environment\"\nradiance = 1.0\n";

/// A `Listener` stands in for the viewer: it takes one connection and keeps all that it is sent.
class Listener {
public:
    Listener() : socket_(::socket(AF_INET, SOCK_STREAM, 0)) {
        sockaddr_in here{};
        here.sin_family = AF_INET;
        here.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
        socklen_t size = sizeof here;
        auto* address = reinterpret_cast<sockaddr*>(&here);
        if (::bind(socket_, address, size) == 0 && ::listen(socket_, 1) == 0 &&
            ::getsockname(socket_, address, &size) == 0)
            port_ = ntohs(here.sin_port);
        thread_ = std::thread([this] { receive(); });
    }
    ~Listener() {
        ::shutdown(socket_, SHUT_RDWR); // ends a wait for a program that never came
        if (thread_.joinable())
            thread_.join();
        ::close(socket_);
    }
    Listener(const Listener&) = delete;
    Listener& operator=(const Listener&) = delete;

    std::string address() const { return "127.0.0.1:" + std::to_string(port_); }
    std::string received() {
        thread_.join();
        return bytes_;
    }

private:
    void receive() {
        const int connection = ::accept(socket_, nullptr, nullptr);
        char buffer[4096];
        for (ssize_t n; (n = ::recv(connection, buffer, sizeof buffer, 0)) > 0;)
            bytes_.append(buffer, static_cast<std::size_t>(n));
        ::close(connection);
    }

    int socket_;
    int port_ = 0;
    std::string bytes_;
    std::thread thread_;
};

std::uint32_t number_at(const std::string& bytes, std::size_t at) {
    std::uint32_t value = 0;
    for (std::size_t i = 0; i < 4; ++i)
        value |= static_cast<std::uint32_t>(static_cast<unsigned char>(bytes.at(at + i)))
                 << (8 * i);
    return value;
}

/// Messages without their lengths.
std::vector<std::string> messages_of(const std::string& bytes) {
    std::vector<std::string> messages;
    for (std::size_t at = 0; at + 4 < bytes.size(); at += number_at(bytes, at))
        messages.push_back(bytes.substr(at + 4, number_at(bytes, at) - 4));
    return messages;
}

class TevPreview : public ProgramTest {};
class WavelengthOption : public ProgramTest {};

TEST_F(TevPreview, EveryPassArrivesInTilesOfThreeChannels) {
    put("scene.toml", scene);
    Listener viewer;
    const ProgramResult done = run("render scene.toml -o a.exr --spp 4 --tev " + viewer.address());
    ASSERT_EQ(done.exit_code, 0) << done.errors;
    const std::vector<std::string> messages = messages_of(viewer.received());
    constexpr std::size_t tiles = 2, channels = 3;
    constexpr std::size_t passes = 3; // after 1, 2 and 4 samples
    ASSERT_EQ(messages.size(), 1 + passes * tiles * channels);
    const std::string create = std::string("\x04\0a.exr\0", 8);
    EXPECT_EQ(messages[0].substr(0, 8), create);
    EXPECT_EQ(number_at(messages[0], 8), 140u);
    EXPECT_EQ(number_at(messages[0], 12), 8u);
    EXPECT_EQ(messages[0].substr(16), std::string("\x03\0\0\0R\0G\0B\0", 10));
    // The second tile's blue: from column 128, 12 columns of 8 pixels.
    const std::string& blue = messages[6];
    EXPECT_EQ(blue.substr(0, 10), std::string("\x03\0a.exr\0B\0", 10));
    EXPECT_EQ(number_at(blue, 10), 128u);
    EXPECT_EQ(number_at(blue, 14), 0u);
    EXPECT_EQ(number_at(blue, 18), 12u);
    EXPECT_EQ(number_at(blue, 22), 8u);
    EXPECT_EQ(blue.size(), 26u + 4u * 12u * 8u);
}

TEST_F(TevPreview, NobodyListeningIsWarnedAboutAndNoMore) {
    put("scene.toml", scene);
    const ProgramResult done = run("render scene.toml -o a.exr --spp 1 --tev 127.0.0.1:1");
    EXPECT_EQ(done.exit_code, 0);
    EXPECT_NE(done.errors.find("--tev 127.0.0.1:1"), std::string::npos) << done.errors;
    for (const char* address : {"nonsense", "localhost:", ":14158", "localhost:70000"})
        expect_failure(2, std::string("render scene.toml -o b.exr --tev ") + address, "--tev");
}

TEST_F(WavelengthOption, SamplingsThatAreNotThere) {
    put("scene.toml", scene);
    for (const char* text : {"hero:0", "hero:99", "hero:", "heron", "comb:0", "hero:4:4"})
        expect_failure(2, std::string("render scene.toml -o b.exr --wavelengths ") + text,
                       "--wavelengths");
}

} // namespace
} // namespace reradiant
