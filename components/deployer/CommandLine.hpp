#pragma once

namespace insonify::deployer {

/** The `insonify` command. Results go to stdout, diagnostics to stderr; nothing is thrown.
 *  Exit code: 0 done; 1 failed while running; 2 wrong usage, file or configuration. */
int runCommandLine(int argc, char** argv);

}  // namespace insonify::deployer
