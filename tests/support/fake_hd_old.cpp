// A library with the right name but only one of the functions.
extern "C" unsigned hdInitDevice(const char* name) { return name == nullptr ? 0 : 1; }
