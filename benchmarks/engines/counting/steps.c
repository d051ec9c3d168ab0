// Times steps of monitors that count: `steps ROUNDS MONITORS` prints nanoseconds of CPU time per step, as JSON lines.
// `first` is the time of the first steps of a count, and `last` that of the last ones.

#define _POSIX_C_SOURCE 199309L
#include <stdio.h>
#include <stdlib.h>
#include <time.h>

#include "quiet_monitor.h"

enum { STEPS = 20, BEFORE = 570 };

static void step(quiet_monitor *monitor, bool pit) {
    quiet_signals sample = quiet_empty();
    quiet_result result;
    sample.pit = pit;
    if (!quiet_step(monitor, &sample, &result)) exit(1);
}

static double nanoseconds(quiet_monitor *monitors, int count, int before) {
    struct timespec start, end;
    for (int i = 0; i < count; i++) {
        quiet_init(&monitors[i], NULL);
        step(&monitors[i], true);
        for (int j = 0; j < before; j++) step(&monitors[i], false);
    }
    clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &start);
    for (int i = 0; i < count; i++) {
        for (int j = 0; j < STEPS; j++) step(&monitors[i], false);
    }
    clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &end);
    const double spent = (double)(end.tv_sec - start.tv_sec) * 1e9 + (double)(end.tv_nsec - start.tv_nsec);
    return spent / ((double)count * STEPS);
}

int main(int argc, char **argv) {
    if (argc != 3) return 2;
    const int rounds = atoi(argv[1]), count = atoi(argv[2]);
    quiet_monitor *monitors = (quiet_monitor *)malloc((size_t)count * sizeof *monitors);
    if (!monitors) return 1;
    for (int i = 0; i < rounds; i++) {
        const double first = nanoseconds(monitors, count, 0), last = nanoseconds(monitors, count, BEFORE);
        printf("{\"first\": %.3f, \"last\": %.3f}\n", first, last);
    }
    free(monitors);
    return 0;
}
