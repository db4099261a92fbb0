#include "components/deployer/CommandLine.hpp"

int main(int argc, char** argv) { return insonify::deployer::runCommandLine(argc, argv); }
