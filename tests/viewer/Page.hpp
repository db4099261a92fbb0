#pragma once
// The page in a real browser, controlled by mouse and keys.
#include <gmock/gmock.h>

#include <optional>

#include "tests/viewer/Browser.hpp"
#include "tests/viewer/Running.hpp"

namespace insonify::viewer {

using nlohmann::json;

// Beams 10 to 19 of 32 over 90 degrees are at -16.9 to 11.25 degrees, bins 40 to 49 at 6 to 7.5 m; all else is silent.
inline const json brightest = {255, 252, 236}, darkest = {6, 5, 6};

struct PageTest : testing::Test {
    void SetUp() override {
        if (!std::filesystem::exists(chromium)) GTEST_SKIP() << "NOT TESTED: there is no " << chromium;
        if (pythonWithWebsockets().empty()) GTEST_SKIP() << "NOT TESTED: no python has websockets";
        open();
    }
    /** @param first a script that runs before those of the page
     *  @param query of the page's address */
    void open(const std::string& first = "", uint16_t port = 0, const Running::Additions& additions = {},
              const std::string& query = "") {
        browser.reset();
        running.reset();
        running.emplace(port, additions);
        browser.emplace("http://127.0.0.1:" + std::to_string(running->port()) + "/" + query, first);
        ASSERT_TRUE(browser->becomes("self.insonify && insonify.shown() > 3 && insonify.status()"));
    }
    /** A stalled machine must not look like a silent connection. */
    void keepConnection() {
        value("Object.defineProperty(insonify.link, 'patience', {get: () => 1e9, set: () => {}})");
    }
    json value(const std::string& expression) { return browser->value(expression); }
    bool becomes(const std::string& expression) { return browser->becomes(expression); }
    std::string text(const std::string& id) { return value("document.getElementById('" + id + "').textContent"); }
    static std::string byId(const std::string& id) { return "document.getElementById('" + id + "')"; }
    /** Returns the field of a property in the table. */
    static std::string getField(const std::string& property) {
        return "[...document.querySelectorAll('#properties tr')].find((one) => one.cells[0].textContent === '" +
               property + "')?.querySelector('input, select')";
    }
    /** Returns the red text next to a field. */
    static std::string getRefusal(const std::string& field) {
        return field + ".parentElement.querySelector('.refused').textContent";
    }
    void click(const std::string& button) {
        browser->click("[...document.querySelectorAll('button')].find((one) => one.textContent === '" + button + "')");
    }
    /** Opens a list and types the name of an option. */
    void choose(const std::string& list, const std::string& option) {
        browser->click(byId(list));
        browser->type(option);
        browser->press("Enter");
        EXPECT_EQ(value(byId(list) + ".value"), option);
    }
    /** Chooses a setting in the dialog of settings. */
    void set(const std::string& setting, const std::string& choice) {
        browser->click(byId("settings"));
        ASSERT_TRUE(becomes(byId("dialog") + ".open"));
        value(byId("set_" + setting) + ".value = '" + choice + "', " + byId("set_" + setting) + ".onchange()");
        click("close");
        EXPECT_EQ(value("insonify.settings." + setting), choice);
    }
    /** Moves a slider of steps of 1 by keys. */
    void slide(const std::string& id, int to) {
        value(byId(id) + ".focus()");
        const int steps = to - std::stoi(value(byId(id) + ".value").get<std::string>());
        browser->press(steps > 0 ? "ArrowRight" : "ArrowLeft", std::abs(steps));
        EXPECT_EQ(value(byId(id) + ".value"), std::to_string(to));
    }
    /** Replaces the content of a field and presses Enter. */
    void enter(const std::string& field, const std::string& text) {
        browser->click(field);
        browser->press("Control+a");
        text.empty() ? browser->press("Backspace") : browser->type(text);
        browser->press("Enter");
    }
    /** Returns red, green and blue of the pixel at which a place is drawn. */
    json pixelAt(double range, double bearing_deg) {
        nextFrame();
        return value(
            "(() => { const {fan} = insonify, p = new Uint8Array(4);"
            "const [x, y] = fan.findPixel(" +
            std::to_string(range) + ", " + std::to_string(types::radians(bearing_deg)) +
            "); fan.gl.readPixels(x, y, 1, 1, fan.gl.RGBA, fan.gl.UNSIGNED_BYTE, p);"
            "return [...p].slice(0, 3); })()");
    }
    /** Returns the window pixel of a place in the water [px]. */
    std::array<double, 2> windowAt(double range, double bearing_deg) {
        nextFrame();
        return value(
            "(() => { const {fan} = insonify, box = fan.canvas.getBoundingClientRect();"
            "const [x, y] = fan.findPixel(" +
            std::to_string(range) + ", " + std::to_string(types::radians(bearing_deg)) +
            "); return [box.left + x / devicePixelRatio, box.bottom - y / devicePixelRatio]; })()");
    }
    void nextFrame() { value("new Promise((done) => requestAnimationFrame(() => requestAnimationFrame(done)))"); }
    /** Points with the mouse at a place; returns the text over the picture. */
    std::string readAt(double range, double bearing_deg) {
        const auto at = windowAt(range, bearing_deg);
        browser->point(at[0], at[1]);
        nextFrame();
        return text("cursor");
    }
    void clickAt(double range, double bearing_deg) {
        const auto at = windowAt(range, bearing_deg);
        browser->click(at[0], at[1]);
        nextFrame();
    }
    bool hasThree() { return value("fetch('three.min.js').then((answer) => answer.ok)"); }

    std::optional<Running> running;
    std::optional<Browser> browser;
};

}  // namespace insonify::viewer
