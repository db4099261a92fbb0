// The page in a real browser.
#include <gmock/gmock.h>

#include "tests/viewer/Client.hpp"
#include "tests/viewer/Page.hpp"

namespace insonify::viewer {
namespace {

using testing::HasSubstr;

TEST_F(PageTest, SetsAPropertyInItsField) {
    EXPECT_EQ(value("[...document.getElementById('task').options].map((one) => one.value)"),
              json({"source", "world", "viewer"}));
    choose("task", "source");
    enter(getField("level"), "10");
    EXPECT_TRUE(becomes("Math.abs(insonify.fan.ping.top_db - 10) < 0.1")) << "of a level ten times as high";
    EXPECT_TRUE(becomes("insonify.status().tasks[0].properties.level == 10"));
    enter(getField("level"), "1000");
    EXPECT_TRUE(becomes(getRefusal(getField("level")) + " === 'level: is 1000; may be 0 to 100'"));
    EXPECT_TRUE(becomes(getField("level") + ".value === '10'")) << "it shows what holds";
}

TEST_F(PageTest, ReplacesABlockSoThatRowsMayBecomeABudget) {
    choose("task", "source");
    enter(getField("quality"), "{budget_ms: 20}");
    EXPECT_TRUE(becomes("insonify.status().tasks[0].properties.quality === '{\"budget_ms\": 20}'"));
    EXPECT_EQ(value(getRefusal(getField("quality"))), "");
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

TEST_F(PageTest, ListsTasksPlansAndLosses) {
    EXPECT_TRUE(becomes("document.querySelectorAll('#tasks .Running').length === 3"));
    EXPECT_EQ(value("[...document.querySelectorAll('#tasks tr')].map((row) => row.cells[0].textContent)"),
              json({"task", "source", "world", "viewer"}));
    EXPECT_EQ(value("[...document.querySelectorAll('#plan dt, #plan dd')].map((one) => one.textContent)"),
              json({"multipath", "not asked for"}));
    EXPECT_EQ(value("[...document.querySelectorAll('#plan h3')].map((one) => one.textContent)"),
              json({"world", "omitted", "lost samples", "replaced by newer samples, as configured"}));
    EXPECT_THAT(text("plan"),
                testing::AllOf(HasSubstr("64 rows, 2 columns per beam, rays, predicted error 0.01"),
                               HasSubstr("compiled: cones"), HasSubstr("run: draw, sum"), HasSubstr("a notice")));
    EXPECT_TRUE(
        becomes("/^[1-9][0-9]*  world.pose > viewer.pose \\(buffer\\)$/.test(document.querySelector('#plan "
                ".refused').textContent)"))
        << "a buffer of one that gets two poses each time";
    const std::string meant = "[...document.querySelectorAll('#plan .dim')].at(-1)";
    EXPECT_TRUE(becomes("/^[1-9][0-9]*  world.pose > viewer.newest \\(data\\)$/.test(" + meant + ".textContent)"))
        << "the newest of two poses is wanted, and is not a loss";
    EXPECT_EQ(value("document.querySelectorAll('#plan .refused').length"), 1);
    EXPECT_TRUE(
        becomes("document.querySelector('#graph .lost').textContent === "
                "'-' + insonify.status().connections.find((one) => one.policy === 'buffer' && one.lost).lost"))
        << "nor is it in the drawing";
    EXPECT_EQ(value("document.querySelectorAll('#graph .node').length"), 3);
    EXPECT_EQ(value("document.querySelectorAll('#graph .edge').length"), 2);
}

TEST_F(PageTest, DoesNotShowARefusedSettingInTheTaskTable) {
    EXPECT_THROW(running->deployment().call("source.setLevel", {"66"}), std::exception);
    ASSERT_TRUE(becomes("/66 is no level/.test(insonify.status().tasks[0].error)"));
    EXPECT_TRUE(becomes("/66 is no level/.test(document.querySelectorAll('#tasks tr')[1].title)"));
    EXPECT_EQ(value("document.querySelectorAll('#tasks tr')[1].cells[1].textContent"), "Running");
    EXPECT_THAT(text("tasks"), testing::Not(HasSubstr("66")));
}

TEST_F(PageTest, HoveringMovesNothing) {
    running->deployment().pause(true);  // numbers get wider as the vehicle moves
    ASSERT_TRUE(becomes("insonify.status().paused"));
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

TEST_F(PageTest, AllPartsCanBeReachedFrom400To1920Pixels) {
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

TEST_F(PageTest, ALogsTimelineShowsItsTimeAndSeeks) {
    ASSERT_TRUE(becomes("document.querySelector('.timeline .figure')?.textContent === '25.0 / 100.0 s'"));
    const std::string slider = "document.querySelector('.timeline input')";
    /** Drags the knob, or clicks the line away from the knob. */
    const auto pull = [&](double from_s, double to_s) {
        const json box = value(slider + ".getBoundingClientRect().toJSON()");
        const double knob = 16, width = box["width"].get<double>() - knob, y = box["top"].get<double>() + 8;
        const auto at = [&](double s) { return box["left"].get<double>() + knob / 2 + width * s / 100; };
        browser->drag(at(from_s), y, at(to_s) - at(from_s), 0);
    };
    pull(25, 60);
    EXPECT_TRUE(becomes("Math.abs(insonify.status().tasks[1].playback.at_s - 60) < 1"));
    EXPECT_TRUE(
        becomes("/^(59|60)[.0-9]* [/] 100.0 s$/.test(document.querySelector('.timeline .figure').textContent)"));
    pull(60, 95);
    EXPECT_TRUE(becomes("/not the last 10 s/.test(document.querySelector('.timeline .refused').textContent)"));
    EXPECT_TRUE(becomes("Math.abs(" + slider + ".value - 60) < 1")) << "it shows where the log is";

    browser->click(slider);
    browser->press("Home");
    EXPECT_TRUE(becomes("insonify.status().tasks[1].playback.at_s === 0"));
    browser->press("PageUp");
    EXPECT_TRUE(becomes("insonify.status().tasks[1].playback.at_s > 5")) << "keys move it";
    EXPECT_EQ(value("document.querySelector('.timeline .refused').textContent"), "");
}

TEST_F(PageTest, ATimelineDraggedBackKeepsFollowingTheLog) {
    ASSERT_TRUE(becomes("document.querySelector('.timeline .figure')?.textContent === '25.0 / 100.0 s'"));
    const std::string slider = "document.querySelector('.timeline input')";
    const json at = value("(() => { const box = " + slider + R"(.getBoundingClientRect();
        return [box.left + 8 + (box.width - 16) * 0.25, box.top + 8]; })())");
    for (const auto& [kind, dx] :
         {std::pair("mousePressed", 0), {"mouseMoved", 50}, {"mouseMoved", 0}, {"mouseReleased", 0}})
        browser->mouse(kind, at[0].get<double>() + dx, at[1], {{"button", "left"}, {"buttons", 1}, {"clickCount", 1}});
    running->deployment().call("world.seek", {"70"});
    EXPECT_TRUE(becomes("Math.abs(" + slider + ".value - 70) < 0.1"));
}

TEST_F(PageTest, RangeGainAndFrequencyComeFirst) {
    // The properties of the shown sonar, in this order, from any task that has them.
    const json found = value(R"(import('./fields.js').then(({First}) => {
        const property = (name) => ({name, type: 'double', unit: 'x', doc: ''}), task = (name, ...names) => ({name, properties: names.map(property)});
        const first = new First({}, document.createElement('span'));
        first.setInterfaces({control: true, tasks: [task('other', 'range'), task('sonar', 'bins', 'frequency_khz', 'range'), task('receiver', 'gain_db')]});
        first.update({tasks: [{name: 'sonar', properties: {range: 50}}], connections: [{from: 'sonar.ping', to: 'receiver.in'}]}, 'receiver.ping');
        return [[...first.place.children].map((one) => one.title.split(':')[0]), first.place.querySelector('input').value];
    }))");
    EXPECT_EQ(found, json({{"sonar.range", "receiver.gain_db", "sonar.frequency_khz"}, "50"}));
    const json sorted = value(R"(import('./fields.js').then(({rank}) =>
        ['bins', 'frequency_khz', 'range', 'gain_db', 'more'].map((name) => ({name})).sort((a, b) => rank(a) - rank(b)).map((one) => one.name)))");
    EXPECT_EQ(sorted, json({"range", "gain_db", "frequency_khz", "bins", "more"}));
}

TEST_F(PageTest, DrawsTheSceneTheWaterThePathAndTheFan) {
    if (!hasThree()) {
        EXPECT_TRUE(becomes("!document.getElementById('no_view').hidden")) << "no word of the 3-D view";
        GTEST_SKIP() << "NOT TESTED: no three.js was built in";
    }
    ASSERT_TRUE(becomes("insonify.world() && insonify.world().objects.size === 2 && insonify.snapshot()"));
    EXPECT_EQ(value("document.getElementById('no_view').hidden"), true);
    EXPECT_EQ(text("scene_text"), "4 triangles, 2 objects");
    ASSERT_TRUE(
        becomes("insonify.world().vehicles.get('world.pose')?.count > 20 && insonify.world().sonar.position.x > 3"));
    // The change that each part makes in the picture, and the number of colours.
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
    for (const auto& [part, minimum] : {std::pair("scene", 1000), {"fan", 1000}, {"water", 1000}})
        EXPECT_GT(seen[part], minimum) << seen;

    running->deployment().call("world.setWater", {"false"});
    EXPECT_TRUE(becomes("!insonify.world().water.visible")) << "a later snapshot has none";
}

TEST_F(PageTest, ShowsAMeshThatDeformsInItsShapeAndThenAtRest) {
    if (!hasThree()) GTEST_SKIP() << "NOT TESTED: no three.js was built in";
    ASSERT_TRUE(becomes("insonify.world() && insonify.world().objects.size === 2"));
    const std::string stone = "insonify.world().objects.get(1).mesh.geometry.attributes.position.array";
    for (const std::string height : {"1.5", "-0.5", "0"}) {
        running->deployment().call("world.setRaised", {height});
        EXPECT_TRUE(becomes("[2, 5, 8, 11].every((i) => " + stone + "[i] === " + height + ")")) << height;
        EXPECT_EQ(value("insonify.world().objects.get(0).mesh.geometry.attributes.position.array[2]"), 0) << height;
    }
}

TEST_F(PageTest, DraggingTurnsTheSceneAndTheWheelZooms) {
    if (!hasThree()) GTEST_SKIP() << "NOT TESTED: no three.js was built in";
    ASSERT_TRUE(becomes("insonify.world()?.content && insonify.snapshot()"));
    const json box = value(byId("view") + ".getBoundingClientRect().toJSON()");
    const double x = box["left"].get<double>() + 200, y = box["top"].get<double>() + 200;
    const json before =
        value("(({azimuth, elevation, distance}) => ({azimuth, elevation, distance}))(insonify.world())");
    browser->drag(x, y, 100, 50);
    EXPECT_NEAR(value("insonify.world().azimuth"), before["azimuth"].get<double>() - 0.6, 0.01);
    EXPECT_NEAR(value("insonify.world().elevation"), before["elevation"].get<double>() + 0.3, 0.01);
    browser->point(x, y);
    EXPECT_NEAR(value("insonify.world().azimuth"), before["azimuth"].get<double>() - 0.6, 0.01) << "the button is up";
    browser->wheel(x, y, -300);
    EXPECT_TRUE(becomes("insonify.world().distance < " + before["distance"].dump() + " * 0.8"));
}

TEST_F(PageTest, FingersTurnTheSceneAndZoom) {
    if (!hasThree()) GTEST_SKIP() << "NOT TESTED: no three.js was built in";
    ASSERT_TRUE(becomes("insonify.world()?.content && insonify.snapshot()"));
    const json box = value(byId("view") + ".getBoundingClientRect().toJSON()");
    const double x = box["left"].get<double>() + 200, y = box["top"].get<double>() + 200;
    const std::string camera =
        "(({azimuth, elevation, distance}) => ({azimuth, elevation, distance}))(insonify.world())";
    const json before = value(camera);
    browser->touch("touchStart", {{x, y}});
    for (const double dx : {25, 50, 75, 100}) browser->touch("touchMove", {{x + dx, y}});
    browser->touch("touchEnd", {});
    EXPECT_NEAR(value(camera)["azimuth"], before["azimuth"].get<double>() - 0.6, 0.1);

    const json turned = value(camera);
    browser->touch("touchStart", {{x, y - 30}, {x, y + 30}});
    for (const double half : {40, 60, 80, 90}) browser->touch("touchMove", {{x, y - half}, {x, y + half}});
    browser->touch("touchEnd", {});
    EXPECT_NEAR(value(camera)["distance"], turned["distance"].get<double>() / 3, turned["distance"].get<double>() / 10);
    EXPECT_EQ(value(camera)["azimuth"], turned["azimuth"]) << "two fingers turn nothing";
}

TEST_F(PageTest, DoesNotRedrawAnUnchangedSceneOnAnyScreen) {
    if (!hasThree()) GTEST_SKIP() << "NOT TESTED: no three.js was built in";
    ASSERT_TRUE(becomes("insonify.world()?.content && insonify.snapshot()"));
    for (const double scale : {1.0, 1.1, 1.25, 1.5, 2.0}) {
        browser->size(1283, 801, scale);
        nextFrame();
        EXPECT_EQ(value(R"((() => {
            const world = insonify.world(), {render} = world.renderer.info;
            world.draw();
            const frames = render.frame;
            world.draw();
            return [Math.abs(world.canvas.width - world.canvas.clientWidth * devicePixelRatio) < 1, render.frame - frames];
        })())"),
                  json({true, 0}))
            << scale;
    }
}

TEST_F(PageTest, TheFanIsAtThePoseOfItsPing) {
    if (!hasThree()) GTEST_SKIP() << "NOT TESTED: no three.js was built in";
    ASSERT_TRUE(becomes("insonify.world() && insonify.snapshot()"));
    running->deployment().pause(true);
    const auto now = [&] { return running->deployment().status().now.microseconds; };
    for (int i = 0; i < 2; ++i) {  // an instant with a snapshot, one without
        const int64_t before = now();
        running->deployment().step();
        ASSERT_TRUE(becomesTrue([&] { return now() == before + 10'000; }));
        const std::string time = std::to_string(now() / 20'000 * 20'000);
        EXPECT_TRUE(becomes("insonify.fan.ping.time_us === " + std::to_string(now())));
        EXPECT_TRUE(becomes("insonify.snapshot().time_us === " + time));
        EXPECT_TRUE(becomes("Math.abs(insonify.world().sonar.position.x - 2e-6 * " + time + ") < 1e-6"));
    }
}

TEST_F(PageTest, EachVehicleHasItsOwnPathThatEndsWhenTimeJumpsBack) {
    if (!hasThree()) GTEST_SKIP() << "NOT TESTED: no three.js was built in";
    ASSERT_TRUE(becomes("insonify.world()?.vehicles.size === 1"));
    value(
        R"(for (const [source, time_us] of [['a.pose', 5], ['b.pose', 5], ['a.pose', 6], ['a.pose', 7], ['b.pose', 2]])
        insonify.world().showPose({source, time_us, position: [time_us, 0, 0], orientation: [0, 0, 0, 1]}))");
    EXPECT_EQ(value("['a.pose', 'b.pose'].map((source) => insonify.world().vehicles.get(source).count)"), json({3, 1}));
    EXPECT_EQ(value("[...insonify.world().vehicles.get('a.pose').places.array.slice(0, 9)]"),
              json({5, 0, 0, 6, 0, 0, 7, 0, 0}));
}

TEST_F(PageTest, RestoresABrokenConnection) {
    const uint16_t port = quietPort();
    open("", port);
    keepConnection();
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

TEST_F(PageTest, ReopensASilentConnection) {
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
