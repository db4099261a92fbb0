// An EGL vendor's library that renders nothing: it leaves a file where it is loaded, which it is when somebody asks
// EGL.
#include <cstdlib>
#include <fstream>

__attribute__((constructor)) static void leaveMark() {
    if (const char* file = std::getenv("INSONIFY_EGL_WITNESS")) std::ofstream(file) << "asked";
}
