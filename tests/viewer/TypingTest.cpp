// The fields of the page, used by keys as a person does.
#include "tests/viewer/Client.hpp"
#include "tests/viewer/Form.hpp"
#include "tests/viewer/Page.hpp"

namespace insonify::viewer {
namespace {

using testing::HasSubstr;

const char* const red = "rgb(228, 87, 76)";

class TypingTest : public PageTest {
protected:
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
    /** What the task holds, in JSON; null: nothing. */
    json held(const std::string& property) {
        for (const types::TaskStatus& task : running->deployment().status().tasks)
            if (const auto found = task.record.properties.find(property);
                task.record.name == "form" && found != task.record.properties.end())
                return std::visit([](const auto& it) { return json(it); }, found->second);
        return nullptr;
    }
    bool holds(const std::string& property, const json& wanted) {
        return comesTrue([&] { return held(property) == wanted; });
    }
    /** Statuses that come from now on; each is shown by every field. */
    void nextStatuses(int count = 2) {
        for (int i = 0; i < count; ++i) {
            const std::string sent = value("insonify.status().sent_s").dump();
            ASSERT_TRUE(becomes("insonify.status().sent_s > " + sent));
        }
    }
    bool hasFocus(const std::string& field) { return value("document.activeElement === " + field); }

    /** All that can be set on the page now, but the choice of the task whose properties it shows. */
    const std::string fields =
        "[...document.querySelectorAll('input, select, textarea')].filter((one) => one.id !== 'task')";
};

TEST_F(TypingTest, ButtonsArePressedByKeys) {
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

TEST_F(TypingTest, WhatIsTypedReachesTheTask) {
    struct Case {
        const char *property, *typed;
        json held;
        const char* shown;
    };
    for (const Case& one : {Case{"range", "42.5", 42.5, "42.5"},
                            {"gain_db", "-1e1", -10.0, "-10"},
                            {"gain_db", "", nullptr, ""},
                            {"count", "17", 17, "17"},
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
        enter(fieldOf(one.property), one.typed);
        EXPECT_TRUE(holds(one.property, one.held))
            << held(one.property) << " " << value(refusalOf(fieldOf(one.property)));
        EXPECT_TRUE(becomes(fieldOf(one.property) + ".value === " + json(one.shown).dump()));
        EXPECT_EQ(value(refusalOf(fieldOf(one.property))), "");
        EXPECT_TRUE(hasFocus(fieldOf(one.property))) << "Enter leaves no field";
    }
    EXPECT_TRUE(becomes("Math.abs(insonify.fan.ping.top_db - 10 * Math.log10(42.5)) < 0.1")) << "the pings have it";

    choose("task", "form");
    browser->click(fieldOf("shape"));
    browser->type("square");
    browser->press("Enter");
    EXPECT_TRUE(holds("shape", "square"));
}

TEST_F(TypingTest, WhatIsTypedIsSetWhenTheFieldIsLeft) {
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
    EXPECT_TRUE(becomes(fieldOf("range") + ".value === '100'")) << "the table shows the same";
}

}  // namespace
}  // namespace insonify::viewer
