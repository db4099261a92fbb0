// What an operator does with the page: marks targets, looks back, records, turns and enlarges the pictures.
#include <gmock/gmock.h>

#include <filesystem>
#include <fstream>
#include <map>
#include <sstream>

#include "tests/support/Folder.hpp"
#include "tests/viewer/Page.hpp"

namespace insonify::viewer {
namespace {

using testing::AllOf;
using testing::HasSubstr;
using testing::MatchesRegex;

struct OperatorTest : PageTest {
    bool isOn(const std::string& button) { return value(byId(button) + ".getAttribute('aria-pressed') === 'true'"); }
    /** Returns a file that the browser saves, once it is complete. */
    std::string saved(const Folder& folder, const std::string& name, const std::string& ending) {
        std::string content;
        EXPECT_TRUE(becomesTrue([&] {
            std::stringstream text;
            text << std::ifstream(folder / name).rdbuf();
            content = text.str();
            return content.ends_with(ending);
        })) << name
            << ": " << content;
        return content;
    }
};

TEST_F(OperatorTest, ATargetStaysWhereItIsWhileTheVehicleMoves) {
    ASSERT_TRUE(becomes("insonify.snapshot()?.water_surface === 0"));
    click("target");
    EXPECT_EQ(value(byId("marked") + ".hidden"), true);
    clickAt(12, 0);
    ASSERT_TRUE(becomes("insonify.fan.targets.length === 1"));
    const json mark = value("insonify.settings.targets[0]");
    EXPECT_NEAR(mark["range"], 12, 0.1);
    EXPECT_EQ(mark["depth"], 2) << "the sonar is 2 m deep and level";
    EXPECT_EQ(mark["source"], "source.ping");
    EXPECT_THAT(text("targets"), AllOf(HasSubstr("range m"), HasSubstr("12."), HasSubstr("depth"), HasSubstr("2.0")));
    // The vehicle moves north with 2 m/s: the mark comes nearer on the picture, and is drawn there.
    EXPECT_TRUE(becomes("insonify.fan.targets[0].range < " + mark["range"].dump() + " - 1"));
    EXPECT_NEAR(value("(() => { const {fan, snapshot, settings} = insonify; return fan.targets[0].range + "
                      "snapshot().position[0] - settings.targets[0].position[0]; })()"),
                0, 0.05);
    EXPECT_EQ(value(R"((() => {
        const {fan} = insonify, {prototype} = CanvasRenderingContext2D, draw = prototype.fillText, texts = [];
        prototype.fillText = (text) => texts.push(text);
        fan.draw();
        prototype.fillText = draw;
        return texts.includes('T1');
    })())"),
              true);
    if (hasThree()) {
        ASSERT_TRUE(becomes("insonify.world()?.marks?.geometry.attributes.position.count === 1"));
        EXPECT_GT(value(R"((() => {
            const world = insonify.world(), gl = world.renderer.getContext(), all = new Uint8Array(4 * gl.drawingBufferWidth * gl.drawingBufferHeight);
            world.dirty = true;
            world.draw();
            gl.readPixels(0, 0, gl.drawingBufferWidth, gl.drawingBufferHeight, gl.RGBA, gl.UNSIGNED_BYTE, all);
            return new Uint32Array(all.buffer).filter((pixel) => pixel === 0xff8af08d).length;
        })())"),
                  30)
            << "it is seen in the scene";
    }

    click("target");
    clickAt(10, 0);
    EXPECT_EQ(value("insonify.settings.targets.length"), 1) << "the tool is put away";
    value("self.is_old = true, location.reload()");
    ASSERT_TRUE(
        becomes("!self.is_old && self.insonify?.settings.targets.length === 1 && !" + byId("marked") + ".hidden"));
    enter("document.querySelector('#targets input')", "wreck");
    EXPECT_TRUE(becomes("insonify.settings.targets[0].name === 'wreck'"));
    browser->click("document.querySelector('#targets button')");
    EXPECT_EQ(value("insonify.settings.targets.length"), 0);
    EXPECT_EQ(value(byId("marked") + ".hidden"), true);
}

TEST_F(OperatorTest, TargetsAreSavedAsCsvAndGeoJson) {
    const Folder folder;
    browser->saveFilesIn(folder.path());
    click("target");
    clickAt(6, 30);
    clickAt(9, -10);
    ASSERT_EQ(value("insonify.settings.targets.length"), 2);
    enter("document.querySelector('#targets input')", "a \"b\", c");
    const json marks = value("insonify.settings.targets");
    click("CSV");
    std::istringstream csv(saved(folder, "targets.csv", "\n"));
    std::string head, first, second, rest;
    std::getline(csv, head);
    std::getline(csv, first);
    std::getline(csv, second);
    EXPECT_FALSE(std::getline(csv, rest));
    EXPECT_THAT(head, testing::StartsWith(
                          "name,time,source,range_m,bearing_starboard_deg,sonar_heading_deg,bearing_true_deg,"));
    EXPECT_THAT(first, AllOf(testing::StartsWith("\"a \"\"b\"\", c\","), HasSubstr(",source.ping,"),
                             testing::EndsWith(",2,,,")))
        << "without a datum no place on the Earth";
    EXPECT_THAT(second, MatchesRegex("T2,[0-9.]+ s,source.ping,[89].[0-9]+,(9|10)[0-9.]*,0,(9|10)[.0-9]*,.*"));

    click("GeoJSON");
    const json all = json::parse(saved(folder, "targets.geojson", "}"));
    EXPECT_EQ(all["type"], "FeatureCollection");
    EXPECT_THAT(all["frame"].get<std::string>(), HasSubstr("metres east, north and up"));
    ASSERT_EQ(all["features"].size(), 2u);
    EXPECT_NEAR(all["features"][1]["geometry"]["coordinates"][0], -marks[1]["position"][1].get<double>(), 1e-3);
    EXPECT_NEAR(all["features"][1]["geometry"]["coordinates"][1], marks[1]["position"][0].get<double>(), 1e-3);
    EXPECT_EQ(all["features"][0]["properties"]["name"], "a \"b\", c");
}

TEST_F(OperatorTest, PlacesAndPositionsAgreeForAnyPoseAndDatum) {
    const json wrong =
        value(R"(import('./targets.js').then(({getPosition, getPlace, onEarth, toCsv, toGeoJson, findDatum}) => {
        let seed = 11;
        const random = (low, high) => low + (high - low) * (seed = (seed * 48271) % 2147483647) / 2147483647, wrong = [];
        for (let draw = 0; draw < 500; ++draw) {
            const q = [0, 1, 2, 3].map(() => random(-1, 1)), size = Math.hypot(...q);
            const pose = {position: [0, 1, 2].map(() => random(-500, 500)), orientation: q.map((x) => x / size)};
            const place = {range: random(0.1, 200), bearing: random(-3.14, 3.14)}, at = getPosition(place, pose), back = getPlace(at, pose);
            if (Math.abs(back.range - place.range) > 1e-6 || Math.abs(back.bearing - place.bearing) > 1e-6) wrong.push(['place', place, back]);

            // By the radii of curvature of WGS 84, for small offsets.
            const datum = {latitude_deg: random(-85, 85), longitude_deg: random(-179, 179), height_m: random(-50, 500)}, offset = [random(-99, 99), random(-99, 99), random(-50, 50)];
            const found = onEarth(offset, datum), rad = datum.latitude_deg * Math.PI / 180, e2 = 0.00669437999014, w = Math.sqrt(1 - e2 * Math.sin(rad) ** 2);
            const north = (found.latitude - datum.latitude_deg) * Math.PI / 180 * (6378137 * (1 - e2) / w ** 3 + datum.height_m);
            const east = (found.longitude - datum.longitude_deg) * Math.PI / 180 * (6378137 / w + datum.height_m) * Math.cos(rad);
            if (Math.abs(north - offset[0]) > 0.02 || Math.abs(east + offset[1]) > 0.02 || Math.abs(found.height - datum.height_m - offset[2]) > 0.01)
                wrong.push(['earth', datum, offset, north, east, found.height]);
            const target = {name: 'x', time_us: 5, source: 's', ...place, heading: 10, position: offset, depth: null};
            const [lon, lat] = JSON.parse(toGeoJson([target], datum)).features[0].geometry.coordinates, cells = toCsv([target], datum).split('\n')[1].split(',');
            if (Math.abs(lat - found.latitude) > 1e-8 || Math.abs(lon - found.longitude) > 1e-8 || Number(cells[11]) !== lat || Number(cells[12]) !== lon)
                wrong.push(['files', lat, lon, cells]);
        }
        // Far from the datum: a quarter of the equator ahead of it, seen along a straight line.
        const far = onEarth([0, -6378137, -6378137], {latitude_deg: 0, longitude_deg: 0});
        if (Math.abs(far.longitude - 90) > 1e-9 || Math.abs(far.height) > 1e-6) wrong.push(['far', far]);
        const unknown = toCsv([{name: '', time_us: 1.7e15, source: 's', range: 1, bearing: 0, heading: null, position: null, depth: null}]).split('\n')[1];
        if (unknown !== ',2023-11-14T22:13:20.000Z,s,1,0,,,,,,,,,') wrong.push(unknown);
        const held = (...datums) => findDatum({tasks: datums.map((datum) => ({properties: {datum}}))});
        for (const none of [held(), held('', '7', '{', '{"latitude_deg": 5}', undefined), findDatum(null)]) if (none !== undefined) wrong.push(none);
        if (held(undefined, '{"latitude_deg": 54.5, "longitude_deg": 10.25, "height_m": 3}')?.height_m !== 3) wrong.push('datum');
        return wrong.slice(0, 3);
    }))");
    EXPECT_EQ(wrong, json::array());
}

TEST_F(OperatorTest, ALineLeadsFromTheSonarToTheCursorAndStaysAfterAClick) {
    const auto drawn = [&] {
        return value(R"((() => {
            const {fan} = insonify, {prototype} = CanvasRenderingContext2D, draw = prototype.fillText, texts = [];
            prototype.fillText = (text) => texts.push(text);
            fan.draw();
            prototype.fillText = draw;
            return texts.filter((text) => /m  .*°/.test(text));
        })())");
    };
    click("line");
    clickAt(8, -20);
    browser->point(1, 1);
    nextFrame();
    ASSERT_EQ(drawn().size(), 1u);
    EXPECT_THAT(drawn()[0], MatchesRegex("(7.9|8.0)[0-9] m  (19|20).[0-9]° stbd"));
    EXPECT_NEAR(value("insonify.fan.line.range"), 8, 0.1);
    browser->press("Escape");
    EXPECT_EQ(drawn(), json::array());
    EXPECT_EQ(value("insonify.fan.line"), nullptr);
}

TEST_F(OperatorTest, AProfileShowsTheLevelsOfABeam) {
    browser->press("b");
    ASSERT_FALSE(value(byId("profiled") + ".hidden"));
    readAt(6.75, 8);
    // Beams are from starboard to port; the echo is in bins 40 to 49 of 0.15 m.
    EXPECT_TRUE(becomes("/^beam 19 of 32, [78].[0-9]° port, .* strongest 0.0 dB at 6.[0-9]* m$/.test(" + byId("beam") +
                        ".textContent)"))
        << text("beam");
    readAt(6.75, -30);
    EXPECT_TRUE(becomes("/ stbd, .* no echo$/.test(" + byId("beam") + ".textContent)")) << text("beam");
    EXPECT_GT(value("document.getElementById('levels').height"), 30);
}

TEST_F(OperatorTest, ThePictureCanBeFrozenSteppedBackPlayedAndLiveAgain) {
    ASSERT_TRUE(becomes("insonify.history.entries.length > 20"));
    EXPECT_TRUE(isOn("live"));
    browser->press("Space");
    EXPECT_TRUE(isOn("freeze"));
    EXPECT_FALSE(isOn("live"));
    const double frozen = value("insonify.fan.ping.time_us");
    browser->press("[", 3);
    nextFrame();
    const double before = value("insonify.fan.ping.time_us");
    EXPECT_LT(before, frozen);
    EXPECT_EQ(value("insonify.attitude().source"), "world.pose");
    EXPECT_NEAR(value("insonify.snapshot().position[0]").get<double>(), 2e-6 * before, 0.05) << "with its pose";
    EXPECT_TRUE(becomes("/^frozen, [0-9.]+ s ago$/.test(" + byId("past") + ".textContent)"));
    browser->press("]");
    EXPECT_GT(value("insonify.fan.ping.time_us"), before);
    ASSERT_TRUE(becomes("insonify.history.newest.at - insonify.history.entries[0].at > 4"));
    browser->press("Space");
    EXPECT_TRUE(isOn("live"));

    value(byId("moment") + ".focus()");
    browser->press("Home");
    EXPECT_TRUE(becomes("insonify.fan.ping === insonify.history.entries[0].ping")) << "the oldest";
    EXPECT_THAT(text("moment_text"), MatchesRegex("-[0-9.]+ s"));
    const double oldest = value("insonify.fan.ping.time_us");
    browser->press("p");
    EXPECT_TRUE(becomes("insonify.fan.ping.time_us > " + std::to_string(oldest + 300'000)));
    EXPECT_THAT(text("past"), HasSubstr("playing"));
    EXPECT_FALSE(isOn("live"));
    browser->press("p");
    EXPECT_THAT(text("past"), HasSubstr("frozen"));
    browser->press("]", 2);
    const double stopped = value("insonify.fan.ping.time_us");
    EXPECT_EQ(value("new Promise((done) => setTimeout(() => done(insonify.fan.ping.time_us), 500))"), stopped);
    click("live");
    EXPECT_TRUE(becomes(byId("past") + ".hidden && insonify.fan.ping === insonify.history.newest.ping"));
}

TEST_F(OperatorTest, TheLastMinuteStaysAMinuteInLittleMemory) {
    const json wrong = value(R"(import('./ping.js').then(({History, Scan}) => {
        let seed = 5;
        const random = () => (seed = (seed * 48271) % 2147483647) / 2147483647, wrong = [];
        for (let draw = 0; draw < 30; ++draw) {
            const most = 1000 + 20000 * random(), size = 1 + Math.floor(3000 * random()), rate = 0.2 + 30 * random(), history = new History(60, most);
            const shared = {data: new Uint8Array(size), beams: 2};
            for (let i = 0, at = 0; i < 3000 && at < 200; ++i, at += (0.5 + random()) / rate) {
                history.add({...shared, i}, at);
                const {entries} = history;
                if (history.newest.ping.i !== i) wrong.push('the newest is not there');
                if (history.bytes !== entries.length * size) wrong.push('bytes');
                if (entries.length > 1 && history.bytes > most) wrong.push(['too much', history.bytes, most]);
                if (at - entries[0].at > 60) wrong.push('too old');
            }
            const {entries} = history, span = entries.at(-1).at - entries[0].at;
            if (entries.some((one, i) => i && one.at <= entries[i - 1].at)) wrong.push('order');
            if (most / size > 20 && entries.at(-1).at > 100 && span < 50) wrong.push(['short', span, most / size, rate]);
            const some = entries[Math.floor(random() * entries.length)];
            if (history.at(some.at) !== some || history.at(-1) !== entries[0]) wrong.push('at');
            if (history.beside(entries.at(-1), 1) || history.beside(entries[0], -1)) wrong.push('ends');
        }
        // A scanning head: the disc as it was.
        const history = new History(), beam = (deg, level) => ({beams: 1, bins: 2, bin_m: 1, bearings: [deg * Math.PI / 180], beam_width: 0.01, top_db: 0, step_db: 0.4, data: new Uint8Array([level, level])});
        for (let i = 0; i < 10; ++i) history.add(beam(10 * i, 200), i);
        const lit = (disc) => disc.data.filter((level) => level).length, early = lit(history.shown(history.entries[2])), late = lit(history.shown(history.entries[9]));
        if (!(early > 0 && late > 3 * early)) wrong.push(['disc', early, late]);
        return wrong.slice(0, 4);
    }))");
    EXPECT_EQ(wrong, json::array());
}

TEST_F(OperatorTest, RecordingShowsItsSizeAndTheTimeLeft) {
    EXPECT_EQ(value(byId("recorded") + ".hidden"), true);
    const std::string places =
        "JSON.stringify([...document.querySelectorAll('.picture')].map((one) => one.getBoundingClientRect()))";
    std::map<int, json> before;
    for (const int width : {390, 1920, 1280}) {
        browser->size(width, 800);
        nextFrame();
        before[width] = value(places);
    }
    click("● source");
    ASSERT_TRUE(becomes("/^REC [0-9.]+ MB, 50.0 GB free$/.test(" + byId("recorded") + ".textContent)"));
    // A megabyte each 10 ms: 50 GB last 500 s.
    EXPECT_TRUE(becomes("/^REC [0-9.]+ [MG]B, [0-9]+ min left$/.test(" + byId("recorded") + ".textContent)"))
        << text("recorded");
    EXPECT_EQ(value(byId("recorded") + ".title"), "dives/dive.3.log");
    for (const int width : {390, 1920, 1280}) {
        browser->size(width, 800);
        nextFrame();
        EXPECT_EQ(value(places), before[width]) << "it moves the pictures at " << width;
        EXPECT_GT(value(byId("recorded") + ".getBoundingClientRect().width"), 60) << width;
    }
    EXPECT_NE(value("getComputedStyle(document.getElementById('recorded')).backgroundColor"), "rgba(0, 0, 0, 0)");
    EXPECT_TRUE(value("[...document.querySelectorAll('#controls button')][0].getAttribute('aria-pressed') === 'true'"));
    click("● source");
    EXPECT_TRUE(becomes(byId("recorded") + ".hidden"));
}

TEST_F(OperatorTest, NorthIsUpIfItIsWanted) {
    click("freeze");
    for (const double heading : {0.0, 40.0, 180.0, 300.0}) {
        value("insonify.fan.orient(true, " + std::to_string(heading) + "), insonify.fan.draw()");
        EXPECT_EQ(pixelAt(6.75, 5), brightest) << heading;
        EXPECT_EQ(pixelAt(5.7, 0), darkest) << heading;
        EXPECT_THAT(readAt(6.75, 8), MatchesRegex("6.7[0-9] m   [78].[0-9]° port.*")) << heading;
        const json place = value(
            "(() => { const {fan} = insonify, [x, y] = fan.findPixel(6, 0), [u, v] = fan.findPixel(0, 0); "
            "return [x - u, y - v]; })()");
        EXPECT_NEAR(std::atan2(place[0].get<double>(), place[1].get<double>()),
                    std::remainder(types::radians(heading), 2 * M_PI), 1e-6)
            << "clockwise from above";
    }
    value("insonify.fan.orient(false, 40), insonify.fan.draw()");
    EXPECT_EQ(value("insonify.fan.turn"), 0);
    value("insonify.fan.orient(true, undefined)");
    EXPECT_EQ(value("insonify.fan.turn"), 0) << "without a heading it cannot";
    browser->press("n");
    EXPECT_TRUE(becomes("insonify.fan.is_turned && (!insonify.world() || insonify.world().is_north_up)"));
}

TEST_F(OperatorTest, EitherPictureFillsThePage) {
    for (const int width : {390, 1280, 1920}) {
        browser->size(width, 900);
        for (const auto& [key, shown, hidden] : {std::tuple("2", "fan", "view"), {"3", "view", "fan"}}) {
            browser->press(key);
            nextFrame();
            const json box = value(byId(shown) + ".getBoundingClientRect().toJSON()");
            EXPECT_GT(box["width"], width * 0.98) << key << " " << width;
            EXPECT_GT(box["height"], 450) << key << " " << width;
            EXPECT_EQ(value(byId(hidden) + ".getBoundingClientRect().width"), 0);
            EXPECT_EQ(value("document.querySelector('footer').offsetHeight"), 0);
            EXPECT_LE(value("document.documentElement.scrollWidth"), width);
        }
        browser->press("1");
        EXPECT_GT(value("document.querySelector('footer').offsetHeight"), 100);
    }
    click("full");
    EXPECT_TRUE(isOn("full_fan"));
    EXPECT_EQ(pixelAt(6.75, 5), brightest);
    click("full");
    EXPECT_FALSE(isOn("full_fan"));
}

TEST_F(OperatorTest, FeetAndKnots) {
    set("units", "imperial");
    EXPECT_THAT(readAt(6.75, 8), MatchesRegex("22.[012] ft .*"));
    EXPECT_TRUE(becomes(byId("attitude") + ".textContent.includes('depth6.6 ft')"));
    EXPECT_TRUE(becomes(byId("attitude") + ".textContent.includes('speed3.9 kn')")) << "once half a second is known";
    EXPECT_THAT(text("pose_text"), HasSubstr(" ft"));
    EXPECT_EQ(value(R"((() => {
        const {fan} = insonify, {prototype} = CanvasRenderingContext2D, draw = prototype.fillText, texts = [];
        prototype.fillText = (text) => texts.push(text);
        fan.draw();
        prototype.fillText = draw;
        return texts.filter((text) => text.endsWith('ft')).slice(0, 3);
    })())"),
              json({"10 ft", "20 ft", "30 ft"}));
}

TEST_F(OperatorTest, TheHandlesOfTheContrastStayApart) {
    value(byId("high") + ".focus()");
    browser->press("ArrowLeft", 50);
    EXPECT_EQ(value("insonify.settings.high"), -40);
    EXPECT_EQ(value(byId("high") + ".value"), "-40");
    slide("low", -60);
    EXPECT_EQ(value("[insonify.fan.span_db, insonify.settings.low]"), json({20, -60}));
    // By the mouse: the handle that is nearer moves.
    const json box = value(byId("low") + ".getBoundingClientRect().toJSON()");
    const double y = box["top"].get<double>() + 9, left = box["left"].get<double>() + 4.5,
                 scale = (box["width"].get<double>() - 9) / 180;
    for (const auto& [from, to, handle] : {std::tuple(-40, 0, "high"), {-60, -100, "low"}}) {
        browser->point(left + (from + 120) * scale, y);
        browser->drag(left + (from + 120) * scale, y, (to - from) * scale, 0);
        EXPECT_NEAR(value(std::string("insonify.settings.") + handle).get<double>(), to, 3) << handle;
    }
}

TEST_F(OperatorTest, WithoutAutomaticGainLevelsStay) {
    browser->click(byId("auto"));
    const double top = value("insonify.fan.top_db");
    running->deployment().call("source.setLevel", {"100"});
    ASSERT_TRUE(becomes("Math.abs(insonify.fan.ping.top_db - 20) < 0.1"));
    EXPECT_NEAR(value("insonify.fan.top_db").get<double>(), top, 1e-6);
    EXPECT_EQ(text("contrast"), "-45 to 0 dB");
    browser->click(byId("auto"));
    EXPECT_TRUE(becomes("insonify.fan.top_db > 19")) << "again it follows the echoes";
}

}  // namespace
}  // namespace insonify::viewer
