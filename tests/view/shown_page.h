#pragma once

#include "host/view/view_page.h"
#include "reradiant/paths.h"
#include "reradiant/scene_file.h"
#include "tests/support/page_browser.h"
#include "tests/support/scratch_folder.h"

#include <string>

namespace reradiant {

inline ViewedMaterial viewed_preset(const std::string& name) {
    return {name, load_material(spectra_directory() / "materials" / (name + ".toml"))};
}
inline std::string page_of(const ViewedMaterial& viewed, std::vector<Lamp> lamps = {}) {
    return view_page({viewed.name, {viewed}, std::move(lamps), false});
}

/// Opens pages in a browser; tests skip where there is none.
class ShownPage : public ::testing::Test {
protected:
    void SetUp() override {
        if (!browser.is_there())
            GTEST_SKIP() << PageBrowser::missing;
    }

    nlohmann::json opened(const std::string& html, const std::string& steps,
                          bool is_timed = false) const {
        nlohmann::json outcome = browser.opened(folder / "", html, steps, is_timed);
        EXPECT_EQ(outcome.value("faults", nlohmann::json()), nlohmann::json::array());
        EXPECT_EQ(outcome.value("fetched", nlohmann::json()), nlohmann::json::array())
            << "pages need no network";
        return outcome;
    }

    PageBrowser browser;
    const test::TemporaryFolder folder{"page"};
};

} // namespace reradiant
