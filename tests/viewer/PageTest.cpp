// The page in a real browser.
#include <gmock/gmock.h>

#include <optional>

#include "tests/viewer/Browser.hpp"
#include "tests/viewer/Running.hpp"

namespace insonify::viewer {
namespace {

/** Red, green and blue of the pixel at which a place is drawn. */
nlohmann::json pixelAt(Browser& browser, double range, double bearing_deg) {
    return browser.value(
        "(() => { const {fan} = insonify; fan.draw(); const p = new Uint8Array(4);"
        "const [x, y] = fan.pixelOf(" +
        std::to_string(range) + ", " + std::to_string(types::radians(bearing_deg)) +
        "); fan.gl.readPixels(x, y, 1, 1, fan.gl.RGBA, fan.gl.UNSIGNED_BYTE, p);"
        "return [...p].slice(0, 3); })()");
}

TEST(PageTest, OpensDrawsAPingSetsAPropertyAndComesBackAfterABreak) {
    if (!std::filesystem::exists(chromium)) GTEST_SKIP() << "NOT TESTED: there is no " << chromium;
    if (pythonWithWebsockets().empty()) GTEST_SKIP() << "NOT TESTED: no python has websockets";
    std::optional<Running> running(std::in_place);
    const uint16_t port = running->port();
    Browser browser("http://127.0.0.1:" + std::to_string(port) + "/");
    ASSERT_TRUE(browser.becomes("self.insonify && insonify.shown() > 3"));

    // Beams 10 to 19 of 32 over 90 degrees are at -16.9 to 11.25 degrees, bins 40 to 49 at 6 to 7.5 m; all else is
    // silent.
    const nlohmann::json brightest = {255, 252, 236}, darkest = {6, 5, 6};
    for (const bool polar : {false, true}) {
        browser.value(std::string("insonify.fan.polar = ") + (polar ? "true" : "false"));
        for (const double bearing : {-16.0, 0.0, 10.5})
            EXPECT_EQ(pixelAt(browser, 6.75, bearing), brightest) << bearing << (polar ? ", polar" : "");
        for (const auto& [range, bearing] : {std::pair(5.7, 0.0), {7.8, 0.0}, {6.75, -18.0}, {6.75, 12.5}})
            EXPECT_EQ(pixelAt(browser, range, bearing), darkest) << range << " " << bearing << (polar ? ", polar" : "");
    }
    EXPECT_NE(pixelAt(browser, 16, 0), darkest) << "beyond the last bin there is no picture";

    EXPECT_EQ(browser.value("document.getElementById('link').textContent"), "connected");
    EXPECT_TRUE(browser.becomes("document.querySelectorAll('#tasks .Running').length == 2"));
    EXPECT_EQ(browser.value("insonify.link.call('source.setLevel', 10).then(answer => answer.refused ?? 'done')"),
              "done");
    EXPECT_TRUE(browser.becomes("Math.abs(insonify.fan.ping.top_db - 10) < 0.1")) << "of a level ten times as high";
    EXPECT_TRUE(browser.becomes("insonify.status().tasks[0].properties.level == 10"));
    EXPECT_EQ(browser.value("insonify.link.call('source.setLevel', 1000).then(answer => answer.refused ?? 'done')"),
              "level: is 1000; may be 0 to 100");
    EXPECT_TRUE(browser.value("insonify.world() !== null || !document.getElementById('no_view').hidden"))
        << "no word of the 3-D view";

    running.reset();
    ASSERT_TRUE(browser.becomes("document.getElementById('link').textContent == 'no connection'"));
    running.emplace(port);
    ASSERT_TRUE(browser.becomes("document.getElementById('link').textContent == 'connected'"));
    const auto shown = browser.value("insonify.shown()");
    EXPECT_TRUE(browser.becomes("insonify.shown() > " + shown.dump()));
    EXPECT_EQ(browser.value("insonify.link.opened"), 2);
}

}  // namespace
}  // namespace insonify::viewer
