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

/// Functions that move a control and read a pixel.
inline const std::string hands = R"js(
  const drag = (id, value) => { const input = place(id); input.value = value; input.dispatchEvent(new Event('input')); };
  const pick = (id, value) => { const input = place(id); input.value = value; input.dispatchEvent(new Event('change')); };
  const shown = () => { drawNow(); return readingAt(states[modelAt(view.x)], view.x, view.y); };
  const told = (found) => ({ wi: found.wi, wo: found.wo, radiance: [...found.radiance], light: [...found.lamp] });
  const drawn = (x, y) => { const pixel = new Uint8Array(4); gl.readPixels(x - 0.5, SIZE - y - 0.5, 1, 1, gl.RGBA, gl.UNSIGNED_BYTE, pixel); return [...pixel].slice(0, 3); };
  drag('radius', 0); drag('around', 0);
)js";

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
