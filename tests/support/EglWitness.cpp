// An EGL vendor's library that renders nothing. When it is loaded, because a program uses EGL, it writes a file.
#include <cstdlib>
#include <fstream>

__attribute__((constructor)) static void leaveMark() {
    if (const char* file = std::getenv("INSONIFY_EGL_WITNESS")) std::ofstream(file) << "asked";
}
