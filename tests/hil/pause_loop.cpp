// Makes QEMU schedule the second emulated processor: with instruction counting QEMU runs the processors in turn, and before
// version 8.1 the first one keeps running as long as it has work, unless it executes PAUSE. The kernel waits without PAUSE
// for the second processor, so it would never start.
//
// usage: hil_pause_loop PERIOD_US. As root, on core 0; never ends.
#include <immintrin.h>
#include <sched.h>
#include <sys/mman.h>
#include <time.h>

#include <cstdio>
#include <cstdlib>

int main(int argc, char** argv) {
    const long period_us = argc == 2 ? std::atol(argv[1]) : 0;
    if (period_us < 10 || period_us > 999'999) {
        std::fprintf(stderr, "usage: hil_pause_loop PERIOD_US, 10 to 999999\n");
        return 2;
    }
    cpu_set_t cores;
    CPU_ZERO(&cores);
    CPU_SET(0, &cores);
    sched_param param{};
    param.sched_priority = 98;  // above all computing threads
    if (sched_setaffinity(0, sizeof cores, &cores) != 0 || sched_setscheduler(0, SCHED_FIFO, &param) != 0 ||
        mlockall(MCL_CURRENT | MCL_FUTURE) != 0) {
        std::perror("hil_pause_loop");
        return 1;
    }
    const timespec period{0, period_us * 1000};
    for (;;) {
        clock_nanosleep(CLOCK_MONOTONIC, 0, &period, nullptr);
        _mm_pause();
    }
}
