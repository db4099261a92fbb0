// Values that are made ahead, where a process forks or ends meanwhile.
#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <thread>

#include "components/sonar/base/MadeAhead.hpp"

namespace insonify::sonar {
namespace {

using std::chrono::milliseconds;

/** Returns whether all values are made within 10 s. */
bool isMade(const MadeAhead& ahead) {
    for (int i = 0; i < 10'000 && !ahead.isDone(); ++i) std::this_thread::sleep_for(milliseconds(1));
    return ahead.isDone();
}

MadeAhead::Items oneNumber(int64_t key) {
    return {{{key}, [](const std::atomic<bool>&) { return std::make_shared<const int>(3); }}};
}

TEST(MadeAheadTest, AForkedChildEndsItWithoutWaitingForAThread) {
    auto ahead = std::make_unique<MadeAhead>("numbers");
    ahead->take(oneNumber(1));
    ASSERT_TRUE(isMade(*ahead));
    const pid_t child = fork();
    if (child == 0) {
        alarm(10);
        ahead->take(oneNumber(2));
        ahead.reset();
        _exit(7);
    }
    int status = 0;
    ASSERT_EQ(waitpid(child, &status, 0), child);
    EXPECT_TRUE(WIFEXITED(status) && WEXITSTATUS(status) == 7) << status;
    ahead->take(oneNumber(3));
    EXPECT_TRUE(isMade(*ahead)) << "the parent goes on";
}

TEST(MadeAheadDeathTest, AProcessThatEndsGivesUpAValueThatIsBeingMade) {
    GTEST_FLAG_SET(death_test_style, "threadsafe");
    EXPECT_EXIT(
        {
            auto* const ahead = new MadeAhead("numbers");
            std::atomic<bool> began{false};
            ahead->take({{{1}, [&](const std::atomic<bool>& quits) -> std::shared_ptr<const void> {
                              began = true;
                              while (!quits) std::this_thread::sleep_for(milliseconds(1));
                              std::fputs("given up\n", stderr);
                              return nullptr;
                          }}});
            while (!began) std::this_thread::sleep_for(milliseconds(1));
            std::exit(0);
        },
        testing::ExitedWithCode(0), "given up");
}

}  // namespace
}  // namespace insonify::sonar
