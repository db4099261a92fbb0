// The page as an operator's display: what it shows when pings stop, who can use it, what it keeps.
#include <gmock/gmock.h>

#include <filesystem>
#include <fstream>
#include <sstream>

#include "tests/support/Folder.hpp"
#include "tests/viewer/Client.hpp"
#include "tests/viewer/Page.hpp"

namespace insonify::viewer {
namespace {

using testing::AllOf;
using testing::HasSubstr;
using testing::MatchesRegex;

struct DisplayTest : PageTest {
    /** Lets only some messages through, by an expression of `message`. */
    void passOnly(const std::string& which) {
        keepConnection();
        value(
            "(() => { const {link} = insonify; self.heard = self.heard || link.heard; link.heard = (message) => { if "
            "(" +
            which + ") self.heard(message); }; })()");
    }
    bool isOn(const std::string& button) {
        return value(byId(button) + ".getAttribute('aria-pressed') === 'true' && " + byId(button) +
                     ".classList.contains('on')");
    }
    std::string getStyle(const std::string& selector, const std::string& style) {
        return value("getComputedStyle(document.querySelector('" + selector + "'))['" + style + "']");
    }
    void reload() {
        value("self.is_old = true, location.reload()");
        ASSERT_TRUE(becomes("!self.is_old && self.insonify && insonify.shown() > 3 && insonify.status()"));
    }
};

const char* const every_message = "true";

TEST_F(DisplayTest, APageWithoutPingsDoesNotLookLive) {
    EXPECT_EQ(value(byId("silence") + ".hidden"), true);
    EXPECT_TRUE(becomes("Number(" + byId("rate") + ".textContent) > 1"));
    EXPECT_EQ(getStyle("#fan", "filter"), "none");
    passOnly("message.kind !== 1");
    ASSERT_TRUE(becomes("!" + byId("silence") + ".hidden"));
    EXPECT_THAT(text("silence"), MatchesRegex("no ping for [2-9] s"));
    EXPECT_THAT(getStyle("#fan", "filter"), HasSubstr("brightness(0.4)")) << "the picture is dim";
    EXPECT_THAT(getStyle("#view", "filter"), HasSubstr("brightness(0.4)"));
    EXPECT_EQ(text("rate"), "0.0");
    EXPECT_EQ(text("latency"), "-");
    EXPECT_EQ(getStyle("#time", "color"), getStyle("header i", "color")) << "figures are gray";
    EXPECT_EQ(value("document.querySelectorAll('#tasks .Running').length"), 3) << "statuses still come";
    EXPECT_EQ(text("alarm"), "no ping") << "for screen readers, once";
    EXPECT_THAT(value("document.title").get<std::string>(), HasSubstr("no pings"));
    EXPECT_TRUE(becomes("/no ping for [4-9] s/.test(" + byId("silence") + ".textContent)")) << "it counts";

    passOnly(every_message);
    ASSERT_TRUE(becomes(byId("silence") + ".hidden"));
    EXPECT_EQ(getStyle("#fan", "filter"), "none");
    EXPECT_TRUE(becomes("Number(" + byId("rate") + ".textContent) > 1"));
    EXPECT_EQ(value("document.title"), "Insonify");
    EXPECT_EQ(text("alarm"), "");
}

TEST_F(DisplayTest, APageWithoutStatusesKnowsNoStates) {
    value("[...document.querySelectorAll('#controls button')].find((one) => one.textContent === '● source').click()");
    ASSERT_TRUE(becomes("!" + byId("recorded") + ".hidden"));
    passOnly("false");
    ASSERT_TRUE(becomes("document.querySelectorAll('#tasks .Running').length === 0"));
    EXPECT_EQ(value("[...document.querySelectorAll('#tasks tbody tr')].map((row) => row.cells[1].textContent)"),
              json({"unknown", "unknown", "unknown"}));
    EXPECT_EQ(value("document.querySelectorAll('#graph .lamp.Running').length"), 0);
    EXPECT_THAT(value("[...document.querySelectorAll('#graph .small')].map((one) => one.textContent).join()"),
                "unknown,unknown,unknown");
    ASSERT_TRUE(becomes("!" + byId("silence") + ".hidden"));
    EXPECT_EQ(getStyle("#recorded", "animationName"), "none") << "it does not say that it records";
    passOnly(every_message);
    EXPECT_TRUE(becomes("document.querySelectorAll('#tasks .Running').length === 3"));
}

TEST_F(DisplayTest, ALostConnectionIsShownOverThePicture) {
    running.reset();
    ASSERT_TRUE(becomes("/no connection for/.test(" + byId("silence") + ".textContent)"));
    EXPECT_THAT(text("silence"), MatchesRegex("no connection for [0-9]+ s, no ping for [0-9]+ s"));
    EXPECT_THAT(getStyle("#fan", "filter"), HasSubstr("brightness"));
    EXPECT_EQ(text("rate"), "0.0");
    EXPECT_TRUE(becomes("document.querySelectorAll('#tasks .Running').length === 0"));
}

TEST_F(DisplayTest, APausedDeploymentIsNoAlarm) {
    click("pause");
    ASSERT_TRUE(becomes("/^paused, no ping for/.test(" + byId("silence") + ".textContent)"));
    EXPECT_EQ(getStyle("#fan", "filter"), "none") << "it is looked at step by step";
    EXPECT_EQ(text("rate"), "0.0");
    EXPECT_EQ(text("alarm"), "");
    EXPECT_EQ(value("document.title"), "Insonify");
}

TEST_F(DisplayTest, AnAlarmIsHeardIfItIsWanted) {
    value(R"((() => {
        self.tones = 0;
        const make = AudioContext.prototype.createOscillator;
        AudioContext.prototype.createOscillator = function() { ++self.tones; return make.call(this); };
    })())");
    passOnly("message.kind !== 1");
    ASSERT_TRUE(becomes("!" + byId("silence") + ".hidden"));
    nextFrame();
    EXPECT_EQ(value("self.tones"), 0) << "not unless it is chosen";
    set("alarm", "heard");
    EXPECT_TRUE(becomes("self.tones > 2"));
    passOnly(every_message);
    ASSERT_TRUE(becomes(byId("silence") + ".hidden"));
    const int heard = value("self.tones");
    EXPECT_FALSE(
        value("new Promise((done) => setTimeout(() => done(self.tones > " + std::to_string(heard) + "), 1500))"));
}

TEST_F(DisplayTest, PingsAreMissedAfterThreeOfTheirIntervals) {
    // Sonars of any interval from 0.02 to 15 s, with jitter: silent neither while pings come, nor never.
    const json wrong = value(R"(import('./instruments.js').then(({Watch}) => {
        let seed = 7;
        const random = () => (seed = (seed * 48271) % 2147483647) / 2147483647, wrong = [];
        for (let draw = 0; draw < 200; ++draw) {
            const watch = new Watch(), interval = 0.02 * 750 ** random();
            let now = 100 * random();
            for (let i = 0; i < 30; ++i) {
                watch.ping(now);
                watch.status(now);
                const next = now + interval * (0.6 + 0.8 * random()), seen = watch.look(next);
                if (i > 0 && seen.is_silent) wrong.push(['silent too early', interval, i]);
                if (i > 5 && !(seen.rate > 0.4 / interval && seen.rate < 2.5 / interval)) wrong.push(['rate', interval, seen.rate]);
                now = next;
            }
            const late = watch.look(now + Math.max(2, 5 * interval));
            if (!late.is_silent || late.rate !== 0 || !/^no ping for \d+ s$/.test(late.text)) wrong.push(['not silent', interval]);
            watch.connection(false, now);
            watch.connection(false, now + 5);
            const lost = watch.look(now + 10);
            if (!lost.text.startsWith('no connection for 10 s') && !lost.text.startsWith('no connection for 9 s')) wrong.push([lost.text]);
            if (lost.is_known) wrong.push('known');
        }
        // A silence is no interval; a slower sonar is, from its third ping on; a new connection begins with an old ping.
        for (const interval of [0.1, 1, 4]) {
            const watch = new Watch();
            let now = 0;
            for (let i = 0; i < 10; ++i) watch.ping(now += interval);
            watch.ping(now += 300);
            watch.ping(now += interval);
            if (!watch.look(now + Math.max(2.1, 4 * interval)).is_silent) wrong.push(['after a silence', interval]);
            for (let i = 0; i < 4; ++i) watch.ping(now += 5 * interval);
            if (watch.look(now + 6 * interval).is_silent) wrong.push(['slower', interval]);
            watch.connection(false, now);
            watch.connection(true, now += 50);
            watch.ping(now);
            watch.status(now += 0.2, 70);
            if (watch.look(now).text !== 'no ping for 70 s') wrong.push(['old', watch.look(now)]);
            watch.ping(now += 0.1);
            watch.status(now, 0.1);
            if (watch.look(now).is_silent) wrong.push(['live again', interval]);
        }
        const never = new Watch().look(1000);
        if (never.is_silent || never.rate !== 0 || never.age !== null) wrong.push('a page that has had no ping');
        return wrong;
    }))");
    EXPECT_EQ(wrong, json::array());
}

/** Returns axe-core of npm or of PyPI; empty if there is none. */
std::string axe() {
    std::vector<std::filesystem::path> files{test::sourceFile("build/node_modules/axe-core/axe.min.js")};
    const std::filesystem::path packages = test::sourceFile("build/venv/lib");
    if (std::filesystem::exists(packages))
        for (const auto& python : std::filesystem::directory_iterator(packages))
            files.push_back(python.path() / "site-packages/axe_core_python/axe.min.js");
    for (const auto& file : files)
        if (std::filesystem::exists(file)) {
            std::stringstream text;
            text << std::ifstream(file).rdbuf();
            return text.str();
        }
    return "";
}

TEST_F(DisplayTest, AxeFindsNoViolation) {
    const std::string script = axe();
    if (script.empty()) GTEST_SKIP() << "NOT TESTED: no axe-core in build/venv or build/node_modules";
    value(script + "; 1");
    const auto violations = [&] {
        return value(R"(axe.run(document, {resultTypes: ['violations']}).then(({violations}) =>
            violations.map(({id, impact, nodes}) => [id, impact, nodes.length, nodes[0].html.slice(0, 120), nodes[0].failureSummary.slice(0, 300)])))");
    };
    EXPECT_EQ(value("axe.run(document, {runOnly: ['label']}).then(({passes}) => passes.length)"), 1) << "it runs";
    click("target");
    clickAt(6, 5);
    for (const char* task : {"source", "world", "viewer"}) {
        choose("task", task);
        EXPECT_EQ(violations(), json::array()) << task;
    }
    for (const char* theme : {"light", "dark"}) {
        set("theme", theme);
        for (const int width : {390, 1280}) {
            browser->size(width, 800);
            nextFrame();
            EXPECT_EQ(violations(), json::array()) << theme << " " << width;
        }
        browser->click(byId("settings"));
        EXPECT_EQ(violations(), json::array()) << "the dialog, " << theme;
        click("close");
    }
    click("freeze");
    passOnly("message.kind !== 1");
    ASSERT_TRUE(becomes("!" + byId("silence") + ".hidden"));
    EXPECT_EQ(violations(), json::array()) << "without pings";
    value(byId("map") + ".removeAttribute('aria-label'), " + byId("map") + ".removeAttribute('title')");
    EXPECT_EQ(violations()[0][0], "select-name") << "it would find one";
    EXPECT_EQ(value("[...document.querySelectorAll('canvas')].filter((one) => !one.ariaHidden && (!one.role || "
                    "!one.ariaLabel)).length"),
              0);
}

TEST_F(DisplayTest, KeysMeasureZoomAndTurn) {
    click("freeze");
    value(byId("fan") + ".focus()");
    browser->press("m");
    EXPECT_TRUE(isOn("measure"));
    browser->press("ArrowUp", 3);
    browser->press("Enter");
    browser->press("ArrowUp", 5);
    browser->press("ArrowLeft", 5);
    browser->press("Enter");
    nextFrame();
    EXPECT_THAT(text("measured"), HasSubstr(" m apart, towards "));
    EXPECT_NEAR(value("insonify.fan.measured().bearing").get<double>(), types::radians(45), 0.02);
    EXPECT_THAT(text("spoken"), HasSubstr(" m apart")) << "also for screen readers";
    browser->press("Shift+Enter");
    EXPECT_TRUE(becomes("/^at /.test(" + byId("explained") + ".textContent)"));
    browser->press("Escape");
    EXPECT_FALSE(isOn("measure"));
    EXPECT_EQ(value("insonify.fan.marks.length"), 0);

    browser->press("+", 3);
    EXPECT_NEAR(value("insonify.fan.zoom"), 1.25 * 1.25 * 1.25, 1e-9);
    browser->press("ArrowRight", 200);
    EXPECT_LT(value("insonify.fan.shift[0]").get<double>(), 0) << "the cursor takes the picture along";
    browser->press("-");
    browser->press("0");
    EXPECT_EQ(value("insonify.fan.zoom"), 1);

    if (!hasThree()) return;
    ASSERT_TRUE(becomes("!!insonify.world()"));
    value(byId("view") + ".focus()");
    const json before = value("[insonify.world().azimuth, insonify.world().elevation, insonify.world().distance]");
    browser->press("ArrowLeft", 2);
    browser->press("ArrowUp");
    browser->press("+");
    EXPECT_GT(value("insonify.world().azimuth"), before[0]);
    EXPECT_LT(value("insonify.world().elevation"), before[1]);
    EXPECT_LT(value("insonify.world().distance"), before[2]);
    EXPECT_EQ(value("insonify.fan.zoom"), 1) << "the scene has the focus";
}

TEST_F(DisplayTest, KeysAreListedAndWorkUnlessAFieldHasTheFocus) {
    value("document.activeElement.blur()");
    browser->press("?");
    ASSERT_TRUE(value(byId("dialog") + ".open"));
    EXPECT_THAT(text("dialog"), AllOf(HasSubstr("freeze the picture"), HasSubstr("Shift+Enter"), HasSubstr("m, m/s")));
    const json listed = value("import('./settings.js').then(({shortcuts}) => shortcuts.map(([keys]) => keys))");
    EXPECT_GT(listed.size(), 18u);
    browser->press("m");
    EXPECT_FALSE(isOn("measure")) << "the dialog is open";
    browser->press("Escape");
    EXPECT_FALSE(value(byId("dialog") + ".open"));

    browser->press("Space");
    EXPECT_TRUE(isOn("freeze"));
    browser->press(".");
    EXPECT_FALSE(isOn("freeze"));
    browser->press("f");
    EXPECT_EQ(text("shape"), "polar");
    browser->press("f");
    for (const auto& [key, id] : {std::pair("t", "target"), {"l", "line"}, {"b", "profile"}}) {
        browser->press(key);
        EXPECT_TRUE(isOn(id)) << key;
        browser->press(key);
        EXPECT_FALSE(isOn(id)) << key;
    }
    browser->press("c");
    EXPECT_EQ(value(byId("map") + ".value"), "copper");
    for (const auto& [key, id] : {std::pair("g", "rings"), {"a", "auto"}}) {
        browser->press(key);
        EXPECT_EQ(value(byId(id) + ".checked"), false) << key;
    }
    browser->press("n");
    EXPECT_EQ(value(byId("north") + ".checked"), true);
    browser->press("r");
    EXPECT_TRUE(becomes("insonify.status().tasks[0].properties.record === true"));

    choose("task", "source");
    browser->click(getField("level"));
    browser->press("Control+a");
    browser->type("2g");
    EXPECT_EQ(value(getField("level") + ".value"), "2g");
    EXPECT_EQ(value(byId("rings") + ".checked"), false) << "a field takes its keys";
    browser->press("Escape");
    set("keys", "off");
    browser->press("g");
    EXPECT_EQ(value(byId("rings") + ".checked"), false) << "keys can be turned off";
}

TEST_F(DisplayTest, SettingsAreRememberedAndNonsenseIsNot) {
    set("units", "imperial");
    set("bearings", "starboard");
    set("theme", "light");
    choose("map", "gray");
    slide("low", -30);
    browser->click(byId("rings"));
    const auto at = windowAt(6.75, 0);
    browser->wheel(at[0], at[1], -800);
    ASSERT_TRUE(becomes("insonify.fan.zoom > 3"));
    const double zoom = value("insonify.fan.zoom");
    choose("task", "world");
    reload();
    EXPECT_EQ(text("reach"), "49.2 ft, 32 x 100, 150 mm");
    EXPECT_THAT(readAt(6.75, -8), HasSubstr("+"));
    EXPECT_EQ(value("document.documentElement.dataset.theme"), "light");
    EXPECT_EQ(value(byId("map") + ".value"), "gray");
    EXPECT_EQ(value(byId("low") + ".value"), "-30");
    EXPECT_EQ(value(byId("rings") + ".checked"), false);
    EXPECT_NEAR(value("insonify.fan.zoom"), zoom, 1e-6);
    EXPECT_NEAR(windowAt(6.75, 0)[1], at[1], 3) << "and moved alike";
    EXPECT_EQ(value(byId("task") + ".value"), "world");

    for (
        const char* nonsense :
        {"{", "[]", "7", "null", R"({"units":"parsecs","low":"x","targets":{},"zoom":null})",
         R"({"targets":[{"name":"x","source":"s","time_us":1,"range":5,"bearing":0,"position":"here","heading":null,"depth":null}]})",
         R"({"map":"plaid","targets":[null,{"range":"a"}],"zoom":1e9,"shift_x":7})"}) {
        value("localStorage.setItem('insonify.view', '" + std::string(nonsense) +
              "'), Storage.prototype.setItem = () => {}, 1");
        reload();
        EXPECT_EQ(text("reach"), "15.0 m, 32 x 100, 150 mm") << nonsense;
        EXPECT_EQ(value(byId("map") + ".value"), "amber") << nonsense;
        EXPECT_LE(value("insonify.fan.zoom"), 50) << nonsense;
        EXPECT_EQ(value(byId("marked") + ".hidden"), true) << nonsense;
    }
}

TEST_F(DisplayTest, AnErrorInATableCanBeSelected) {
    EXPECT_THROW(running->deployment().call("source.setLevel", {"66"}), std::exception);
    ASSERT_TRUE(becomes("document.querySelectorAll('#plan .dim').length > 1"));
    value(R"((() => {
        self.kept = [...document.querySelectorAll('#tasks td, #plan dd, #graph rect, #graph text, #attitude span')];
        getSelection().selectAllChildren(document.querySelector('#plan dd'));
    })())");
    for (int i = 0; i < 3; ++i) {
        const std::string sent = value("insonify.status().sent_s").dump();
        ASSERT_TRUE(becomes("insonify.status().sent_s > " + sent));
    }
    EXPECT_EQ(value("getSelection().toString()"), "not asked for");
    EXPECT_EQ(value("self.kept.filter((one) => !one.isConnected).length"), 0) << "cells are changed in place";
    EXPECT_GT(value("self.kept.length"), 20);
}

TEST_F(DisplayTest, PropertiesThatNoRunningTaskTakesAreReadOnly) {
    choose("task", "source");
    EXPECT_EQ(value(getField("fixed") + ".readOnly"), true);
    EXPECT_EQ(value(getField("level") + ".readOnly"), false);
    EXPECT_THAT(value(getField("fixed") + ".closest('tr').title").get<std::string>(), HasSubstr("stopped"));
    browser->click(getField("fixed"));
    browser->type("5");
    EXPECT_EQ(value(getField("fixed") + ".value"), "4");
    choose("task", "viewer");
    EXPECT_EQ(value("[...document.querySelectorAll('#properties input, #properties select')].filter((one) => "
                    "!one.readOnly && !one.disabled).length"),
              0)
        << "the viewer does not control itself";
}

TEST_F(DisplayTest, ARefusedFieldMovesNoPicture) {
    value(R"(import('./fields.js').then(({First}) => {
        const first = new First({call: async () => ({refused: 'level: is 1000; may be 0 to 100, and so on, and so on, and so on, and so on'})}, document.getElementById('first'));
        first.setInterfaces({control: true, tasks: [{name: 'source', properties: [{name: 'range', type: 'double', unit: 'm', doc: ''}]}]});
        first.update({tasks: [], connections: []}, 'source.ping');
    }))");
    const std::string places =
        "JSON.stringify([...document.querySelectorAll('.picture')].map((one) => one.getBoundingClientRect()))";
    for (const int width : {390, 1280}) {
        browser->size(width, 800);
        nextFrame();
        const json before = value(places);
        enter("document.querySelector('#first input')", "1000");
        EXPECT_TRUE(becomes("document.querySelector('#first .refused').getBoundingClientRect().height > 10"));
        EXPECT_EQ(value(places), before) << width;
        browser->press("Escape");
    }
}

TEST_F(DisplayTest, ButtonsOfAReplaySayWhichStateHolds) {
    const json seen = value(R"(import('./instruments.js').then(async ({Controls}) => {
        const asked = [], place = document.createElement('span');
        const controls = new Controls({call: async (...all) => { asked.push(all.join(' ')); return {}; }}, place, document.createElement('span'));
        controls.setInterfaces({control: true, tasks: [{name: 'replay', properties: [], operations: ['pause void(bool)', 'step void()']}]});
        const look = () => [...place.querySelectorAll('button')].map((one) => [one.textContent, one.className, one.disabled]), seen = [];
        for (const paused of [false, true]) {
            controls.update({lockstep: false, paused: false, sent_s: 1, tasks: [{name: 'replay', state: 'Running', properties: {}, playback: {at_s: 1, length_s: 2, paused}}]});
            seen.push(look(), controls.is_paused);
            place.querySelector('button').click();
        }
        place.querySelectorAll('button')[1].click();
        return [...seen, asked];
    }))");
    EXPECT_EQ(seen, json::parse(R"([[["pause replay", "", false], ["step", "", true]], false,
                                    [["go on replay", "on", false], ["step", "", false]], true,
                                    ["replay.pause true", "replay.pause false", "replay.step"]])"));
}

}  // namespace
}  // namespace insonify::viewer
