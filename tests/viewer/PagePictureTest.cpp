// The picture of a ping on the page, in a real browser.
#include <gmock/gmock.h>

#include <opencv2/imgcodecs.hpp>
#include <regex>

#include "tests/support/Folder.hpp"
#include "tests/viewer/Page.hpp"

namespace insonify::viewer {
namespace {

using testing::HasSubstr;

TEST_F(PageTest, DrawsAPingUnchanged) {
    for (const bool polar : {false, true}) {
        if (polar) click("fan");
        for (const double bearing : {-16.0, 0.0, 10.5})
            EXPECT_EQ(pixelAt(6.75, bearing), brightest) << bearing << (polar ? ", polar" : "");
        for (const auto& [range, bearing] : {std::pair(5.7, 0.0), {7.8, 0.0}, {6.75, -18.0}, {6.75, 12.5}})
            EXPECT_EQ(pixelAt(range, bearing), darkest) << range << " " << bearing << (polar ? ", polar" : "");
    }
    EXPECT_NE(pixelAt(16, 0), darkest) << "beyond the last bin there is no picture";
}

TEST_F(PageTest, DrawsAFanAcrossTheSeamBehindTheSonarWithEmptyGaps) {
    choose("map", "gray");
    click("freeze");
    // Beams from 150 to 160 and from 170 to 190 degrees; only the last has an echo.
    value(
        "(() => { const {fan} = insonify, rad = (all) => all.map((each) => each * Math.PI / 180), bins = 10;"
        "const ping = {...fan.ping, beams: 3, bins, bin_m: 1.5, edges: rad([150, 160, 170, 180, 180, 190]), data: new "
        "Uint8Array(30)}; ping.data.fill(255, 20); fan.show(ping, ping.top_db); fan.draw(); })()");
    const json white = {255, 255, 255}, black = {0, 0, 0};
    for (const bool polar : {false, true}) {
        if (polar) click("fan");
        for (const double bearing : {-172.0, -179.0, 181.5}) EXPECT_EQ(pixelAt(6.75, bearing), white) << bearing;
        for (const double bearing : {179.0, 172.0, 155.0}) EXPECT_EQ(pixelAt(6.75, bearing), black) << bearing;
        EXPECT_NE(pixelAt(6.75, 165), black) << "between beams there is no picture";
        EXPECT_THAT(readAt(6.75, -175), HasSubstr("   175.0° stbd"));
        EXPECT_EQ(readAt(6.75, 165), "");
    }
}

TEST_F(PageTest, ColourMapAndGainChangeThePicture) {
    choose("map", "gray");
    EXPECT_EQ(pixelAt(6.75, 0), json({255, 255, 255}));
    EXPECT_EQ(pixelAt(5.7, 0), json({0, 0, 0}));
    slide("high", 20);
    slide("low", -25);  // of 45 dB from black to white
    EXPECT_NEAR(pixelAt(6.75, 0)[0].get<int>(), 255 * 25 / 45, 5);
    EXPECT_EQ(text("contrast"), "-25 to 20 dB");
    slide("low", -70);
    EXPECT_NEAR(pixelAt(6.75, 0)[0].get<int>(), 255 * 70 / 90, 5);
}

TEST_F(PageTest, TheCursorShowsRangeBearingAndLevel) {
    for (const char* level : {"0.0 dB", "10.0 dB"}) {
        double range = 0, bearing = 0;
        char side[8] = "", rest[32] = "";
        const std::string reported = readAt(6.75, 8);
        ASSERT_EQ(std::sscanf(reported.c_str(), "%lf m %lf° %7s %31[^\n]", &range, &bearing, side, rest), 4)
            << reported;
        EXPECT_NEAR(range, 6.75, 0.05);
        EXPECT_NEAR(bearing, 8, 0.5);
        EXPECT_STREQ(side, "port");
        EXPECT_NEAR(std::stod(rest), std::stod(level), 0.05) << reported;
        running->deployment().call("source.setLevel", {"10"});
        ASSERT_TRUE(becomes("Math.abs(insonify.fan.ping.top_db - 10) < 0.1"));
    }
    EXPECT_THAT(readAt(3, -20), testing::AllOf(HasSubstr("stbd"), HasSubstr("no echo")));
    EXPECT_EQ(readAt(15.5, 0), "") << "beyond the last bin";
}

TEST_F(PageTest, BearingsHaveASideOrASignAsChosen) {
    const auto labels = [&] {
        return value(R"((() => {
            const {fan} = insonify, {prototype} = CanvasRenderingContext2D, draw = prototype.fillText, texts = [];
            prototype.fillText = (text) => texts.push(text);
            fan.draw();
            prototype.fillText = draw;
            return texts.filter((text) => text.endsWith('°')).slice(0, 2);
        })())");
    };
    struct Case {
        const char *choice, *port, *starboard;
        json labels;
    };
    for (const Case& one : {Case{"sides", "   8.0° port ", "   8.0° stbd ", {"45°", "30°"}},
                            {"starboard", "   -8.0° ", "   +8.0° ", {"+45°", "+30°"}},
                            {"port", "   +8.0° ", "   -8.0° ", {"-45°", "-30°"}},
                            {"true", "   352.0° ", "   008.0° ", {"045°", "030°"}}}) {
        SCOPED_TRACE(one.choice);
        set("bearings", one.choice);
        const auto tenths = [](std::string text) { return std::regex_replace(text, std::regex("[.][0-9]°"), ".0°"); };
        EXPECT_THAT(tenths(readAt(6.75, 8.05)), HasSubstr(one.port));
        EXPECT_THAT(tenths(readAt(6.75, -8.05)), HasSubstr(one.starboard));
        EXPECT_EQ(labels(), one.labels);
    }
    EXPECT_EQ(text("reach"), "15.0 m, 32 x 100, 150 mm");
}

TEST_F(PageTest, CutsNoLabelOfThePicture) {
    for (const int width : {400, 500, 1600}) {
        browser->size(width, 900);
        nextFrame();
        // In one step, before the next ping is shown: a range with the widest labels of rings.
        const json cut = value(R"((() => {
            const {fan} = insonify, {prototype} = CanvasRenderingContext2D, draw = prototype.fillText, texts = [];
            prototype.fillText = function(text, x, ...more) {
                const half = this.measureText(text).width / 2;
                texts.push([text, x - half >= 0 && x + half <= fan.overlay.width]);
                return draw.call(this, text, x, ...more);
            };
            for (const bin_m of [0.31, 1.01, 5.01]) {
                fan.show({...fan.ping, bin_m}, 0);
                fan.draw();
            }
            prototype.fillText = draw;
            return [[...new Set(texts.map(([text]) => text).filter((text) => ['30 m', '100 m', '500 m'].includes(text)))], texts.filter(([, whole]) => !whole)];
        })())");
        EXPECT_EQ(cut[0], json({"30 m", "100 m", "500 m"})) << width;
        EXPECT_EQ(cut[1], json::array()) << width;
    }
}

TEST_F(PageTest, AFrozenPingStaysWhileTheSonarContinues) {
    click("freeze");
    const json frozen = value("insonify.fan.ping.time_us");
    ASSERT_TRUE(
        becomes("Number(document.getElementById('time').textContent.slice(0, -2)) > " + frozen.dump() + "e-6 + 0.2"));
    EXPECT_EQ(value("insonify.fan.ping.time_us"), frozen);
    EXPECT_EQ(pixelAt(6.75, 0), brightest);
    click("freeze");
    EXPECT_TRUE(becomes("insonify.fan.ping.time_us > " + frozen.dump()));
}

TEST_F(PageTest, TheWheelZoomsAndDraggingMovesThePicture) {
    const auto at = windowAt(6.75, 0);
    browser->wheel(at[0], at[1], -800);
    ASSERT_TRUE(becomes("insonify.fan.zoom > 3"));
    // The mouse is at whole pixels.
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

TEST_F(PageTest, TwoFingersZoom) {
    const auto at = windowAt(6.75, 0);
    const auto fingers = [&](const char* kind, double apart) {
        browser->touch(kind, {{at[0], at[1] - apart / 2}, {at[0], at[1] + apart / 2}});
    };
    fingers("touchStart", 60);
    for (const double apart : {90, 120, 150, 180}) fingers("touchMove", apart);
    browser->touch("touchEnd", {});
    ASSERT_TRUE(becomes("insonify.fan.zoom > 2.5"));
    EXPECT_NEAR(windowAt(6.75, 0)[1], at[1], 20);
    browser->touch("touchStart", {at});
    browser->touch("touchMove", {{at[0] + 40, at[1]}});
    browser->touch("touchEnd", {});
    EXPECT_NEAR(windowAt(6.75, 0)[0], at[0] + 40, 20) << "one finger moves it";
}

TEST_F(PageTest, TwoClicksMeasureDistanceAndDirection) {
    click("measure");
    clickAt(6, 30);
    EXPECT_THAT(text("measured"), testing::StartsWith("6.0"));
    clickAt(6 * std::sqrt(3), 0);  // of a triangle of 6 m, 6 m and 6 sqrt 3 m
    const json found = value("insonify.fan.measured()");
    EXPECT_NEAR(found["distance"], 6, 0.06);
    EXPECT_NEAR(types::degrees(found["bearing"].get<double>()), -30, 1);
    EXPECT_THAT(text("measured"), testing::AllOf(HasSubstr(" m apart, towards "), HasSubstr("° stbd, 0")));
    double heading = 0;
    const std::string reported = text("measured");
    ASSERT_EQ(std::sscanf(reported.c_str() + reported.find("stbd, ") + 6, "%lf° true", &heading), 1) << reported;
    EXPECT_NEAR(heading, 30, 1) << "the sonar looks north";
    const auto at = windowAt(3, 0);
    for (const char* kind : {"mousePressed", "mouseReleased"})
        browser->mouse(kind, at[0], at[1], {{"button", "right"}, {"clickCount", 1}});
    EXPECT_EQ(value("insonify.fan.marks.length"), 2) << "the right button opens a menu";
    clickAt(3, 0);
    EXPECT_EQ(value("insonify.fan.marks.length"), 1) << "a third begins anew";
    click("measure");
    nextFrame();
    EXPECT_EQ(text("measured"), "");
}

TEST_F(PageTest, AClickWithShiftExplainsABin) {
    const auto explainAt = [&](double range, double bearing) {
        const auto at = windowAt(range, bearing);
        for (const char* kind : {"mousePressed", "mouseReleased"})
            browser->mouse(kind, at[0], at[1], {{"button", "left"}, {"clickCount", 1}, {"modifiers", 8}});
    };
    clickAt(6.75, 10);
    nextFrame();
    EXPECT_EQ(text("explained"), "");
    explainAt(6.75, 10);
    EXPECT_TRUE(becomes(byId("explained") + ".textContent === 'at 10 deg, 6.7 m' || " + byId("explained") +
                        ".textContent === 'at 10 deg, 6.8 m'"));
    explainAt(12.5, 0);
    EXPECT_TRUE(becomes(byId("explained") + ".textContent === 'there is no bin'"));
    explainAt(8, -10);
    EXPECT_TRUE(becomes(byId("explained") + ".textContent === 'at -10 deg, 8.0 m'"));
    clickAt(6.75, 10);
    EXPECT_TRUE(becomes(byId("explained") + ".textContent === ''"));
}

TEST_F(PageTest, MeasuresAlikeOnScreensOfAnyScale) {
    for (const double scale : {1.25, 2.0}) {
        browser->size(1280, 800, scale);
        ASSERT_TRUE(
            becomes("Math.abs(insonify.fan.canvas.width / insonify.fan.canvas.clientWidth - devicePixelRatio) < 0.01 "
                    "&& devicePixelRatio === " +
                    std::to_string(scale)));
        EXPECT_EQ(pixelAt(6.75, 0), brightest) << scale;
        EXPECT_EQ(pixelAt(5.7, 0), darkest) << scale;
        EXPECT_THAT(readAt(6.75, -8), testing::AllOf(HasSubstr("6.7"), HasSubstr(" 8."), HasSubstr("stbd"))) << scale;
        click("measure");
        clickAt(6, 30);
        clickAt(6, -30);
        EXPECT_NEAR(value("insonify.fan.measured().distance"), 6, 0.1) << scale;
        click("measure");
        const auto at = windowAt(6.75, 0);
        browser->wheel(at[0], at[1], -800);
        ASSERT_TRUE(becomes("insonify.fan.zoom > 3 / " + std::to_string(scale))) << scale;
        EXPECT_NEAR(windowAt(6.75, 0)[0], at[0], 3) << scale;
        click("whole");
    }
}

TEST_F(PageTest, ASnapshotIsThePictureAsAFile) {
    const Folder saved;
    browser->saveFilesIn(saved.path());
    browser->click(byId("rings"));
    click("freeze");
    click("snapshot");
    const std::filesystem::path file =
        saved / value("`source.ping_${insonify.fan.ping.time_us}.png`").get<std::string>();
    cv::Mat picture;  // of blue, green, red; the file may exist before all of it is written
    ASSERT_TRUE(becomesTrue([&] {
        picture = std::filesystem::exists(file) ? cv::imread(file.string()) : cv::Mat();
        return !picture.empty();
    })) << file;
    EXPECT_EQ(picture.rows, value("insonify.fan.canvas.height + 22"));
    EXPECT_EQ(picture.cols, value("insonify.fan.canvas.width"));
    const json at = value(
        "(() => { const {fan} = insonify, [x, y] = fan.findPixel(6.75, 0); return [x, fan.canvas.height - y]; })()");
    const auto pixel = picture.at<cv::Vec3b>(at[1].get<int>(), at[0].get<int>());
    EXPECT_EQ(json({pixel[2], pixel[1], pixel[0]}), brightest);
}

TEST_F(PageTest, SavesAFrozenPictureWithTheAttitudeShown) {
    ASSERT_TRUE(becomes("document.getElementById('attitude').textContent.includes('depth2.00 m')"));
    click("freeze");
    value(R"(import('./ping.js').then(({Places}) => {
        const {of} = Places.prototype;
        Places.prototype.of = function(...asked) { return {...of.apply(this, asked), position: [0, 0, -9]}; };
        const {fan} = insonify, draw = CanvasRenderingContext2D.prototype.fillText;
        CanvasRenderingContext2D.prototype.fillText = function(text, ...more) {
            if (text.startsWith(fan.ping.source)) self.caption = text;
            return draw.call(this, text, ...more);
        };
        HTMLAnchorElement.prototype.click = () => {};
    }))");
    slide("high", 3);
    click("snapshot");
    ASSERT_TRUE(becomes("self.caption"));
    EXPECT_THAT(value("self.caption").get<std::string>(), HasSubstr("depth 2.00 m"));
}

TEST_F(PageTest, ShowsHeadingDepthAndAttitudeOverThePicture) {
    ASSERT_TRUE(becomes("!document.getElementById('attitude').hidden"));
    EXPECT_TRUE(
        becomes("document.getElementById('attitude').textContent === "
                "'heading000.0°depth2.00 mpitch0.0°roll0.0°speed2.00 m/s'"))
        << text("attitude");
    // Turned to starboard by 90 degrees, then nose down by 20, then starboard down by 10: z, y, x of the body.
    const json turned = value(R"(import('./instruments.js').then(({computeAttitude}) => {
        const half = (deg) => deg * Math.PI / 360, product = ([ax, ay, az, aw], [bx, by, bz, bw]) =>
            [aw * bx + ax * bw + ay * bz - az * by, aw * by - ax * bz + ay * bw + az * bx, aw * bz + ax * by - ay * bx + az * bw,
             aw * bw - ax * bx - ay * by - az * bz];
        const about = (axis, deg) => [0, 1, 2].map((i) => i === axis ? Math.sin(half(deg)) : 0).concat(Math.cos(half(deg)));
        const orientation = product(product(about(2, -90), about(1, 20)), about(0, 10));
        return computeAttitude({orientation, position: [1, 2, -3.5]}, 0.5);
    }))");
    EXPECT_NEAR(turned["heading"], 90, 1e-9);
    EXPECT_NEAR(turned["pitch"], 20, 1e-9);
    EXPECT_NEAR(turned["roll"], 10, 1e-9);
    EXPECT_NEAR(turned["depth"], 4, 1e-12);
}

}  // namespace
}  // namespace insonify::viewer
