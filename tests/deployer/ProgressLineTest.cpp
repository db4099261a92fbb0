#include <gmock/gmock.h>

#include "tests/deployer/Wall.hpp"
#include "tests/support/Paths.hpp"

using namespace insonify::deployer;
using testing::AllOf;
using testing::HasSubstr;
using testing::Not;

/** In realtime, so that it takes a second on any machine. */
TEST(ProgressLineTest, ARunShowsTotalAndTimeLeftOnATerminalOnly) {
    const WallFolder folder(replaced(wall_deployment, "schedule: lockstep", "schedule: realtime"));
    const std::string program = R"(
import pty, sys
with open('seen.txt', 'wb') as seen:
    def read(descriptor):
        import os
        data = os.read(descriptor, 1024)
        seen.write(data)
        return data
    sys.exit(pty.spawn([')" + insonify::test::program("insonify") +
                                R"(', 'run', 'wall.yml', '--duration', '1', '--out', 'out'], read) >> 8))";
    EXPECT_THAT(python(folder, program), succeeds());
    EXPECT_THAT(readFile(folder / "seen.txt"), AllOf(HasSubstr(" of 1.0 s simulated"), HasSubstr(" % done, 1 s left")));
    EXPECT_THAT(folder.run({"--pings", "2"}).err, Not(HasSubstr("done")));
}

TEST(ProgressLineTest, AStudyShowsItsFinishedCasesOnATerminal) {
    const TestFolder folder;
    const std::string program = R"(
import os, pty
seen = b''
def read(descriptor):
    global seen
    data = os.read(descriptor, 1024)
    seen += data
    return data
pty.spawn([')" + insonify::test::program("insonify") +
                                R"(', 'study', 'stability', '--only', 'Cone', '--out', '.'], read)
print(b'cases, 1 of ' in seen, b' so far, ' in seen, b' left' in seen))";
    EXPECT_TRUE(python(folder, program).out.ends_with("True True True\n"));
}
