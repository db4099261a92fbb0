#pragma once
// A headless Chromium, driven by browse.py.
#include <fcntl.h>
#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <cstdio>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "tests/support/Paths.hpp"
#include "tests/support/Waiting.hpp"

namespace insonify::viewer {

inline const char* const chromium = "/usr/bin/chromium";

/** Returns a python with websockets: that of scripts/setup, or Debian's; empty if there is none. */
inline std::string pythonWithWebsockets() {
    for (const std::string& candidate : {test::sourceFile("build/venv/bin/python3"), std::string("/usr/bin/python3")})
        if (std::filesystem::exists(candidate) &&
            std::system((candidate + " -c 'import websockets' 2> /dev/null").c_str()) == 0)
            return candidate;
    return "";
}

class Browser {
public:
    /** @param first a script that runs before those of the page. */
    explicit Browser(const std::string& url, const std::string& first = "") {
        int to[2], from[2];
        if (pipe2(to, O_CLOEXEC) != 0 || pipe2(from, O_CLOEXEC) != 0) throw std::runtime_error("no pipe");
        const std::string python = pythonWithWebsockets(), script = test::sourceFile("tests/viewer/browse.py");
        pid_ = fork();
        if (pid_ == 0) {
            dup2(to[0], STDIN_FILENO);
            dup2(from[1], STDOUT_FILENO);
            execl(python.c_str(), python.c_str(), script.c_str(), chromium, url.c_str(), first.c_str(), nullptr);
            _exit(127);
        }
        close(to[0]);
        close(from[1]);
        asks_ = fdopen(to[1], "w");
        answers_ = fdopen(from[0], "r");
    }
    ~Browser() {
        fclose(asks_);
        waitpid(pid_, nullptr, 0);
        fclose(answers_);
    }
    Browser(const Browser&) = delete;
    Browser& operator=(const Browser&) = delete;

    /** Returns the value of an expression; a test failure if it throws. */
    nlohmann::json value(const std::string& expression) { return ask({{"eval", expression}}); }
    /** Waits until the expression is true. */
    bool becomes(const std::string& expression) {
        return ask({{"until", expression}, {"seconds", test::patience.count()}}) == true;
    }
    /** Presses the keys of a text, in the focused element. */
    void type(const std::string& text) { ask({{"type", text}}); }
    /** Presses a key by its name: "Tab", "Shift+Tab", "ArrowLeft". */
    void press(const std::string& key, int times = 1) { ask({{"press", std::vector<std::string>(times, key)}}); }
    /** Scrolls an element into view and clicks its middle; a test failure if another element covers it. */
    void click(const std::string& element) { ask({{"click", element}}); }
    /** Sends a touch event of two fingers: "touchStart", "touchMove"; without places, "touchEnd". */
    void touch(const std::string& kind, const std::vector<std::array<double, 2>>& places) {
        nlohmann::json points = nlohmann::json::array();
        for (const auto& [x, y] : places) points.push_back({{"x", x}, {"y", y}, {"id", points.size()}});
        ask({{"touch", {{"type", kind}, {"touchPoints", points}}}});
    }
    void saveFilesIn(const std::string& folder) { ask({{"downloads", folder}}); }
    /** Sends a mouse event, as in Input.dispatchMouseEvent, in pixels from the upper left corner of the page. */
    void mouse(const std::string& kind, double x, double y, nlohmann::json more = nlohmann::json::object()) {
        more.update({{"type", kind}, {"x", x}, {"y", y}});
        ask({{"mouse", more}});
    }
    /** Moves the mouse there, in pixels from the upper left corner of the page. */
    void point(double x, double y) { mouse("mouseMoved", x, y); }
    void click(double x, double y) {
        mouse("mousePressed", x, y, {{"button", "left"}, {"clickCount", 1}});
        mouse("mouseReleased", x, y, {{"button", "left"}, {"clickCount", 1}});
    }
    void drag(double x, double y, double dx, double dy) {
        mouse("mousePressed", x, y, {{"button", "left"}, {"clickCount", 1}});
        mouse("mouseMoved", x + dx, y + dy, {{"button", "left"}, {"buttons", 1}});
        mouse("mouseReleased", x + dx, y + dy, {{"button", "left"}, {"clickCount", 1}});
    }
    /** Turns the wheel by `by` pixels, positive towards the user. */
    void wheel(double x, double y, double by) { mouse("mouseWheel", x, y, {{"deltaX", 0}, {"deltaY", by}}); }
    /** @param scale pixels of the screen per pixel of CSS. */
    void size(int width, int height, double scale = 1) { ask({{"size", {width, height, scale}}}); }
    void screenshot(const std::string& file) { ask({{"screenshot", file}}); }

private:
    nlohmann::json ask(const nlohmann::json& question) {
        fprintf(asks_, "%s\n", question.dump().c_str());
        fflush(asks_);
        char* line = nullptr;
        size_t size = 0;
        const ssize_t got = getline(&line, &size, answers_);
        const auto answer = got > 0 ? nlohmann::json::parse(line, nullptr, false) : nlohmann::json();
        free(line);
        if (answer.is_object() && answer.contains("value")) return answer["value"];
        ADD_FAILURE() << question << ": " << answer;
        return nullptr;
    }

    pid_t pid_ = -1;
    FILE *asks_ = nullptr, *answers_ = nullptr;
};

}  // namespace insonify::viewer
