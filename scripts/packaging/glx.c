/* Replaces libGLX.so.0 in wheels: OpenCV uses it for the OpenGL context of a window, and there are no windows. The
 *  real library would add a second libGLdispatch to the system's, and the libraries of X11. */
void *glXGetCurrentContext(void) { return 0; }
void *glXGetCurrentDisplay(void) { return 0; }
void *glXGetProcAddressARB(const unsigned char *name) { return (void)name, (void *)0; }
