#pragma once

#include "reradiant/spectral_image.h"

#include <string>

namespace reradiant {

/// Input Error unless an address is HOST:PORT or empty.
void check_tev_address(const std::string& address);

/// Shows an image in the viewer tev (Thomas Mueller) while it is rendered, by the viewer's TCP
/// protocol: one message creates the image, each update sends its linear sRGB in tiles. Whatever
/// fails is warned about once, and nothing is sent from there on: a preview never ends a render.
class TevPreview {
public:
    /// address: HOST:PORT, as check_tev_address wants it; empty: nothing is shown.
    TevPreview(const std::string& address, std::string name);
    ~TevPreview();
    TevPreview(const TevPreview&) = delete;
    TevPreview& operator=(const TevPreview&) = delete;

    bool is_open() const { return socket_ >= 0; }
    /// The first image is created in the viewer, too.
    void update(const SpectralImage& image);

private:
    void connect_to(const std::string& host, const std::string& port);
    bool send(const std::string& message);
    void give_up(const std::string& why);

    std::string name_, address_;
    int socket_ = -1;
    bool created_ = false;
};

} // namespace reradiant
