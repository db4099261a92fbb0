extern "C" int insonify_something_else() { return 0; }
