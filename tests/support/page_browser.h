#pragma once

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <string>

namespace reradiant {

/// A headless Chromium that opens pages, WebGL by software included, and runs steps as their reader
/// would take them.
class PageBrowser {
public:
    PageBrowser() {
        for (const char* name : {"chromium-headless-shell", "chromium", "chromium-browser"})
            if (std::system(("command -v " + std::string(name) + " >/dev/null").c_str()) == 0)
                name_ = name;
    }
    bool is_there() const { return !name_.empty(); }
    static constexpr const char* missing = "no Chromium here: pages are not tested in a browser";

    /// Opens `html` from a file in the folder, runs `steps` (the body of an asynchronous function,
    /// which fills `outcome`) when it is loaded and unpacked, and returns the outcome with what
    /// every page must say of itself: `faults`, resources `fetched` from elsewhere, `pictures`,
    /// those `broken`. With `is_timed` the page's clock is the real one; else timers run as soon as
    /// they can.
    nlohmann::json opened(const std::filesystem::path& folder, std::string html,
                          const std::string& steps, bool is_timed = false) const {
        html.insert(html.find("<head>") + 6, watch);
        html.insert(html.rfind("</body>"), held);
        html.insert(html.rfind("</body>"), "<script>addEventListener('load', async () => { const "
                                           "outcome = {};\ntry {\nawait window.ready;\n" +
                                               steps + report + "});</script>");
        std::ofstream(folder / "opened.html", std::ios::binary) << html;
        const std::string command =
            name_ +
            " --headless --no-sandbox --use-gl=angle --use-angle=swiftshader "
            "--enable-unsafe-swiftshader --window-size=1200,900 " +
            (is_timed ? "" : "--virtual-time-budget=20000 ") + "--dump-dom 'file://" +
            (folder / "opened.html").string() + "' 2>/dev/null >'" +
            (folder / "dom.html").string() + "'";
        EXPECT_EQ(std::system(command.c_str()), 0) << command;
        return said_by(text_of(folder / "dom.html"));
    }

private:
    /// The page counts as loaded when it is unpacked, and not before, as by the real clock nobody
    /// waits for more: one small picture after the other is loaded until then.
    static constexpr const char* held =
        "<script>{ let isUnpacked = false; const hold = () => { if (isUnpacked) return; "
        "const one = new Image(); one.onload = one.onerror = hold; one.src = "
        "'data:image/gif;base64,R0lGODlhAQABAAAAACwAAAAAAQABAAA='; }; hold(); "
        "Promise.resolve(window.ready).then(() => { isUnpacked = true; }); }</script>";
    /// Runs before the page's own script: what goes wrong there is kept.
    static constexpr const char* watch = "<script>window.faults = [];"
                                         "addEventListener('error', (e) => "
                                         "faults.push(String(e.message)));</script>";
    static constexpr const char* report = R"js(
  } catch (error) { faults.push(String(error.stack)); }
  outcome.faults = faults;
  outcome.fetched = performance.getEntriesByType('resource').map((e) => e.name)
    .filter((name) => !name.startsWith('data:'));
  outcome.broken = [...document.images].filter((i) => !i.complete || i.naturalWidth === 0).length;
  outcome.pictures = document.images.length;
  const text = document.createElement('pre');
  text.id = 'outcome';
  text.textContent = JSON.stringify(outcome);
  document.body.replaceChildren(text);
)js";

    static std::string text_of(const std::filesystem::path& file) {
        std::stringstream text;
        text << std::ifstream(file, std::ios::binary).rdbuf();
        return text.str();
    }

    static nlohmann::json said_by(const std::string& dom) {
        const std::string mark = "<pre id=\"outcome\">";
        const std::size_t begin = dom.find(mark), end = dom.find("</pre>", begin);
        if (begin == std::string::npos || end == std::string::npos) {
            ADD_FAILURE() << "the page said nothing:\n" << dom.substr(0, 2000);
            return {};
        }
        return nlohmann::json::parse(
            unescaped(dom.substr(begin + mark.size(), end - begin - mark.size())));
    }

    /// The text that a serialised document escaped.
    static std::string unescaped(std::string text) {
        for (const auto& [from, to] : {std::pair{"&lt;", "<"}, {"&gt;", ">"}, {"&amp;", "&"}})
            for (std::size_t at = 0; (at = text.find(from, at)) != std::string::npos; ++at)
                text.replace(at, std::string(from).size(), to);
        return text;
    }

    std::string name_;
};

} // namespace reradiant
