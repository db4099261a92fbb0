// The fields of the page, used by keys as a person does.
#include "tests/viewer/Client.hpp"
#include "tests/viewer/Form.hpp"
#include "tests/viewer/Page.hpp"

namespace insonify::viewer {
namespace {

using testing::HasSubstr;

const char* const red = "rgb(228, 87, 76)";

struct TypingTest : PageTest {
    void SetUp() override {
        PageTest::SetUp();
        if (IsSkipped() || HasFatalFailure()) return;
        openForm();
    }
    void openForm(std::vector<std::string> settings = {}, const std::string& query = "", uint16_t port = 0) {
        open("", port, additions(std::move(settings)), query);
        keepConnection();
        ASSERT_TRUE(becomes("document.getElementById('source').options.length === 2"));
        choose("source", "form.ping");
        ASSERT_TRUE(becomes("document.querySelectorAll('#first input').length === 3"));
        choose("task", "form");
    }
    static Running::Additions additions(std::vector<std::string> settings = {}) {
        return {std::move(settings), "  form: {type: test::FormTask, activity: {period: 0.01}}\n",
                "  - {from: form.ping, to: viewer.form, policy: {type: buffer, size: 8}}\n",
                [](framework::Registry& registry) { registry.add<FormTask>("test::FormTask", ""); }};
    }
    /** Returns the task's value in JSON; null if it has none. */
    json held(const std::string& property) {
        for (const types::TaskStatus& task : running->deployment().status().tasks)
            if (const auto found = task.record.properties.find(property);
                task.record.name == "form" && found != task.record.properties.end())
                return std::visit([](const auto& it) { return json(it); }, found->second);
        return nullptr;
    }
    bool holds(const std::string& property, const json& wanted) {
        return becomesTrue([&] { return held(property) == wanted; });
    }
    /** Waits for further statuses; every field shows each of them. */
    void nextStatuses(int count = 2) {
        for (int i = 0; i < count; ++i) {
            const std::string sent = value("insonify.status().sent_s").dump();
            ASSERT_TRUE(becomes("insonify.status().sent_s > " + sent));
        }
    }
    bool hasFocus(const std::string& field) { return value("document.activeElement === " + field); }

    bool isRefused(const std::string& field) {
        return value("!!" + field + ".parentElement.querySelector('.refused')?.textContent");
    }

    /** All fields of the page that can be set now, except the choice of the task whose properties are shown, and those
     *  that other tests use. */
    const std::string fields =
        "[...document.querySelectorAll('input:enabled, select:enabled, textarea')].filter((one) => !one.readOnly && "
        "one.id !== 'task' && !one.closest('dialog, .two, #history, #targets'))";
    void typeInto(const std::string& field);
    void toggle(const std::string& field);
    void chooseIn(const std::string& field);
    void slideIn(const std::string& field);
};

void TypingTest::typeInto(const std::string& field) {
    const json before = value(field + ".value");
    browser->click(field);
    EXPECT_TRUE(hasFocus(field));
    browser->press("Control+a");
    browser->type("aZ 1.5, {-}");
    EXPECT_EQ(value(field + ".value"), "aZ 1.5, {-}");
    browser->press("Backspace");
    browser->press("ArrowLeft", 3);
    browser->press("Delete");
    browser->type("_");
    EXPECT_EQ(value(field + ".value"), "aZ 1.5,_{-");
    browser->press("Home");
    browser->type("0");
    nextStatuses();
    EXPECT_EQ(value(field + ".value"), "0aZ 1.5,_{-") << "stays while it is being typed";
    EXPECT_TRUE(hasFocus(field));
    browser->press("Escape");
    EXPECT_EQ(value(field + ".value"), before) << "Escape takes back what was typed";
    EXPECT_TRUE(hasFocus(field));
    browser->press("Tab");
    EXPECT_FALSE(hasFocus(field));
    nextStatuses();
    EXPECT_EQ(value(field + ".value"), before);
    EXPECT_EQ(value(getRefusal(field)), "");
}

void TypingTest::toggle(const std::string& field) {
    const bool before = value(field + ".checked");
    const auto settles = [&](bool wanted, const char* how) {
        nextStatuses();
        const bool is_refused = isRefused(field);
        EXPECT_EQ(value(field + ".checked"), is_refused ? !wanted : wanted) << how;
        return !is_refused;
    };
    browser->click(field);
    if (!settles(!before, "by a click")) return;
    browser->press("Space");
    settles(before, "by Space");
}

void TypingTest::chooseIn(const std::string& field) {
    const int before = value(field + ".selectedIndex"), count = value(field + ".options.length");
    browser->click(field);
    browser->press("Escape");  // closes its list
    EXPECT_TRUE(hasFocus(field));
    if (count < 2) return;
    browser->press(before + 1 < count ? "ArrowDown" : "ArrowUp");
    nextStatuses();
    const int other = before + 1 < count ? before + 1 : before - 1;
    EXPECT_EQ(value(field + ".selectedIndex"), isRefused(field) ? before : other);
    EXPECT_TRUE(hasFocus(field));
    browser->press(before + 1 < count ? "ArrowUp" : "ArrowDown");
    nextStatuses();
    EXPECT_EQ(value(field + ".selectedIndex"), before);
}

void TypingTest::slideIn(const std::string& field) {
    browser->click(field);
    const std::string number = "Number(" + field + ".value)";
    const double before = value(number), step = value("Number(" + field + ".step)");
    browser->press("ArrowRight");
    nextStatuses();
    EXPECT_NEAR(value(number), before + step, 1e-9);
    browser->press("Home");
    nextStatuses();
    EXPECT_EQ(value(number), value("Number(" + field + ".min)"));
}

TEST_F(TypingTest, EveryFieldOfThePageTakesKeys) {
    for (const std::string task : {"source", "world", "viewer", "form"}) {
        choose("task", task);
        const json kinds = value(fields + ".map((one) => one.tagName === 'SELECT' ? 'select' : one.type)");
        ASSERT_GT(kinds.size(), 8u) << kinds;
        for (size_t i = 0; i < kinds.size(); ++i) {
            if (task != "form" && !value(fields + "[" + std::to_string(i) + "].closest('#properties') !== null"))
                continue;
            const std::string field = fields + "[" + std::to_string(i) + "]";
            SCOPED_TRACE(task + ": " + value(field + ".closest('tr, label, div, header').textContent").dump());
            if (kinds[i] == "text")
                typeInto(field);
            else if (kinds[i] == "checkbox")
                toggle(field);
            else if (kinds[i] == "select")
                chooseIn(field);
            else if (kinds[i] == "range")
                slideIn(field);
            else
                ADD_FAILURE() << "a kind of field that no test uses: " << kinds[i];
            EXPECT_EQ(value(fields + ".length"), kinds.size()) << "none has gone";
        }
    }
}

TEST_F(TypingTest, TabReachesEveryControlAndShowsTheFocus) {
    const std::string all =
        "[...document.querySelectorAll('button:enabled, input:enabled, select:enabled')].filter((one) => "
        "one.getBoundingClientRect().width)";
    const int count = value(all + ".length");
    ASSERT_GT(count, 25);
    const auto look = [&](int i) {
        const json seen =
            value("(() => { const one = " + all + "[" + std::to_string(i) + R"(], box = one.getBoundingClientRect();
            const style = getComputedStyle(one), at = document.elementFromPoint((box.left + box.right) / 2, (box.top + box.bottom) / 2);
            return {name: one.outerHTML.slice(0, 80), focus: document.activeElement === one, ring: style.outlineStyle !== 'none' && parseFloat(style.outlineWidth) >= 2,
                    seen: one.contains(at)}; })())");
        EXPECT_TRUE(seen["focus"] && seen["ring"] && seen["seen"]) << i << " of " << count << ": " << seen;
    };
    value("document.activeElement.blur()");
    browser->click("document.querySelector('h1')");
    const auto go = [&](const std::string& key) {  // parts that scroll have the focus in between
        do browser->press(key);
        while (!value("document.activeElement.matches('button, input, select, body')"));
    };
    for (int i = 0; i < count; ++i) {
        go("Tab");
        look(i);
    }
    for (int i = count - 2; i >= 0; --i) {
        go("Shift+Tab");
        look(i);
    }
}

TEST_F(TypingTest, KeysPressButtons) {
    browser->click("document.getElementById('map')");
    browser->press("Escape");
    browser->press("Shift+Tab");
    browser->press("Shift+Tab");
    browser->press("Shift+Tab");
    browser->press("Shift+Tab");
    ASSERT_TRUE(hasFocus(byId("freeze"))) << value("document.activeElement.outerHTML");
    browser->press("Space");
    EXPECT_EQ(value(byId("freeze") + ".className"), "on");
    browser->press("Enter");
    EXPECT_EQ(value(byId("freeze") + ".className"), "");
}

TEST_F(TypingTest, TypedValuesReachTheTask) {
    struct Case {
        const char *property, *typed;
        json held;
        const char* shown;
    };
    for (const Case& one : {Case{"range", "42.5", 42.5, "42.5"},
                            {"range", "20 m", 20.0, "20"},
                            {"range", "2000 cm", 20.0, "20"},
                            {"range", "12,5", 12.5, "12.5"},
                            {"range", " 60ft ", 18.288, "18.288"},
                            {"frequency_khz", "1.2 MHz", 1200.0, "1200"},
                            {"range", "42.5", 42.5, "42.5"},
                            {"gain_db", "-1e1", -10.0, "-10"},
                            {"gain_db", "", nullptr, ""},
                            {"count", "17", 17, "17"},
                            {"count", "", 3, "3"},
                            {"seed", "123456789012", 123456789012, "123456789012"},
                            {"title", "a: b #c \"d\" [", "a: b #c \"d\" [", "a: b #c \"d\" ["},
                            {"title", "007", "007", "007"},
                            {"title", "null", "null", "null"},
                            {"place", "[4, 5, -6.5]", "[4, 5, -6.5]", "[4, 5, -6.5]"},
                            {"weights", "[]", "[]", "[]"},
                            {"weights", "[1, 2e-3]", "[1, 0.002]", "[1, 0.002]"},
                            {"maybe", "flat", "flat", "flat"},
                            {"quality", "{budget_ms: 5}", "{\"budget_ms\": 5}", "{\"budget_ms\": 5}"},
                            {"spare", "{rows: 9}", "{\"rows\": 9}", "{\"rows\": 9}"},
                            {"spare", "", nullptr, ""}}) {
        SCOPED_TRACE(std::string(one.property) + ": " + one.typed);
        enter(getField(one.property), one.typed);
        EXPECT_TRUE(holds(one.property, one.held))
            << held(one.property) << " " << value(getRefusal(getField(one.property)));
        EXPECT_TRUE(becomes(getField(one.property) + ".value === " + json(one.shown).dump()));
        EXPECT_EQ(value(getRefusal(getField(one.property))), "");
        EXPECT_TRUE(hasFocus(getField(one.property))) << "Enter leaves no field";
    }
    EXPECT_TRUE(becomes("Math.abs(insonify.fan.ping.top_db - 10 * Math.log10(42.5)) < 0.1")) << "the pings have it";

    choose("task", "form");
    browser->click(getField("shape"));
    browser->type("square");
    browser->press("Enter");
    EXPECT_TRUE(holds("shape", "square"));
}

TEST_F(TypingTest, LeavingAFieldSetsTheTypedValue) {
    const std::string range = "document.querySelector('#first input')";
    browser->click(range);
    browser->press("Control+a");
    browser->type("10");
    browser->press("Tab");
    EXPECT_TRUE(holds("range", 10.0)) << "by Tab";
    EXPECT_TRUE(hasFocus("document.querySelectorAll('#first input')[1]"));
    browser->press("Shift+Tab");
    browser->press("ArrowRight");
    browser->type("0");
    clickAt(6.75, 0);
    EXPECT_TRUE(holds("range", 100.0)) << "by a click on the picture";
    EXPECT_TRUE(becomes(getField("range") + ".value === '100'")) << "the table shows the same";
}

TEST_F(TypingTest, ALateAnswerKeepsTheCaret) {
    browser->click(getField("title"));
    browser->press("Control+a");
    browser->type("slow");
    browser->press("Enter");
    browser->press("ArrowRight");
    ASSERT_TRUE(holds("title", "slow"));
    nextStatuses();
    browser->type("er");
    browser->press("Enter");
    EXPECT_TRUE(holds("title", "slower")) << held("title");
}

TEST_F(TypingTest, ARefusalIsRedAndTheFieldShowsThePresentValue) {
    struct Case {
        const char *property, *typed, *message;
    };
    for (const Case& one : {Case{"range", "1000", "range: is 1000 m; may be 1 to 100 m"},
                            {"range", "abc", "range: is abc; must be a finite number"},
                            {"range", "30 kg", "range: is 30 kg; write 30, or 30 m; also in km, cm, mm, ft, in, nmi"},
                            {"gain_db", "3 V", "gain_db: is 3 V; write 3, or 3 dB"},
                            {"count", "3 m", "count: is 3 m; it has no unit: write 3"},
                            {"frequency_khz", "1,200", "frequency_khz: is 1,200, which may be 1200 or 1.200"},
                            {"gain_db", "x", "gain_db: is x; must be a finite number"},
                            {"frequency_khz", "0", "frequency_khz: is 0 kHz; may be 1 to 3000 kHz"},
                            {"count", "1.5", "count: is "},
                            {"seed", "-1", "seed: is -1"},
                            {"maybe", "oval", "maybe: is oval; may be round, square, flat"},
                            {"place", "[1, 2]", "place"},
                            {"weights", "1, 2", "weights"},
                            {"quality", "{rows: 5, budget_ms: 5}", "is given in addition to budget_ms"},
                            {"quality", "{row: 5}", "row"},
                            {"spare", "{rows: [", "spare"}}) {
        const std::string field = getField(one.property), message = getRefusal(field);
        SCOPED_TRACE(std::string(one.property) + ": " + one.typed);
        const json before = value(field + ".value"), held_before = held(one.property);
        enter(field, one.typed);
        if (!becomes(message + " !== ''")) continue;
        EXPECT_THAT(value(message).get<std::string>(), HasSubstr(one.message));
        EXPECT_EQ(value("getComputedStyle(" + field + ".parentElement.querySelector('.refused')).color"), red);
        EXPECT_EQ(value(field + ".value"), before) << "as it was";
        EXPECT_EQ(held(one.property), held_before);
        EXPECT_TRUE(hasFocus(field));
        nextStatuses();
        EXPECT_NE(value(message), "") << "stays until the field is set again";
        browser->press("Escape");
        EXPECT_EQ(value(message), "");
    }
    // Typing after a refusal replaces the field's text.
    enter(getField("range"), "1000");
    ASSERT_TRUE(becomes(getRefusal(getField("range")) + " !== ''"));
    browser->type("20");
    browser->press("Enter");
    EXPECT_TRUE(holds("range", 20.0)) << held("range");
    EXPECT_TRUE(becomes(getRefusal(getField("range")) + " === ''"));

    browser->click(getField("enabled"));
    EXPECT_TRUE(becomes(getRefusal(getField("enabled")) + ".includes('not without it today')"));
    EXPECT_EQ(value(getField("enabled") + ".checked"), true) << "a checkbox as well";
    browser->click(getField("shape"));
    browser->type("flat");
    browser->press("Enter");
    EXPECT_TRUE(becomes(getRefusal(getField("shape")) + ".includes('flat is for later')"));
    EXPECT_EQ(value(getField("shape") + ".value"), "round") << "and a list";
}

TEST_F(TypingTest, AFieldWithoutFocusShowsValuesSetByOthers) {
    browser->click(getField("range"));
    running->deployment().call("form.setRange", {"33"});
    EXPECT_TRUE(becomes(getField("range") + ".value === '33'"));
    browser->press("Control+a");
    browser->type("44");
    running->deployment().call("form.setRange", {"55"});
    ASSERT_TRUE(becomes("document.querySelector('#first input').value === '55'"));
    EXPECT_EQ(value(getField("range") + ".value"), "44");
    browser->press("Control+a");
    browser->type("33");
    browser->press("Tab");
    EXPECT_TRUE(becomes(getField("range") + ".value === insonify.status().tasks.at(-1).properties.range.toString()"));
}

TEST_F(TypingTest, ABrokenConnectionKeepsTypedText) {
    const uint16_t port = quietPort();
    openForm({}, "", port);
    browser->click(getField("title"));
    browser->press("Control+a");
    browser->type("half");
    running.reset();
    ASSERT_TRUE(becomes("document.getElementById('link').textContent === 'no connection'"));
    running.emplace(port, additions());
    ASSERT_TRUE(becomes("document.getElementById('link').textContent === 'connected'"));
    nextStatuses();
    browser->type(" done");
    browser->press("Enter");
    EXPECT_TRUE(holds("title", "half done")) << held("title");
}

TEST_F(TypingTest, ToolbarAndHeaderHaveOneLineOfEachKindFrom1280Pixels) {
    for (const int width : {1280, 1920}) {
        browser->size(width, 800);
        nextFrame();
        EXPECT_EQ(value("[...document.querySelectorAll('#sonar nav')].map((one) => one.offsetHeight < 32)"),
                  json({true, true, true}))
            << width;
        EXPECT_EQ(value("[...document.querySelectorAll('header > :not(#timelines)')].map((one) => "
                        "one.getBoundingClientRect()).filter((box) => box.width > 0).every((box, i, all) => box.top < "
                        "all[0].bottom && box.right <= innerWidth)"),
                  true)
            << width;
    }
}

TEST_F(TypingTest, AViewerWithoutControlShowsButSetsNothing) {
    openForm({"viewer.control=false"});
    EXPECT_EQ(value("document.querySelectorAll('#properties input:enabled, #properties select:enabled, #first "
                    "input:enabled, .timeline input:enabled, #controls button').length"),
              0);
    browser->click(getField("range"));
    browser->type("9");
    browser->press("Enter");
    nextStatuses();
    EXPECT_EQ(value(getField("range") + ".value"), "1");
}

TEST_F(TypingTest, APageWithATokenIsUsedLikeAPageWithout) {
    openForm({"viewer.token='p&ss w#rd'"}, "?token=p%26ss%20w%23rd");
    enter(getField("range"), "12");
    EXPECT_TRUE(holds("range", 12.0));
}

}  // namespace
}  // namespace insonify::viewer
