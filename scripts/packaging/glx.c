/* Stands in for libGLX.so.0 in wheels: OpenCV asks it for the OpenGL context of a window, and there are no windows. The
 * real one would bring a second libGLdispatch beside the system's, and the libraries of X11. */
void *glXGetCurrentContext(void) { return 0; }
void *glXGetCurrentDisplay(void) { return 0; }
void *glXGetProcAddressARB(const unsigned char *name) { return (void)name, (void *)0; }
