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
    /** Where a place of the water is in the window [px]. */
    std::array<double, 2> windowAt(double range, double bearing_deg) {
        return value(
            "(() => { const {fan} = insonify, box = fan.canvas.getBoundingClientRect(); fan.draw();"
            "const [x, y] = fan.pixelOf(" +
            std::to_string(range) + ", " + std::to_string(types::radians(bearing_deg)) +
            "); return [box.left + x / devicePixelRatio, box.bottom - y / devicePixelRatio]; })()");
    }
    void nextFrame() { value("new Promise((done) => requestAnimationFrame(() => requestAnimationFrame(done)))"); }
    /** Points with the mouse at a place; the text over the picture. */
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

TEST_F(PageTest, AFanAcrossTheSeamIsDrawnBehindTheSonarAndGapsAreEmpty) {
    put("map", "gray");
    click("freeze");
    // Beams from 150 to 160 and from 170 to 190 degrees, silent but for the last one.
    value(
        "(() => { const {fan} = insonify, rad = (all) => all.map((each) => each * Math.PI / 180), bins = 10;"
        "const ping = {...fan.ping, beams: 3, bins, bin_m: 1.5, edges: rad([150, 160, 170, 180, 180, 190]), data: new "
        "Uint8Array(30)}; ping.data.fill(255, 20); fan.show(ping, ping.top_db); })()");
    const json white = {255, 255, 255}, black = {0, 0, 0};
    for (const bool polar : {false, true}) {
        value(std::string("insonify.fan.polar = ") + (polar ? "true" : "false"));
        for (const double bearing : {-172.0, -179.0, 181.5}) EXPECT_EQ(pixelAt(6.75, bearing), white) << bearing;
        for (const double bearing : {179.0, 172.0, 155.0}) EXPECT_EQ(pixelAt(6.75, bearing), black) << bearing;
        EXPECT_NE(pixelAt(6.75, 165), black) << "between beams there is no picture";
        EXPECT_THAT(readAt(6.75, -175), HasSubstr("-175.0° stbd"));
        EXPECT_EQ(readAt(6.75, 165), "");
    }
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
              json({"world", "left out", "lost samples", "left aside for newer samples, as asked for"}));
    EXPECT_THAT(text("plan"),
                testing::AllOf(HasSubstr("64 rows, 2 columns per beam, 1 slabs, predicted error 0.01"),
                               HasSubstr("compiled: cones"), HasSubstr("run: draw, sum"), HasSubstr("a notice")));
    EXPECT_TRUE(
        becomes("/^[1-9][0-9]*  world.pose > viewer.pose \\(buffer\\)$/.test(document.querySelector('#plan "
                ".refused').textContent)"))
        << "a buffer of one that gets two poses each time";
    const std::string meant = "[...document.querySelectorAll('#plan .dim')].at(-1)";
    EXPECT_TRUE(becomes("/^[1-9][0-9]*  world.pose > viewer.newest \\(data\\)$/.test(" + meant + ".textContent)"))
        << "the newest of two poses is wanted, and is no loss";
    EXPECT_EQ(value("document.querySelectorAll('#plan .refused').length"), 1);
    EXPECT_TRUE(
        becomes("document.querySelector('#graph .lost').textContent === "
                "'-' + insonify.status().connections.find((one) => one.policy === 'buffer' && one.lost).lost"))
        << "nor is it in the drawing";
    EXPECT_EQ(value("document.querySelectorAll('#graph .node').length"), 3);
    EXPECT_EQ(value("document.querySelectorAll('#graph .edge').length"), 2);
}

TEST_F(PageTest, WhatATaskHasRefusedStandsWhereItWasAskedForAndNotInTheTaskTable) {
    EXPECT_THROW(running->deployment().call("source.setLevel", {"66"}), std::exception);
    ASSERT_TRUE(becomes("/66 is no level/.test(insonify.status().tasks[0].error)"));
    EXPECT_TRUE(becomes("/66 is no level/.test(document.querySelectorAll('#tasks tr')[1].title)"));
    EXPECT_EQ(value("document.querySelectorAll('#tasks tr')[1].cells[1].textContent"), "Running");
    EXPECT_THAT(text("tasks"), testing::Not(HasSubstr("66")));
}

TEST_F(PageTest, HoveringMovesNothing) {
    const std::string places =
        "JSON.stringify([...document.querySelectorAll('header, main, section, .bar, .picture, nav > *')].map((one) => "
        "one.getBoundingClientRect()))";
    for (const int width : {400, 900, 1600}) {
        browser->size(width, 900);
        nextFrame();
        const json before = value(places);
        EXPECT_THAT(readAt(6.75, 8), HasSubstr("dB")) << width;
        EXPECT_EQ(value(places), before) << width;
        browser->point(1, 1);
        nextFrame();
    }
}

TEST_F(PageTest, AllOfItCanBeReachedFrom400To1920Pixels) {
    for (const auto& [width, height] : {std::pair(400, 800), {768, 1024}, {1024, 768}, {1440, 900}, {1920, 1080}}) {
        browser->size(width, height);
        nextFrame();
        EXPECT_LE(value("document.documentElement.scrollWidth"), width) << "it scrolls sideways";
        EXPECT_EQ(value("[...document.querySelectorAll('button, select, input, output, .figure, h2')].filter((one) => {"
                        "const box = one.getBoundingClientRect(); return box.width && (box.left < 0 || box.right > "
                        "innerWidth); }).map((one) => one.id || one.textContent)"),
                  json::array())
            << "outside, at " << width;
        for (const char* picture : {"fan", "view"}) {
            const json box =
                value(std::string("document.getElementById('") + picture + "').getBoundingClientRect().toJSON()");
            EXPECT_GE(box["width"], width < 800 ? width * 0.95 : width * 0.48) << picture << " " << width;
            EXPECT_GE(box["height"], 200) << picture << " " << width;
        }
        EXPECT_EQ(pixelAt(6.75, 0), brightest) << width;
        if (const char* const folder = std::getenv("INSONIFY_SCREENSHOTS"))
            browser->screenshot(std::string(folder) + "/page_" + std::to_string(width) + ".png");
    }
    EXPECT_EQ(value("document.querySelector('meta[name=viewport]').content"), "width=device-width, initial-scale=1");
}

TEST_F(PageTest, AFrozenPingStaysWhileTheSonarGoesOn) {
    click("freeze");
    const json frozen = value("insonify.fan.ping.time_us");
    ASSERT_TRUE(
        becomes("Number(document.getElementById('time').textContent.slice(0, -2)) > " + frozen.dump() + "e-6 + 0.2"));
    EXPECT_EQ(value("insonify.fan.ping.time_us"), frozen);
    EXPECT_EQ(pixelAt(6.75, 0), brightest);
    click("freeze");
    EXPECT_TRUE(becomes("insonify.fan.ping.time_us > " + frozen.dump()));
}

TEST_F(PageTest, TheWheelGoesNearerAndDraggingMovesThePicture) {
    const auto at = windowAt(6.75, 0);
    browser->wheel(at[0], at[1], -800);
    ASSERT_TRUE(becomes("insonify.fan.zoom > 3"));
    // The mouse stands at whole pixels.
    EXPECT_NEAR(windowAt(6.75, 0)[0], at[0], 3) << "what is under the mouse stays there";
    EXPECT_NEAR(windowAt(6.75, 0)[1], at[1], 3);
    EXPECT_THAT(readAt(6.75, 0), HasSubstr("6.7"));
    EXPECT_EQ(pixelAt(6.75, 0), brightest);
    EXPECT_EQ(pixelAt(5.7, 0), darkest);
    browser->drag(at[0], at[1], 40, -30);
    nextFrame();
    EXPECT_NEAR(windowAt(6.75, 0)[0], at[0] + 40, 3);
    EXPECT_NEAR(windowAt(6.75, 0)[1], at[1] - 30, 3);
    EXPECT_EQ(pixelAt(6.75, 0), brightest);
    click("whole");
    EXPECT_NEAR(windowAt(6.75, 0)[0], at[0], 1);
    EXPECT_EQ(value("document.getElementById('whole').disabled"), true);
}

TEST_F(PageTest, TwoClicksMeasureHowFarAndWhichWay) {
    click("measure");
    clickAt(6, 30);
    EXPECT_THAT(text("measured"), testing::StartsWith("6.0"));
    clickAt(6 * std::sqrt(3), 0);  // of a triangle of 6 m, 6 m and 6 sqrt 3 m
    const json found = value("insonify.fan.measured()");
    EXPECT_NEAR(found["distance"], 6, 0.06);
    EXPECT_NEAR(types::degrees(found["bearing"].get<double>()), -30, 1);
    EXPECT_THAT(text("measured"), testing::AllOf(HasSubstr(" m apart, towards -"), HasSubstr("stbd, 0")));
    double heading = 0;
    const std::string told = text("measured");
    ASSERT_EQ(std::sscanf(told.c_str() + told.find("stbd, ") + 6, "%lf° true", &heading), 1) << told;
    EXPECT_NEAR(heading, 30, 1) << "the sonar looks north";
    clickAt(3, 0);
    EXPECT_EQ(value("insonify.fan.marks.length"), 1) << "a third begins anew";
    click("measure");
    nextFrame();
    EXPECT_EQ(text("measured"), "");
}

TEST_F(PageTest, ASnapshotIsThePictureAsAFile) {
    value(R"(HTMLAnchorElement.prototype.click = async function() {
        const picture = await createImageBitmap(await (await fetch(this.href)).blob()), canvas = document.createElement('canvas');
        Object.assign(canvas, {width: picture.width, height: picture.height});
        canvas.getContext('2d').drawImage(picture, 0, 0);
        self.saved = {name: this.download, height: picture.height, pixel: (x, y) => [...canvas.getContext('2d').getImageData(x, y, 1, 1).data].slice(0, 3)};
    })");
    value("insonify.fan.rings = false");
    click("freeze");
    click("snapshot");
    ASSERT_TRUE(becomes("self.saved"));
    EXPECT_EQ(value("saved.name"), value("`source.ping_${insonify.fan.ping.time_us}.png`"));
    EXPECT_EQ(value("saved.height"), value("insonify.fan.canvas.height + 22"));
    EXPECT_EQ(value("(() => { const [x, y] = insonify.fan.pixelOf(6.75, 0); return saved.pixel(x, "
                    "insonify.fan.canvas.height - y); })()"),
              brightest);
}

TEST_F(PageTest, AFrozenPictureIsSavedWithTheAttitudeThatItWasShownWith) {
    ASSERT_TRUE(becomes("document.getElementById('attitude').textContent.includes('depth2.00 m')"));
    click("freeze");
    value(R"(import('./places.js').then(({Places}) => {
        const {of} = Places.prototype;
        Places.prototype.of = function(...asked) { return {...of.apply(this, asked), position: [0, 0, -9]}; };
        const {fan} = insonify, draw = CanvasRenderingContext2D.prototype.fillText;
        CanvasRenderingContext2D.prototype.fillText = function(text, ...more) {
            if (text.startsWith(fan.ping.source)) self.caption = text;
            return draw.call(this, text, ...more);
        };
        HTMLAnchorElement.prototype.click = () => {};
    }))");
    put("gain", "3");
    click("snapshot");
    ASSERT_TRUE(becomes("self.caption"));
    EXPECT_THAT(value("self.caption").get<std::string>(), HasSubstr("depth 2.00 m"));
}

TEST_F(PageTest, HeadingDepthAndAttitudeStandOverThePicture) {
    ASSERT_TRUE(becomes("!document.getElementById('attitude').hidden"));
    EXPECT_TRUE(
        becomes("document.getElementById('attitude').textContent === "
                "'heading000.0°depth2.00 mpitch0.0°roll0.0°'"))
        << text("attitude");
    // Turned to starboard by 90 degrees, then nose down by 20, then starboard down by 10: z, y, x of the body.
    const json turned = value(R"(import('./attitude.js').then(({attitudeOf}) => {
        const half = (deg) => deg * Math.PI / 360, product = ([ax, ay, az, aw], [bx, by, bz, bw]) =>
            [aw * bx + ax * bw + ay * bz - az * by, aw * by - ax * bz + ay * bw + az * bx, aw * bz + ax * by - ay * bx + az * bw,
             aw * bw - ax * bx - ay * by - az * bz];
        const about = (axis, deg) => [0, 1, 2].map((i) => i === axis ? Math.sin(half(deg)) : 0).concat(Math.cos(half(deg)));
        const orientation = product(product(about(2, -90), about(1, 20)), about(0, 10));
        return attitudeOf({orientation, position: [1, 2, -3.5]}, 0.5);
    }))");
    EXPECT_NEAR(turned["heading"], 90, 1e-9);
    EXPECT_NEAR(turned["pitch"], 20, 1e-9);
    EXPECT_NEAR(turned["roll"], 10, 1e-9);
    EXPECT_NEAR(turned["depth"], 4, 1e-12);
}

TEST_F(PageTest, ALogsTimelineTellsWhereItIsAndGoesElsewhere) {
    ASSERT_TRUE(becomes("document.querySelector('.timeline .figure')?.textContent === '25.0 / 100.0 s'"));
    const auto pull = [&](const std::string& to) {
        value("(() => { const slider = document.querySelector('.timeline input'); slider.value = " + to +
              "; slider.dispatchEvent(new Event('input')); slider.dispatchEvent(new Event('change')); })()");
    };
    pull("60");
    EXPECT_TRUE(becomes("document.querySelector('.timeline .figure').textContent === '60.0 / 100.0 s'"));
    pull("95");
    EXPECT_TRUE(becomes("/not the last 10 s/.test(document.querySelector('.timeline .refused').textContent)"));
    EXPECT_TRUE(becomes("document.querySelector('.timeline input').value === '60'")) << "it shows where the log is";
}

TEST_F(PageTest, RangeGainAndFrequencyComeFirst) {
    // Of the sonar that is shown, in this order, whichever task has them.
    const json found = value(R"(import('./first.js').then(({First}) => {
        const property = (name) => ({name, type: 'double', unit: 'x', doc: ''}), task = (name, ...names) => ({name, properties: names.map(property)});
        const first = new First({}, document.createElement('span'));
        first.setInterfaces({control: true, tasks: [task('other', 'range'), task('sonar', 'bins', 'frequency_khz', 'range'), task('receiver', 'gain_db')]});
        first.update({tasks: [{name: 'sonar', properties: {range: 50}}], connections: [{from: 'sonar.ping', to: 'receiver.in'}]}, 'receiver.ping');
        return [[...first.place.children].map((one) => one.title.split(':')[0]), first.place.querySelector('input').value];
    }))");
    EXPECT_EQ(found, json({{"sonar.range", "receiver.gain_db", "sonar.frequency_khz"}, "50"}));
    const json sorted = value(R"(import('./tables.js').then(({rank}) =>
        ['bins', 'frequency_khz', 'range', 'gain_db', 'more'].map((name) => ({name})).sort((a, b) => rank(a) - rank(b)).map((one) => one.name)))");
    EXPECT_EQ(sorted, json({"range", "gain_db", "frequency_khz", "bins", "more"}));
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
    EXPECT_TRUE(becomes("look().path > 5")) << "a path grows until it is longer than the vehicle that hides it";
    const json seen = value("look()");
    EXPECT_GT(seen["colours"], 50) << seen;
    for (const auto& [part, least] : {std::pair("scene", 1000), {"fan", 1000}, {"water", 1000}})
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
