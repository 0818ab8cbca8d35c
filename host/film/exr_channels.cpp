#include "host/film/exr_channels.h"

#include "host/exr/exr_input.h"
#include "reradiant/error.h"

#include <ImfChannelList.h>
#include <ImfHeader.h>
#include <ImfMultiPartInputFile.h>

namespace reradiant {

std::vector<std::string> exr_channel_names(const std::filesystem::path& file) {
    return with_exr_input(file, [](Imf::MultiPartInputFile& input) {
        std::vector<std::string> names;
        for (int part = 0; part < input.parts(); ++part) {
            const Imf::ChannelList& channels = input.header(part).channels();
            for (auto channel = channels.begin(); channel != channels.end(); ++channel)
                names.emplace_back(channel.name());
        }
        return names;
    });
}

} // namespace reradiant
