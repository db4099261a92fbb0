// The page in a real browser.
#include <gmock/gmock.h>

#include <optional>

#include "tests/viewer/Browser.hpp"
#include "tests/viewer/Client.hpp"
#include "tests/viewer/Running.hpp"

namespace insonify::viewer {
namespace {

using nlohmann::json;
using testing::HasSubstr;

// Beams 10 to 19 of 32 over 90 degrees are at -16.9 to 11.25 degrees, bins 40 to 49 at 6 to 7.5 m; all else is silent.
const json brightest = {255, 252, 236}, darkest = {6, 5, 6};

class PageTest : public testing::Test {
protected:
    void SetUp() override {
        if (!std::filesystem::exists(chromium)) GTEST_SKIP() << "NOT TESTED: there is no " << chromium;
        if (pythonWithWebsockets().empty()) GTEST_SKIP() << "NOT TESTED: no python has websockets";
        open();
    }
    void open(const std::string& first = "", uint16_t port = 0) {
        browser.reset();
        running.reset();
        running.emplace(port);
        browser.emplace("http://127.0.0.1:" + std::to_string(running->port()) + "/", first);
        ASSERT_TRUE(browser->becomes("self.insonify && insonify.shown() > 3 && insonify.status()"));
    }
    json value(const std::string& expression) { return browser->value(expression); }
    bool becomes(const std::string& expression) { return browser->becomes(expression); }
    std::string text(const std::string& id) { return value("document.getElementById('" + id + "').textContent"); }
    /** Sets a control, as a hand would. */
    void put(const std::string& id, const std::string& what) {
        value("(() => { const control = document.getElementById('" + id + "'); control.value = '" + what +
              "'; for (const kind of ['input', 'change']) control.dispatchEvent(new Event(kind)); })()");
    }
    void click(const std::string& button) {
        value("[...document.querySelectorAll('button')].find((one) => one.textContent === '" + button + "').click()");
    }
    /** Red, green and blue of the pixel at which a place is drawn. */
    json pixelAt(double range, double bearing_deg) {
        return value(
            "(() => { const {fan} = insonify; fan.draw(); const p = new Uint8Array(4);"
            "const [x, y] = fan.pixelOf(" +
            std::to_string(range) + ", " + std::to_string(types::radians(bearing_deg)) +
            "); fan.gl.readPixels(x, y, 1, 1, fan.gl.RGBA, fan.gl.UNSIGNED_BYTE, p);"
            "return [...p].slice(0, 3); })()");
    }
    /** Points with the mouse at a place; the text beside the controls. */
    std::string readAt(double range, double bearing_deg) {
        const json at = value(
            "(() => { const {fan} = insonify, box = fan.canvas.getBoundingClientRect(); fan.draw();"
            "const [x, y] = fan.pixelOf(" +
            std::to_string(range) + ", " + std::to_string(types::radians(bearing_deg)) +
            "); return [box.left + x / devicePixelRatio, box.bottom - y / devicePixelRatio]; })()");
        browser->point(at[0], at[1]);
        value("new Promise((done) => requestAnimationFrame(() => requestAnimationFrame(done)))");
        return text("cursor");
    }
    bool hasThree() { return value("fetch('three.min.js').then((answer) => answer.ok)"); }

    std::optional<Running> running;
    std::optional<Browser> browser;
};

TEST_F(PageTest, APingIsDrawnAsItIs) {
    for (const bool polar : {false, true}) {
        value(std::string("insonify.fan.polar = ") + (polar ? "true" : "false"));
        for (const double bearing : {-16.0, 0.0, 10.5})
            EXPECT_EQ(pixelAt(6.75, bearing), brightest) << bearing << (polar ? ", polar" : "");
        for (const auto& [range, bearing] : {std::pair(5.7, 0.0), {7.8, 0.0}, {6.75, -18.0}, {6.75, 12.5}})
            EXPECT_EQ(pixelAt(range, bearing), darkest) << range << " " << bearing << (polar ? ", polar" : "");
    }
    EXPECT_NE(pixelAt(16, 0), darkest) << "beyond the last bin there is no picture";
}

TEST_F(PageTest, ColourMapAndGainChangeThePicture) {
    put("map", "gray");
    EXPECT_EQ(pixelAt(6.75, 0), json({255, 255, 255}));
    EXPECT_EQ(pixelAt(5.7, 0), json({0, 0, 0}));
    put("gain", "-20");  // of 45 dB from black to white
    EXPECT_NEAR(pixelAt(6.75, 0)[0].get<int>(), 255 * 25 / 45, 5);
    EXPECT_EQ(text("gain_db"), "-20 dB");
    put("span", "90");
    EXPECT_NEAR(pixelAt(6.75, 0)[0].get<int>(), 255 * 70 / 90, 5);
}

TEST_F(PageTest, TheCursorTellsRangeBearingAndLevel) {
    for (const char* level : {"0.0 dB", "10.0 dB"}) {
        double range = 0, bearing = 0;
        char side[8] = "", rest[32] = "";
        const std::string told = readAt(6.75, 8);
        ASSERT_EQ(std::sscanf(told.c_str(), "%lf m %lf° %7s %31[^\n]", &range, &bearing, side, rest), 4) << told;
        EXPECT_NEAR(range, 6.75, 0.05);
        EXPECT_NEAR(bearing, 8, 0.5);
        EXPECT_STREQ(side, "port");
        EXPECT_NEAR(std::stod(rest), std::stod(level), 0.05) << told;
        running->deployment().call("source.setLevel", {"10"});
        ASSERT_TRUE(becomes("Math.abs(insonify.fan.ping.top_db - 10) < 0.1"));
    }
    EXPECT_THAT(readAt(3, -20), testing::AllOf(HasSubstr("stbd"), HasSubstr("no echo")));
    EXPECT_EQ(readAt(15.5, 0), "") << "beyond the last bin";
}

TEST_F(PageTest, APropertyIsSetWhereItStands) {
    EXPECT_EQ(value("[...document.getElementById('task').options].map((one) => one.value)"),
              json({"source", "world", "viewer"}));
    put("task", "source");
    const std::string row =
        "[...document.querySelectorAll('#properties tr')].find((one) => one.cells[0].textContent === 'level')";
    const auto type = [&](const std::string& number) {
        value(row + ".querySelector('input').focus()");
        value(row + ".querySelector('input').select()");
        browser->type(number);
    };
    type("10");
    EXPECT_TRUE(becomes("Math.abs(insonify.fan.ping.top_db - 10) < 0.1")) << "of a level ten times as high";
    EXPECT_TRUE(becomes("insonify.status().tasks[0].properties.level == 10"));
    type("1000");
    EXPECT_TRUE(becomes(row + ".querySelector('.refused').textContent === 'level: is 1000; may be 0 to 100'"));
    EXPECT_TRUE(becomes(row + ".querySelector('input').value === '10'")) << "it shows what holds";
}

TEST_F(PageTest, ABlockIsSetToWhatIsWrittenThereSoThatRowsMayBecomeABudget) {
    put("task", "source");
    const std::string row =
        "[...document.querySelectorAll('#properties tr')].find((one) => one.cells[0].textContent === 'quality')";
    value(row + ".querySelector('input').focus()");
    value(row + ".querySelector('input').select()");
    browser->type("{budget_ms: 20}");
    EXPECT_TRUE(becomes("insonify.status().tasks[0].properties.quality === '{\"budget_ms\": 20}'"));
    EXPECT_EQ(value(row + ".querySelector('.refused').textContent"), "");
}

TEST_F(PageTest, BearingsAreSignedAsInPicturesAndTheRangeIsTold) {
    EXPECT_THAT(readAt(6.75, -8), HasSubstr("-8"));
    EXPECT_THAT(readAt(6.75, -8), HasSubstr("stbd"));
    EXPECT_EQ(text("reach"), "15.0 m, 32 x 100, 150 mm");
}

TEST_F(PageTest, TheButtonsRecordPauseAndStep) {
    ASSERT_TRUE(becomes("document.querySelectorAll('#controls button').length === 3"));
    click("● source");
    EXPECT_TRUE(becomes("insonify.status().tasks[0].properties.record === true"));
    EXPECT_TRUE(becomes("document.querySelector('#controls button').className === 'on'"));
    click("● source");
    EXPECT_TRUE(becomes("insonify.status().tasks[0].properties.record === false"));

    click("pause");
    ASSERT_TRUE(becomes("insonify.status().paused"));
    const int64_t paused = running->deployment().status().now.microseconds;
    click("step");
    EXPECT_TRUE(becomes("insonify.status().now_us === " + std::to_string(paused + 10'000)));
    click("go on");
    EXPECT_TRUE(becomes("!insonify.status().paused && insonify.status().now_us > " + std::to_string(paused + 50'000)));
}

TEST_F(PageTest, TasksPlansAndLossesAreListed) {
    EXPECT_TRUE(becomes("document.querySelectorAll('#tasks .Running').length === 3"));
    EXPECT_EQ(value("[...document.querySelectorAll('#tasks tr')].map((row) => row.cells[0].textContent)"),
              json({"task", "source", "world", "viewer"}));
    EXPECT_EQ(value("[...document.querySelectorAll('#plan dt, #plan dd')].map((one) => one.textContent)"),
              json({"multipath", "not asked for"}));
    EXPECT_EQ(value("[...document.querySelectorAll('#plan h3')].map((one) => one.textContent)"),
              json({"world", "left out", "lost samples"}));
    EXPECT_THAT(text("plan"),
                testing::AllOf(HasSubstr("64 rows, 2 columns per beam, 1 slabs, predicted error 0.01"),
                               HasSubstr("compiled: cones"), HasSubstr("run: draw, sum"), HasSubstr("a notice")));
    EXPECT_TRUE(
        becomes("/^[1-9][0-9]*  world.pose > viewer.pose \\(buffer\\)$/.test(document.querySelector('#plan "
                ".refused').textContent)"))
        << "a buffer of one that gets two poses each time";
    EXPECT_EQ(value("document.querySelectorAll('#graph .node').length"), 3);
    EXPECT_EQ(value("document.querySelectorAll('#graph .edge').length"), 2);
}

TEST_F(PageTest, TheSceneTheWaterThePathAndTheFanAreDrawn) {
    if (!hasThree()) {
        EXPECT_TRUE(becomes("!document.getElementById('no_view').hidden")) << "no word of the 3-D view";
        GTEST_SKIP() << "NOT TESTED: no three.js was built in";
    }
    ASSERT_TRUE(becomes("insonify.world() && insonify.world().objects.size === 2 && insonify.snapshot()"));
    EXPECT_EQ(value("document.getElementById('no_view').hidden"), true);
    EXPECT_EQ(text("scene_text"), "4 triangles, 2 objects");
    ASSERT_TRUE(
        becomes("insonify.world().vehicles.get('world.pose')?.count > 20 && insonify.world().sonar.position.x > 3"));
    // What each part changes in the picture, and how many colours there are.
    value(R"(self.look = () => {
        const world = insonify.world(), gl = world.renderer.getContext(), size = 4 * gl.drawingBufferWidth * gl.drawingBufferHeight;
        const pixels = () => {
            world.dirty = true;
            world.draw();
            const all = new Uint8Array(size);
            gl.readPixels(0, 0, gl.drawingBufferWidth, gl.drawingBufferHeight, gl.RGBA, gl.UNSIGNED_BYTE, all);
            return new Uint32Array(all.buffer);
        };
        const whole = pixels(), changed = {colours: new Set(whole).size};
        const parts = {scene: world.content, fan: world.sonar, water: world.water, path: world.vehicles.get('world.pose').path};
        for (const [name, part] of Object.entries(parts)) {
            part.visible = false;
            changed[name] = pixels().reduce((sum, pixel, i) => sum + (pixel !== whole[i]), 0);
            part.visible = true;
        }
        return changed;
    })");
    const json seen = value("look()");
    EXPECT_GT(seen["colours"], 50) << seen;
    for (const auto& [part, least] : {std::pair("scene", 1000), {"fan", 1000}, {"water", 1000}, {"path", 5}})
        EXPECT_GT(seen[part], least) << seen;

    running->deployment().call("world.setWater", {"false"});
    EXPECT_TRUE(becomes("!insonify.world().water.visible")) << "a later snapshot has none";
}

TEST_F(PageTest, TheFanIsWhereItsPingWasMade) {
    if (!hasThree()) GTEST_SKIP() << "NOT TESTED: no three.js was built in";
    ASSERT_TRUE(becomes("insonify.world() && insonify.snapshot()"));
    running->deployment().pause(true);
    const auto now = [&] { return running->deployment().status().now.microseconds; };
    for (int i = 0; i < 2; ++i) {  // an instant with a snapshot, one without
        const int64_t before = now();
        running->deployment().step();
        ASSERT_TRUE(comesTrue([&] { return now() == before + 10'000; }));
        const std::string time = std::to_string(now() / 20'000 * 20'000);
        EXPECT_TRUE(becomes("insonify.fan.ping.time_us === " + std::to_string(now())));
        EXPECT_TRUE(becomes("insonify.snapshot().time_us === " + time));
        EXPECT_TRUE(becomes("Math.abs(insonify.world().sonar.position.x - 2e-6 * " + time + ") < 1e-6"));
    }
}

TEST_F(PageTest, EachVehicleHasAPathOfItsOwnThatEndsWhereTimeGoesBack) {
    if (!hasThree()) GTEST_SKIP() << "NOT TESTED: no three.js was built in";
    ASSERT_TRUE(becomes("insonify.world()?.vehicles.size === 1"));
    value(
        R"(for (const [source, time_us] of [['a.pose', 5], ['b.pose', 5], ['a.pose', 6], ['a.pose', 7], ['b.pose', 2]])
        insonify.world().showPose({source, time_us, position: [time_us, 0, 0], orientation: [0, 0, 0, 1]}))");
    EXPECT_EQ(value("['a.pose', 'b.pose'].map((source) => insonify.world().vehicles.get(source).count)"), json({3, 1}));
    EXPECT_EQ(value("[...insonify.world().vehicles.get('a.pose').places.array.slice(0, 9)]"),
              json({5, 0, 0, 6, 0, 0, 7, 0, 0}));
}

TEST_F(PageTest, ABrokenConnectionComesBack) {
    const uint16_t port = quietPort();
    open("", port);
    // A machine that stalls is not to look like a connection that says nothing.
    value("Object.defineProperty(insonify.link, 'patience', {get: () => 1e9, set: () => {}})");
    ASSERT_TRUE(becomes("document.getElementById('link').textContent === 'connected'"));
    const int opened = value("insonify.link.opened");
    running.reset();
    ASSERT_TRUE(becomes("document.getElementById('link').textContent === 'no connection'"));
    running.emplace(port);
    ASSERT_TRUE(becomes("document.getElementById('link').textContent === 'connected'"));
    const auto shown = value("insonify.shown()");
    EXPECT_TRUE(becomes("insonify.shown() > " + shown.dump()));
    EXPECT_EQ(value("insonify.link.opened"), opened + 1);
}

TEST_F(PageTest, AConnectionThatSaysNothingIsOpenedAgain) {
    const int opened = value("insonify.link.opened");
    value("insonify.link.socket.onmessage = () => {}");
    EXPECT_TRUE(becomes("insonify.link.opened > " + std::to_string(opened)));
    EXPECT_TRUE(becomes("document.getElementById('link').textContent === 'connected'"));
}

TEST_F(PageTest, ABrowserWithoutWebGl2ShowsTheRest) {
    open(R"(const getContext = HTMLCanvasElement.prototype.getContext;
        HTMLCanvasElement.prototype.getContext = function(kind, ...more) {
            return kind.includes('webgl') ? null : getContext.call(this, kind, ...more);
        })");
    EXPECT_THAT(text("no_fan"), HasSubstr("no WebGL 2"));
    EXPECT_EQ(value("document.getElementById('no_fan').hidden"), false);
    EXPECT_TRUE(becomes("!document.getElementById('no_view').hidden"));
    EXPECT_TRUE(becomes("document.querySelectorAll('#tasks .Running').length === 3"));
    EXPECT_THAT(readAt(6.75, 8), HasSubstr("dB"));
}

}  // namespace
}  // namespace insonify::viewer
