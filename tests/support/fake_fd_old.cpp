// A library with the right name but only one of the functions.
extern "C" int dhdErrorGetLast() { return 0; }
